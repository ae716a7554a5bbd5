// What became of a defective surface: octafront_judge_repair INPUT RESULT. RESULT is a mesh or a surface
// (.off, .obj), made with default options. Prints one JSON object. Lengths are parts of the input's diagonal, areas of
// its area.

#include <octafront/octafront.h>

#include "base/core/random.h"
#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "base/geometry/winding_number.h"
#include "made_result.h"

#include <cmath>
#include <cstdio>
#include <string>

#include <fmt/core.h>

namespace {

using namespace octafront;

constexpr double kSpacing = 4e-3;  ///< of the points at which distances are measured
constexpr double kFar = 1e-3;      ///< the tolerance: what of the input is farther away than this is lost
constexpr double kAway = 5e-3;     ///< points are asked for inside or outside if the input is not nearer than this
constexpr double kDoubt = 0.2;     ///< winding numbers this near to 0 say outside, to 1 or above: inside
constexpr int kPoints = 10000;

bool is_closed(const SurfaceMesh& repaired, std::size_t t) {
  const std::uint32_t patch = repaired.patch_of(t);
  return patch < repaired.patch_names.size() && repaired.patch_names[patch].starts_with(kClosedByRepair);
}

bool is_moved(const Domain& repaired, std::size_t t) {
  return !repaired.bound.empty() && std::isfinite(repaired.bound[t]);
}

/// What was made from the input, by what of the repaired surface is nearest: what repair left as it was, what it moved,
/// what closes holes. The patches of a mesh do not tell, for nothing keeps the rims of what was closed.
Json boundary_from_input(const SurfaceMesh& made, const Domain& repaired, const TriangleTree& input, double diagonal) {
  const TriangleTree tree(repaired.surface);
  Farthest farthest, moved, closed;
  double closed_area = 0;
  for (const Triangle& t : made.triangles) {
    const TriangleCorners c = corners_of(made, t);
    if (is_closed(repaired.surface, tree.nearest(centroid(c[0], c[1], c[2])).triangle))
      closed_area += triangle_area(c[0], c[1], c[2]);
    sample(c, kSpacing * diagonal, [&](Vec3 p) {
      const std::uint32_t near = tree.nearest(p).triangle;
      Farthest& to = is_closed(repaired.surface, near) ? closed : is_moved(repaired, near) ? moved : farthest;
      to.add(std::sqrt(input.nearest(p).squared_distance), p);
    });
  }
  return {{"boundary_from_input", farthest.json(diagonal)},
          {"moved_from_input", moved.json(diagonal)},
          {"closed_from_input", closed.json(diagonal)},
          {"closed_area", closed_area / area(made)}};
}

/// The input from the boundary, and how much of it lies apart: inside (walls, debris) or outside (sheets, lost parts).
Json input_from_boundary(const SurfaceMesh& input, const TriangleTree& made, double diagonal) {
  Farthest inside, outside;
  double lost_inside = 0, lost_outside = 0, all = 0;
  for (const Triangle& t : input.triangles) {
    const TriangleCorners c = corners_of(input, t);
    int points = 0, in = 0, out = 0;
    sample(c, kSpacing * diagonal, [&](Vec3 p) {
      const double d = std::sqrt(made.nearest(p).squared_distance);
      ++points;
      if (d <= kFar * diagonal) return;
      const bool is_inside = made.contains(p);
      (is_inside ? in : out) += 1;
      (is_inside ? inside : outside).add(d, p);
    });
    const double a = triangle_area(c[0], c[1], c[2]);
    all += a;
    lost_inside += a * in / points;
    lost_outside += a * out / points;
  }
  return {{"lost_inside", lost_inside / all},
          {"lost_outside", lost_outside / all},
          {"inside_from_boundary", inside.json(diagonal)},
          {"outside_from_boundary", outside.json(diagonal)}};
}

/// Where the input's generalised winding number is sure, whether the result agrees. Turned faces mislead it.
Json sides(const SurfaceMesh& input, const TriangleTree& input_tree, const TriangleTree& made, double diagonal) {
  const WindingNumber winding(input);
  const Box3 box = input_tree.box();
  Random random(1);
  int asked = 0, only_input = 0, only_made = 0;
  Vec3 at;
  for (int i = 0; i < 10 * kPoints && asked < kPoints; ++i) {
    const Vec3 u{random.unit(), random.unit(), random.unit()}, e = box.extent();
    const Vec3 p = box.lo + Vec3{u.x * e.x, u.y * e.y, u.z * e.z};
    if (input_tree.is_within(p, kAway * diagonal)) continue;
    const double w = std::abs(winding.at(p));
    if (w > kDoubt && w < 1 - kDoubt) continue;
    ++asked;
    const bool says_inside = w > 0.5, is_inside = made.contains(p);
    if (says_inside == is_inside) continue;
    ++(says_inside ? only_input : only_made);
    at = p;
  }
  return {{"asked", asked},
          {"only_input_inside", only_input},
          {"only_result_inside", only_made},
          {"at", {at.x, at.y, at.z}}};
}

Json judge(const std::string& input_file, const std::string& result) {
  const SurfaceMesh input = repair_surface(read_surface(input_file).surface).surface;
  const MadeResult made = read_result(result);
  if (made.boundary.triangles.empty()) return {{"empty", true}};
  const TriangleTree input_tree(input), made_tree(made.boundary);
  const double diagonal = input_tree.box().diagonal();
  Json j = made.about;
  j["volume"] = enclosed_volume(made.boundary);
  j.update(boundary_from_input(made.boundary, open_domain(input_file), input_tree, diagonal));
  j.update(input_from_boundary(input, made_tree, diagonal));
  j["sides"] = sides(input, input_tree, made_tree, diagonal);
  return j;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("octafront_judge_repair INPUT MESH|SURFACE\n", stderr);
    return 2;
  }
  try {
    fmt::print("{}\n", judge(argv[1], argv[2]).dump());
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 3;
  }
  return 0;
}
