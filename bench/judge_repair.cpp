// What became of a defective surface: octafront_judge_repair INPUT RESULT [CLOSED]. RESULT is a mesh or a surface
// (.off, .obj); CLOSED the name of the patch that stands for holes, by default "closed by repair". Prints one JSON
// object. Lengths are parts of the input's diagonal, areas of its area.

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

/// The boundary from the input, except what closes holes.
Json boundary_from_input(const SurfaceMesh& made, const TriangleTree& input, const std::string& closed,
                         double diagonal) {
  Farthest farthest, farthest_closed;
  double closed_area = 0;
  for (std::size_t i = 0; i < made.triangles.size(); ++i) {
    const std::uint32_t patch = made.patch_of(i);
    const bool closes = patch < made.patch_names.size() && made.patch_names[patch].starts_with(closed);
    const TriangleCorners c = corners_of(made, made.triangles[i]);
    if (closes) closed_area += triangle_area(c[0], c[1], c[2]);
    sample(c, kSpacing * diagonal,
           [&](Vec3 p) { (closes ? farthest_closed : farthest).add(std::sqrt(input.nearest(p).squared_distance), p); });
  }
  return {{"boundary_from_input", farthest.json(diagonal)},
          {"closed_from_input", farthest_closed.json(diagonal)},
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

Json judge(const std::string& input_file, const std::string& result, const std::string& closed) {
  const SurfaceMesh input = repair_surface(read_surface(input_file).surface).surface;
  const MadeResult made = read_result(result);
  if (made.boundary.triangles.empty()) return {{"empty", true}};
  const TriangleTree input_tree(input), made_tree(made.boundary);
  const double diagonal = input_tree.box().diagonal();
  Json j = made.about;
  j["volume"] = enclosed_volume(made.boundary);
  j.update(boundary_from_input(made.boundary, input_tree, closed, diagonal));
  j.update(input_from_boundary(input, made_tree, diagonal));
  j["sides"] = sides(input, input_tree, made_tree, diagonal);
  return j;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("octafront_judge_repair INPUT MESH|SURFACE [CLOSED]\n", stderr);
    return 2;
  }
  try {
    fmt::print("{}\n", judge(argv[1], argv[2], argc > 3 ? argv[3] : "closed by repair").dump());
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 3;
  }
  return 0;
}
