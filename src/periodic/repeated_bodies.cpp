#include "periodic/repeated_bodies.h"

#include <octafront/error.h>
#include <octafront/repair.h>

#include <array>
#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// A body is copied so many times along an axis at most: one that is longer is no part of a cell of this size.
constexpr double kMostCopies = 16;

/// How many periods a body is moved along an axis, from the least to the most, so that it may reach into the cell.
std::array<std::array<int, 2>, 3> moves_of(const Body& body, const PeriodicCell& cell) {
  const Box3 own = bounding_box(body.surface.points);
  std::array<std::array<int, 2>, 3> moves{};
  for (int axis = 0; axis < 3; ++axis) {
    if (!cell.along[axis]) continue;
    const double period = cell.period(axis);
    const double least = std::ceil((cell.box.lo[axis] - own.hi[axis]) / period);
    const double most = std::floor((cell.box.hi[axis] - own.lo[axis]) / period);
    if (most - least > kMostCopies || std::abs(least) > 1e6)
      throw InputError(fmt::format("{}: lies over more than {} cells along {}, or far from all of them", body.name,
                                   kMostCopies, kAxisNames[axis]));
    moves[axis] = {static_cast<int>(least), static_cast<int>(most)};
  }
  return moves;
}

bool reaches_into(const Box3& box, const Box3& cell) {
  bool reaches = true;
  for (int axis = 0; axis < 3; ++axis)
    reaches = reaches && box.lo[axis] < cell.hi[axis] && box.hi[axis] > cell.lo[axis];
  return reaches;
}

void append_moved(const SurfaceMesh& body, const std::vector<Vec3>& points, SurfaceMesh& to) {
  const auto first = static_cast<VertexIndex>(to.points.size());
  to.points.insert(to.points.end(), points.begin(), points.end());
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    const auto [a, b, c] = body.triangles[t];
    to.triangles.push_back({first + a, first + b, first + c});
    if (!body.patch.empty()) to.patch.push_back(body.patch[t]);
    to.source.push_back(body.source_of(t));
  }
}

/// Adds the body moved by so many periods, if it reaches into the cell.
void add_copy(const SurfaceMesh& body, const PeriodicCell& cell, const std::array<int, 3>& by, SurfaceMesh& to) {
  std::vector<Vec3> points = body.points;
  for (Vec3& p : points)
    for (int axis = 0; axis < 3; ++axis)
      if (by[axis] != 0) p[axis] += by[axis] * cell.period(axis);
  if (reaches_into(bounding_box(points), cell.box)) append_moved(body, points, to);
}

/// Whether a body that is longer than the cell runs into its own next copy, as a straight fibre does: it goes on by
/// itself, and copies would only lie over it.
bool goes_on_by_itself(const SurfaceMesh& body, const PeriodicCell& cell, std::size_t axis) {
  const Box3 own = bounding_box(body.points);
  const int a = static_cast<int>(axis);
  if (!cell.along[axis] || !(own.hi[a] - own.lo[a] > cell.period(axis))) return false;
  SurfaceMesh both;
  append_moved(body, body.points, both);
  std::vector<Vec3> moved = body.points;
  for (Vec3& p : moved) p[a] += cell.period(axis);
  append_moved(body, moved, both);
  return find_defects(repair_surface(both)).self_intersections.count > 0;
}

}  // namespace

Body repeated_in_cell(Body body, PeriodicCell cell, std::vector<std::string>& notes) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!goes_on_by_itself(body.surface, cell, axis)) continue;
    cell.along[axis] = false;
    notes.push_back(
        fmt::format("{} is longer than the cell along {} and would lie in its own copy: it is not repeated "
                    "along {} (`repeat`)",
                    body.name, kAxisNames[axis], kAxisNames[axis]));
  }
  const auto moves = moves_of(body, cell);
  SurfaceMesh all;
  all.patch_names = body.surface.patch_names;
  std::array<int, 3> by{};
  for (by[0] = moves[0][0]; by[0] <= moves[0][1]; ++by[0])
    for (by[1] = moves[1][0]; by[1] <= moves[1][1]; ++by[1])
      for (by[2] = moves[2][0]; by[2] <= moves[2][1]; ++by[2]) add_copy(body.surface, cell, by, all);
  if (all.triangles.empty())
    throw InputError(fmt::format("{}: lies outside of the cell, and so do all its copies", body.name));
  body.surface = std::move(all);
  return body;
}

}  // namespace octafront
