#include "fill/recovery/recover.h"

#include <octafront/error.h>

#include "base/core/validate.h"
#include "base/mesh/complex.h"
#include "fill/recovery/boundary_recovery.h"
#include "fill/recovery/carve.h"
#include "fill/recovery/delaunay.h"
#include "fill/recovery/steiner_lift.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/core.h>

namespace octafront {

namespace {

bool has_coinciding(const std::vector<VertexIndex>& same_as) {
  for (std::size_t v = 0; v < same_as.size(); ++v)
    if (same_as[v] != v) return true;
  return false;
}

using namespace recovery;

struct Input {
  ExactPoints points;
  std::vector<bool> used;
};

Input read_input(const SurfaceMesh& surface) {
  Input in;
  for (const Vec3& p : surface.points) {
    if (!is_finite(p)) throw MeshingError("a vertex of the surface is not finite");
    in.points.add(p);
  }
  in.used.assign(surface.points.size(), false);
  for (const Triangle& t : surface.triangles) {
    for (const VertexIndex v : t) in.used[v] = true;
  }
  return in;
}

std::vector<Triangle> merged(std::vector<Triangle> triangles, const std::vector<VertexIndex>& same_as) {
  for (Triangle& t : triangles) {
    for (VertexIndex& v : t) v = same_as[v];
  }
  return triangles;
}

// The vertex at the place of v to which the surface's triangles on this part of its star refer.
VertexIndex surface_vertex(const SurfaceMesh& surface, const std::vector<Triangle>& seen,
                           const std::vector<VertexIndex>& same_as, const TetComplex& mesh, VertexIndex v,
                           const std::vector<TetIndex>& star) {
  VertexIndex name = kNone;
  for (const TetIndex t : star) {
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      if (!is_outside(mesh.across[h]) || mesh.apex(h) == v) continue;
      for (const VertexIndex w : seen[mesh.across[h] - kFirstOutside]) {
        if (same_as[w] != v || w == name) continue;
        if (name != kNone) {
          const Vec3 p = surface.points[v];
          throw MeshingError(
              fmt::format("the surface is open: its vertices {} and {} at ({}, {}, {}) are one place of it; "
                          "merge equal vertices first",
                          name, w, p.x, p.y, p.z));
        }
        name = w;
      }
    }
  }
  return name;
}

// Where the surface has several vertices at one place, the mesh has one of them so far. Each part of its star that
// hangs together through faces gets the vertex that the surface's triangles have there.
void restore_coinciding(const SurfaceMesh& surface, const std::vector<VertexIndex>& same_as, TetComplex& mesh) {
  const std::vector<Triangle> seen = with_backs(surface.triangles, surface);
  std::vector<bool> shared(same_as.size(), false);
  for (VertexIndex v = 0; v < same_as.size(); ++v) {
    if (same_as[v] != v) shared[same_as[v]] = true;
  }
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    if (!mesh.alive(t)) continue;
    for (int i = 0; i < 4; ++i) {
      const VertexIndex v = mesh.tets[t][i];
      if (v >= shared.size() || !shared[v]) continue;
      const std::vector<TetIndex> star = mesh.star_from(v, t);
      const VertexIndex name = surface_vertex(surface, seen, same_as, mesh, v, star);
      if (name == v || name == kNone) continue;
      for (const TetIndex u : star) std::ranges::replace(mesh.tets[u], v, name);
    }
  }
}

// Vertices that lie inside follow those of the surface.
TetMesh extract(const SurfaceMesh& surface, const ExactPoints& points, const TetComplex& mesh) {
  TetMesh result;
  result.points = surface.points;
  std::vector<VertexIndex> number(points.size(), kNone);
  for (VertexIndex v = 0; v < surface.points.size(); ++v) number[v] = v;
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    if (!mesh.alive(t)) continue;
    Tet c = mesh.tets[t];
    for (VertexIndex& v : c) {
      if (number[v] == kNone) {
        number[v] = static_cast<VertexIndex>(result.points.size());
        result.points.push_back(points.at(v));
      }
      v = number[v];
    }
    result.tets.push_back(c);
  }
  list_faces(surface, result);
  return result;
}

void count(const Stage& stage, const RecoveryCounts& c, const LiftCounts& l) {
  stage.count("edges missing", static_cast<double>(c.missing_edges));
  stage.count("edges recovered by flips", static_cast<double>(c.edges_by_flips));
  stage.count("facets missing", static_cast<double>(c.missing_facets));
  stage.count("facets recovered by flips", static_cast<double>(c.facets_by_flips));
  stage.count("points on edges", static_cast<double>(c.edge_points));
  stage.count("points at crossings", static_cast<double>(c.crossing_points));
  stage.count("points on facets", static_cast<double>(c.facet_points));
  stage.count("points merged", static_cast<double>(l.collapsed));
  stage.count("points lifted", static_cast<double>(l.lifted));
  stage.count("points removed", static_cast<double>(l.removed));
  stage.count("points deferred", static_cast<double>(l.deferred));
}

[[noreturn]] void throw_no_place(const ExactPoints& points, const std::vector<VertexIndex>& open) {
  const Vec3 p = points.at(open.front());
  throw MeshingError(fmt::format(
      "no place was found inside for {} points that the surface needs, the first near ({}, {}, {}): the gap "
      "there may be too thin for double precision",
      open.size(), p.x, p.y, p.z));
}

// Whether each of the triangles lies across a face of the mesh that has its corners. Where a sheet ends, merging points
// of its rim may leave two elements of different sides one face.
bool has_all_faces(const TetComplex& mesh, const std::vector<Triangle>& triangles) {
  std::vector<std::uint8_t> is_there(triangles.size(), 0);
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    if (!mesh.alive(t)) continue;
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      if (!is_outside(mesh.across[h])) continue;
      const std::uint32_t n = mesh.across[h] - kFirstOutside;
      if (n < triangles.size() && face_key(mesh.face(h)) == face_key(triangles[n])) is_there[n] = 1;
    }
  }
  return std::find(is_there.begin(), is_there.end(), 0) == is_there.end();
}

// Steiner points that have no place inside may not be needed after other choices. The last attempt throws.
constexpr std::uint32_t kAttempts = 6;

// Points that the first attempt may make. The worst surfaces that were recovered needed 1.2 per triangle. Coordinates
// get longer with each point that lies on others: what needs far more would end, but not soon. Other choices mostly
// need fewer; where they do not, each attempt may make more than the one before by this factor.
constexpr std::size_t kMostPointsPerTriangle = 4, kMostPoints = 200, kMorePoints = 4;

// Words of a coordinate from which on a cavity is rather made larger. Those that are filled need 8 at most; where
// needles lie in one plane but for rounding they double and double, and signs take ever longer.
constexpr std::size_t kMostWordsOfCavity = 16;

PointLimits limits_of(std::size_t triangles, std::uint32_t attempt, RecoveryPatience patience) {
  std::size_t points = kMostPointsPerTriangle * triangles + kMostPoints;
  for (std::uint32_t k = 0; k < attempt; ++k) points *= kMorePoints;
  const bool is_cavity = patience == RecoveryPatience::kCavity;
  return {points, is_cavity ? kMostWordsOfCavity : std::numeric_limits<std::size_t>::max()};
}

std::optional<TetMesh> recover(const SurfaceMesh& surface, std::uint32_t attempt, const Stage& stage,
                               RecoveryPatience patience) {
  auto [points, used] = read_input(surface);
  TetComplex complex;
  std::vector<VertexIndex> same_as;
  const VertexIndex frame = delaunay(points, used, complex, same_as, stage.context());
  LabelledComplex mesh(std::move(complex));
  validate(mesh);
  const std::vector<Triangle> triangles = merged(surface.triangles, same_as);
  SubdividedSurface subdivided(triangles);
  const RecoveryTask task{points, mesh, frame, attempt, stage.context()};
  BoundaryRecovery recovery(task, subdivided, limits_of(triangles.size(), attempt, patience));
  recovery.run();
  validate(mesh);
  carve(points, subdivided, surface, mesh);
  const std::vector<Triangle> seen = with_backs(triangles, surface);
  SteinerLift lift(task, seen);
  if (const std::vector<VertexIndex> open = lift.run(); !open.empty()) {
    if (attempt + 1 == kAttempts) throw_no_place(points, open);
    return std::nullopt;
  }
  if (!has_all_faces(mesh, seen)) {
    if (attempt + 1 == kAttempts) throw MeshingError("triangles of the surface are no faces of what fills it");
    return std::nullopt;
  }
  validate<TetComplex>(mesh);
  count(stage, recovery.counts(), lift.counts());
  stage.count("attempts", attempt + 1);
  if (has_coinciding(same_as)) restore_coinciding(surface, same_as, mesh);
  return extract(surface, points, mesh);
}

}  // namespace

TetMesh recover_volume(const SurfaceMesh& surface, const Stage& stage, RecoveryPatience patience) {
  if (surface.triangles.empty()) return {};
  try {
    for (std::uint32_t attempt = 0;; ++attempt) {
      try {
        if (std::optional<TetMesh> mesh = recover(surface, attempt, stage, patience)) return std::move(*mesh);
      } catch (const TooManyPoints&) {
        if (patience == RecoveryPatience::kCavity || attempt + 1 == kAttempts) throw;
      }
    }
  } catch (const std::logic_error& e) {
    // On a valid surface a bug of ours; else the surface was not what it must be.
    throw MeshingError(fmt::format("{}; does the surface intersect itself?", e.what()));
  }
}

}  // namespace octafront
