#include "fill/recovery/recover.h"

#include <octafront/error.h>
#include <octafront/validity.h>

#include "support/named_surfaces.h"
#include "support/nasty_surfaces.h"

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

TetMesh recovered(const SurfaceMesh& surface) {
  StageReport report;
  return recover_volume(surface, {{}, report});
}

void expect_kept(const SurfaceMesh& surface) {
  const TetMesh mesh = recovered(surface);
  const auto defect = first_defect(mesh, surface);
  EXPECT_FALSE(defect) << *defect;
  EXPECT_EQ(mesh.boundary, surface.triangles);
}

// F. Bagemihl's polyhedron (1948): a reflex edge of Schönhardt's gives way to a chain of points that bends inward. All
// of them are so near its upper end that they do not see the lower corner across.
SurfaceMesh bagemihl_polyhedron(int chain, double bend) {
  SurfaceMesh s = testing::twisted_prism(3, 30);
  constexpr VertexIndex kFrom = 0, kTo = 4, kLow = 1, kHigh = 3;
  std::erase_if(s.triangles, [&](const Triangle& t) {
    return std::ranges::count(t, kFrom) == 1 && std::ranges::count(t, kTo) == 1;
  });
  const Vec3 from = s.points[kFrom], to = s.points[kTo];
  VertexIndex last = kFrom;
  for (int i = 1; i <= chain + 1; ++i) {
    const double t = 0.7 + 0.3 * i / (chain + 1.0), inward = bend * 4 * t * (1 - t);
    VertexIndex next = kTo;
    if (i <= chain) {
      const Vec3 p = from * (1 - t) + to * t;
      next = static_cast<VertexIndex>(s.points.size());
      s.points.push_back({p.x * (1 - inward), p.y * (1 - inward), p.z});
    }
    s.triangles.push_back({last, kLow, next});
    s.triangles.push_back({last, next, kHigh});
    last = next;
  }
  return s;
}

// A slab with a tower on it, square in section: a tall, narrow twisted prism whose foot is a hole in the slab's top.
SurfaceMesh chimney_polyhedron(double width, double height, double twist_degrees) {
  const SurfaceMesh tower = testing::transformed(testing::twisted_prism(4, twist_degrees, height / width), width, {});
  SurfaceMesh s;
  s.points = tower.points;  // 0 to 3 the foot, 4 to 7 the rim
  for (const Triangle& t : tower.triangles) {
    if (std::ranges::any_of(t, [](VertexIndex v) { return v > 3; })) s.triangles.push_back(t);
  }
  for (const double z : {0.0, -1.0}) {
    for (const Vec3 corner : {Vec3{1, 0, z}, Vec3{0, 1, z}, Vec3{-1, 0, z}, Vec3{0, -1, z}}) s.points.push_back(corner);
  }
  for (VertexIndex i = 0; i < 4; ++i) {
    const VertexIndex j = (i + 1) % 4, top = 8, bottom = 12;
    s.triangles.push_back({i, top + i, top + j});
    s.triangles.push_back({i, top + j, j});
    s.triangles.push_back({bottom + i, bottom + j, top + j});
    s.triangles.push_back({bottom + i, top + j, top + i});
  }
  s.triangles.push_back({12, 14, 13});
  s.triangles.push_back({12, 15, 14});
  return s;
}

TEST(RecoverVolume, KeepsNamedSurfaces) {
  expect_kept(testing::unit_tetrahedron());
  expect_kept(testing::cube());
  expect_kept(testing::icosphere(2));
  expect_kept(testing::torus(24, 10));
  expect_kept(testing::hollow_sphere(2));
}

TEST(RecoverVolume, KeepsThousandsOfCoplanarPoints) {
  expect_kept(testing::cube(16));
}

TEST(RecoverVolume, KeepsSeveralBodies) {
  expect_kept(testing::joined(testing::cube(2), testing::transformed(testing::icosphere(1), 0.5, {3, 0, 0})));
}

// No tetrahedralisation without extra points exists.
TEST(RecoverVolume, FillsTheSchoenhardtPolyhedron) {
  const SurfaceMesh surface = testing::twisted_prism(3, 30);
  expect_kept(surface);
  EXPECT_GT(recovered(surface).points.size(), surface.points.size());
}

// No vertex sees the whole lower triangle, so no tetrahedralisation without extra points exists.
TEST(RecoverVolume, FillsBagemihlsPolyhedra) {
  for (const int chain : {1, 2, 5, 20, 100}) {
    SCOPED_TRACE(chain);
    const SurfaceMesh surface = bagemihl_polyhedron(chain, 0.01);
    expect_kept(surface);
    EXPECT_GT(recovered(surface).points.size(), surface.points.size());
  }
}

TEST(RecoverVolume, FillsChimneys) {
  for (const double width : {0.5, 1e-2, 1e-5}) {
    for (const double twist : {0.0, 20.0, 40.0}) {
      SCOPED_TRACE(::testing::Message() << "width " << width << ", twist " << twist);
      expect_kept(chimney_polyhedron(width, 3, twist));
    }
  }
}

TEST(RecoverVolume, FillsTwistedPrisms) {
  for (const int n : {4, 5, 6, 9, 17}) expect_kept(testing::twisted_prism(n, 170.0 / n));
}

TEST(RecoverVolume, FillsChazellesPolyhedron) {
  for (const int n : {1, 2, 3, 5}) expect_kept(testing::chazelle_polyhedron(n, 1e-3));
}

TEST(RecoverVolume, KeepsPinchedEdgesAndVertices) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    expect_kept(testing::random_voxels(3, 0.5, 0, testing::Pinches::kKept, seed));
    expect_kept(testing::random_voxels(3, 0.5, 0.05, testing::Pinches::kKept, seed));
  }
}

TEST(RecoverVolume, KeepsVerticesAtOnePlaceApart) {
  // Two tetrahedra that touch in a vertex, which each has for itself.
  SurfaceMesh mirrored = testing::transformed(testing::unit_tetrahedron(), -1, {});
  for (Triangle& t : mirrored.triangles) std::swap(t[0], t[1]);
  expect_kept(testing::joined(testing::unit_tetrahedron(), mirrored));
}

TEST(RecoverVolume, RefusesVerticesThatShouldBeOne) {
  SurfaceMesh cut = testing::cube();
  const VertexIndex twin = static_cast<VertexIndex>(cut.points.size());
  cut.points.push_back(Vec3(cut.points[cut.triangles[0][0]]));
  cut.triangles[0][0] = twin;
  EXPECT_THROW(recovered(cut), MeshingError);
}

TEST(RecoverVolume, KeepsNastySurfaces) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const testing::NastySurface nasty = testing::nasty_surface(seed);
    SCOPED_TRACE(nasty.name);
    expect_kept(nasty.surface);
  }
}

// A Steiner point of this has no place inside after the first choices.
TEST(RecoverVolume, TriesAgainWithOtherChoices) {
  expect_kept(testing::nasty_surface(1362).surface);
}

TEST(RecoverVolume, IsDeterministic) {
  const SurfaceMesh surface = testing::nasty_surface(10).surface;
  EXPECT_EQ(recovered(surface), recovered(surface));
}

TEST(RecoverVolume, DoesTheSameAtAnyScale) {
  const SurfaceMesh surface = testing::random_voxels(3, 0.6, 0.1, testing::Pinches::kKept, 4);
  const TetMesh mesh = recovered(surface);
  for (const double scale : {0x1p-60, 0x1p60}) {
    EXPECT_EQ(recovered(testing::transformed(surface, scale, {})).tets, mesh.tets);
  }
}

TEST(RecoverVolume, EndsWhenCancelled) {
  const std::atomic<bool> cancel = true;
  RunContext context;
  context.cancel = &cancel;
  StageReport report;
  EXPECT_THROW(recover_volume(testing::cube(8), {context, report}), Cancelled);
}

TEST(RecoverVolume, RefusesAVertexOnAnEdge) {
  // One side of the cube is divided at the middle of an edge, the other side of that edge is not.
  SurfaceMesh surface = testing::cube();
  const auto middle = static_cast<VertexIndex>(surface.points.size());
  const Triangle t = surface.triangles[0];
  surface.points.push_back((surface.points[t[0]] + surface.points[t[1]]) * 0.5);
  surface.triangles[0] = {t[0], middle, t[2]};
  surface.triangles.push_back({middle, t[1], t[2]});
  EXPECT_THROW(recovered(surface), MeshingError);
}

TEST(RecoverVolume, RefusesSurfacesThatIntersect) {
  const SurfaceMesh cube = testing::cube(2);
  for (const Vec3 shift : {Vec3{0.3, 0.2, 0.1}, Vec3{0.5, 0.5, 0.5}, Vec3{0.25, 0, 0}}) {
    EXPECT_THROW(recovered(testing::joined(cube, testing::transformed(cube, 1, shift))), MeshingError);
  }
}

TEST(RecoverVolume, RefusesAnOpenSurface) {
  SurfaceMesh open = testing::cube();
  open.triangles.pop_back();
  EXPECT_THROW(recovered(open), MeshingError);
}

TEST(RecoverVolume, RefusesAnInsideOutSurface) {
  EXPECT_THROW(recovered(testing::reversed(testing::cube())), MeshingError);
}

}  // namespace
}  // namespace octafront
