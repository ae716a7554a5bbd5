// Whatever changes a mesh leaves all that hangs on it where it was: each part and set the same volume, area or length
// at the same place.

#include <octafront/adapt.h>
#include <octafront/improve_existing.h>
#include <octafront/named_groups.h>
#include <octafront/validity.h>

#include "base/geometry/measures.h"
#include "base/mesh/face_table.h"
#include "base/mesh/labels.h"
#include "improve/start_meshes.h"
#include "support/random.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using Kind = NamedSet::Kind;
using testing::Random;

constexpr int kCells = 3;  // along each side of the cube

/// A box of whole cells.
struct CellBox {
  std::array<int, 3> lo{}, hi{};
  explicit CellBox(Random& random) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo[axis] = random.integer(0, kCells - 1);
      hi[axis] = random.integer(lo[axis] + 1, kCells);
    }
  }
  template <class Item>
  bool has(const TetMesh& mesh, const Item& item) const {
    return std::ranges::all_of(item, [&](VertexIndex v) {
      for (int axis = 0; axis < 3; ++axis) {
        const double x = mesh.points[v][axis] * kCells;
        if (x < lo[static_cast<std::size_t>(axis)] || x > hi[static_cast<std::size_t>(axis)]) return false;
      }
      return true;
    });
  }
};

void add_set(TetMesh& mesh, std::string name, Kind kind, const auto& is_member) {
  NamedSet set{std::move(name), kind, {}};
  for (std::uint32_t i = 0; i < mesh.count(kind); ++i)
    if (is_member(i)) set.members.push_back(i);
  mesh.sets.push_back(std::move(set));
}

const Triangle& face_at(const TetMesh& mesh, std::uint32_t f) {
  return f < mesh.boundary.size() ? mesh.boundary[f] : mesh.interfaces[f - mesh.boundary.size()];
}

/// Faces inside on a plane between cells, in a box: a sheet.
void add_sheet(TetMesh& mesh, Random& random) {
  const double z = static_cast<double>(random.integer(1, kCells - 1)) / kCells;
  const CellBox box(random);
  std::set<Triangle> known;
  for (const Tet& t : mesh.tets)
    for (int i = 0; i < 4; ++i) {
      const Triangle f = face_of(t, i);
      const bool is_on = std::ranges::all_of(f, [&](VertexIndex v) { return mesh.points[v].z == z; });
      if (!is_on || !box.has(mesh, f) || !known.insert(face_key(f)).second) continue;
      mesh.interfaces.push_back(f);
      mesh.interface_patch.push_back(6);
    }
}

/// Lines of edges along the axes, inside or not, each a curve.
void add_lines(TetMesh& mesh, Random& random) {
  std::map<std::array<double, 3>, VertexIndex> at;
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) at[{mesh.points[v].x, mesh.points[v].y, mesh.points[v].z}] = v;
  for (std::uint32_t line = 0; line < 3; ++line) {
    const std::array<double, 2> p{double(random.integer(0, kCells)) / kCells,
                                  double(random.integer(0, kCells)) / kCells};
    const auto vertex = [&](int k) {
      std::array<double, 3> x{p[0], p[1], 0};
      std::rotate(x.begin(), x.begin() + line, x.end());
      x[2 - line] = double(k) / kCells;
      return at.at(x);
    };
    const int begin = random.integer(0, kCells - 1), end = random.integer(begin + 1, kCells);
    for (int k = begin; k < end; ++k) {
      mesh.curve_edges.push_back({vertex(k), vertex(k + 1)});
      mesh.curve.push_back(line);
    }
  }
  mesh.curve_names = {"first", "second", "third"};
}

/// A cube with parts and sets of all kinds, whose borders are flat or straight.
TetMesh labelled_cube(std::uint64_t seed) {
  Random random(seed);
  TetMesh mesh = testing::kuhn_cube(kCells);
  const CellBox inner(random);
  for (const Tet& t : mesh.tets) mesh.region.push_back(inner.has(mesh, t));
  mesh.region_names = {"around", "inner"};
  mesh.patch_names = {"x0", "x1", "y0", "y1", "z0", "z1", "sheet"};
  add_sheet(mesh, random);
  add_lines(mesh, random);
  for (const char* name : {"a", "b"}) {
    const CellBox box(random);
    add_set(mesh, name, Kind::kElements, [&](TetIndex t) { return box.has(mesh, mesh.tets[t]); });
    const CellBox more(random);
    add_set(mesh, name, Kind::kFaces, [&](std::uint32_t f) { return more.has(mesh, face_at(mesh, f)); });
    add_set(mesh, name, Kind::kEdges, [&](std::uint32_t e) { return more.has(mesh, mesh.curve_edges[e]); });
    add_set(mesh, name, Kind::kNodes, [&](VertexIndex v) { return box.has(mesh, std::array{v}); });
  }
  add_set(mesh, "all", Kind::kNodes, [](VertexIndex) { return true; });
  add_set(mesh, "RequiredVertices", Kind::kNodes, [&](VertexIndex) { return random.integer(0, 40) == 0; });
  return mesh;
}

/// The same with sets of elements, edges and nodes anywhere, which nothing but their own faces hold, and pairs.
TetMesh wildly_labelled_cube(std::uint64_t seed) {
  Random random(seed);
  TetMesh mesh = labelled_cube(seed);
  add_set(mesh, "scattered", Kind::kElements, [&](TetIndex) { return random.integer(0, 12) == 0; });
  add_set(mesh, "probes", Kind::kNodes, [&](VertexIndex) { return random.integer(0, 25) == 0; });
  if (seed % 2 == 0) add_set(mesh, "RequiredTetrahedra", Kind::kElements, [](TetIndex t) { return t % 61 == 5; });
  std::set<Edge> known;
  for (const auto& [a, b] : mesh.curve_edges) known.insert(sorted_edge(a, b));
  for (int k = 0; k < 12; ++k) {
    const Tet& t = mesh.tets[static_cast<std::size_t>(random.integer(0, static_cast<int>(mesh.tets.size()) - 1))];
    if (!known.insert(sorted_edge(t[0], t[2])).second) continue;
    mesh.curve_edges.push_back({t[0], t[2]});
    mesh.curve.push_back(static_cast<std::uint32_t>(random.integer(1, 2)));
  }
  mesh.periods = {{1, 0, 0}};
  for (VertexIndex v = 0; v < mesh.points.size(); ++v)
    if (mesh.points[v].x == 0)
      for (VertexIndex w = 0; w < mesh.points.size(); ++w)
        if (mesh.points[w] == mesh.points[v] + mesh.periods[0]) mesh.periodic_nodes.push_back({0, w, v});
  std::sort(mesh.periodic_nodes.begin(), mesh.periodic_nodes.end());
  return testing::perturbed(std::move(mesh), 0.6, static_cast<std::uint32_t>(seed));
}

/// How much there is of something, and the moments that say where.
using Measure = std::array<double, 4>;

template <class Item>
Measure measure_of(const std::vector<Vec3>& points, const Item& item) {
  constexpr std::size_t kCorners = std::tuple_size_v<Item>;
  std::array<Vec3, kCorners> p;
  Vec3 middle;
  for (std::size_t i = 0; i < kCorners; ++i) {
    p[i] = points[item[i]];
    middle = middle + p[i] / static_cast<double>(kCorners);
  }
  double size = 0;
  if constexpr (kCorners == 2) size = distance(p[0], p[1]);
  if constexpr (kCorners == 3) size = length(cross(p[1] - p[0], p[2] - p[0])) / 2;
  if constexpr (kCorners == 4) size = dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) / 6;
  return {size, size * middle.x, size * middle.y, size * middle.z};
}

using Measures = std::map<std::string, Measure>;

void add_to(Measures& all, const std::string& name, const Measure& more) {
  Measure& sum = all[name];
  for (std::size_t k = 0; k < 4; ++k) sum[k] += more[k];
}

Measure measure_at(const TetMesh& mesh, Kind kind, std::uint32_t i) {
  return kind == Kind::kElements ? measure_of(mesh.points, mesh.tets[i])
         : kind == Kind::kFaces  ? measure_of(mesh.points, face_at(mesh, i))
                                 : measure_of(mesh.points, mesh.curve_edges[i]);
}

/// Of all parts, and all sets but those of nodes.
Measures measures(const TetMesh& mesh) {
  Measures all;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    add_to(all, mesh.region_names.at(mesh.region.at(t)), measure_of(mesh.points, mesh.tets[t]));
  for (std::uint32_t f = 0; f < mesh.count(Kind::kFaces); ++f) {
    const auto outer = static_cast<std::uint32_t>(mesh.boundary.size());
    add_to(all, mesh.patch_names.at(f < outer ? mesh.patch.at(f) : mesh.interface_patch.at(f - outer)),
           measure_of(mesh.points, face_at(mesh, f)));
  }
  for (std::uint32_t e = 0; e < mesh.curve_edges.size(); ++e)
    add_to(all, mesh.curve_names.at(mesh.curve.at(e)), measure_of(mesh.points, mesh.curve_edges[e]));
  for (const NamedSet& set : mesh.sets) {
    if (set.kind == Kind::kNodes) continue;
    add_to(all, set.name + " of " + std::to_string(static_cast<int>(set.kind)), {});
    for (const std::uint32_t m : set.members)
      add_to(all, set.name + " of " + std::to_string(static_cast<int>(set.kind)), measure_at(mesh, set.kind, m));
  }
  return all;
}

void expect_same_measures(const TetMesh& before, const TetMesh& mesh) {
  const Measures had = measures(before), has = measures(mesh);
  ASSERT_EQ(had.size(), has.size());
  for (const auto& [name, measure] : had) {
    ASSERT_TRUE(has.contains(name)) << name;
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(has.at(name)[k], measure[k], 1e-9) << name << " " << k;
  }
}

std::set<std::array<double, 3>> places_of(const TetMesh& mesh, const std::vector<std::uint32_t>& nodes) {
  std::set<std::array<double, 3>> places;
  for (const VertexIndex v : nodes) places.insert({mesh.points[v].x, mesh.points[v].y, mesh.points[v].z});
  return places;
}

/// Nodes of sets that are to keep their places have them, and are in their sets.
void expect_nodes_that_stay(const TetMesh& before, const TetMesh& mesh) {
  std::vector<VertexIndex> stay = nodes_that_stay(before);
  const std::vector<VertexIndex> required = required_vertices(before);
  stay.insert(stay.end(), required.begin(), required.end());
  std::sort(stay.begin(), stay.end());
  ASSERT_EQ(before.sets.size(), mesh.sets.size());
  for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
    if (mesh.sets[s].kind != Kind::kNodes) continue;
    std::vector<std::uint32_t> wanted;
    std::ranges::set_intersection(before.sets[s].members, stay, std::back_inserter(wanted));
    const auto has = places_of(mesh, mesh.sets[s].members), had = places_of(before, wanted);
    EXPECT_TRUE(std::ranges::includes(has, had)) << mesh.sets[s].name;
    EXPECT_TRUE(std::ranges::is_sorted(mesh.sets[s].members));
  }
}

void expect_same_pairs(const TetMesh& before, const TetMesh& mesh) {
  ASSERT_EQ(before.periodic_nodes.size(), mesh.periodic_nodes.size());
  std::set<std::array<double, 6>> had, has;
  const auto places = [](const TetMesh& of) {
    std::set<std::array<double, 6>> all;
    for (const auto& [period, copy, original] : of.periodic_nodes) {
      const Vec3 p = of.points[copy], q = of.points[original];
      all.insert({p.x, p.y, p.z, q.x, q.y, q.z});
    }
    return all;
  };
  EXPECT_EQ(places(before), places(mesh));
}

TEST(LabelsLaw, ImprovementLeavesAllWhereItWas) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    for (const auto level : {ImproveOptions::Level::kPaper, ImproveOptions::Level::kFast,
                             ImproveOptions::Level::kDefault, ImproveOptions::Level::kBest})
      for (const bool moves : {false, true}) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << ", level " << static_cast<int>(level) << ", " << moves);
        const TetMesh start = wildly_labelled_cube(seed);
        ASSERT_EQ(first_defect(start), std::nullopt);
        Options options;
        options.improve.level = level;
        options.improve.no_bridging = seed % 3 == 0;
        const SurfaceMesh surface{start.points, start.boundary, {}, {}, {}};
        const Improved better = improve_existing(start, options, moves ? &surface : nullptr);
        EXPECT_EQ(first_defect(better.mesh), std::nullopt);
        EXPECT_NE(better.mesh, start);
        expect_same_measures(start, better.mesh);
        expect_nodes_that_stay(start, better.mesh);
        expect_same_pairs(start, better.mesh);
        if (::testing::Test::HasFailure()) return;
      }
}

/// Nodes of sets that are still there are in them.
void expect_nodes_still_there(const TetMesh& before, const AdaptedMesh& made) {
  for (std::size_t s = 0; s < before.sets.size(); ++s) {
    if (before.sets[s].kind != Kind::kNodes) continue;
    std::vector<std::uint32_t> wanted;
    for (VertexIndex v = 0; v < made.old_of_new.size(); ++v)
      if (made.old_of_new[v] != kNone && has_member(before.sets[s], made.old_of_new[v])) wanted.push_back(v);
    EXPECT_EQ(made.mesh.sets[s].members, wanted) << before.sets[s].name;
  }
}

TEST(LabelsLaw, AdaptingLeavesAllWhereItWas) {
  const MetricFunction flat = [](Vec3) {
    return std::array<std::array<double, 3>, 3>{{{9, 0, 0}, {0, 36, 0}, {0, 0, 16}}};
  };
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const TetMesh start = labelled_cube(seed);
    for (const double size : {0.25, 0.7, 0.0})
      for (const char* only : {"", "box:0,0,0,0.1,0.1,0.1"}) {
        if (size == 0 && *only != 0) continue;
        SCOPED_TRACE(::testing::Message() << "seed " << seed << ", size " << size << ", only " << only);
        Options options;
        if (size > 0) options.size.size = size;
        options.adapt.only = only;
        options.adapt.halo = 1;
        options.improve.no_bridging = seed % 3 == 0;
        const AdaptedMesh made = size > 0 ? adapt_existing(start, options) : adapt_to_metric(start, flat, options);
        EXPECT_EQ(first_defect(made.mesh), std::nullopt);
        if (*only == 0) {
          EXPECT_NE(made.mesh.tets, start.tets);
        }
        expect_same_measures(start, made.mesh);
        expect_nodes_still_there(start, made);
        if (::testing::Test::HasFailure()) return;
      }
  }
}

TEST(LabelsLaw, SurfacesAdaptedKeepTheirPatches) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Random random(seed);
    const TetMesh cube = testing::kuhn_cube(kCells);
    SurfaceMesh start{cube.points, cube.boundary, {}, {}, {}};
    const CellBox box(random);
    for (std::size_t t = 0; t < start.triangles.size(); ++t)
      start.patch.push_back(cube.patch[t] + (box.has(cube, start.triangles[t]) ? 6 : 0));
    const auto areas = [](const SurfaceMesh& surface) {
      std::map<std::uint32_t, Measure> all;
      for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const Measure more = measure_of(surface.points, surface.triangles[t]);
        for (std::size_t k = 0; k < 4; ++k) all[surface.patch[t]][k] += more[k];
      }
      return all;
    };
    for (const double size : {0.2, 0.7}) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", size " << size);
      Options options;
      options.size.size = size;
      const AdaptedSurface made = adapt_surface(start, options);
      const auto had = areas(start), has = areas(made.surface);
      ASSERT_EQ(had.size(), has.size());
      for (const auto& [patch, measure] : had)
        for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(has.at(patch)[k], measure[k], 1e-9) << patch;
    }
  }
}

}  // namespace
}  // namespace octafront
