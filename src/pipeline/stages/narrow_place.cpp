#include "base/core/elementary.h"
#include "base/geometry/measures.h"
#include "base/mesh/complex.h"
#include "pipeline/stages/requirements.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront {
namespace {

constexpr double kWide = 20;  // degrees
/// Lines where walls turn by more are lines of the input: 40 degrees.
constexpr double kSharp = 0.766;
/// Pairs of triangles are looked at: of those near the element the nearest.
constexpr std::size_t kMostNear = 500;

double in_degrees(double across, double along) {
  return elementary::atan2(across, along) * 180 / std::numbers::pi;
}

class Around {
 public:
  Around(const SurfaceMesh& input, const std::array<Vec3, 4>& element) : input_(input) {
    center_ = centroid(element[0], element[1], element[2], element[3]);
    for (const Vec3 p : element)
      for (const Vec3 q : element) size_ = std::max(size_, distance(p, q));
    find_near();
    for (const std::uint32_t t : near_)
      for (int i = 0; i < 3; ++i) uses_[edge(t, i)].push_back(t);
  }

  std::optional<NarrowPlace> narrowest(bool kept) {
    if (kept) look_at_triangles();
    look_at_edges();
    look_at_gaps();
    return best_;
  }

 private:
  Vec3 point(std::uint32_t t, int i) const { return input_.points[input_.triangles[t][i % 3]]; }
  Vec3 normal(std::uint32_t t) const { return unit_normal(point(t, 0), point(t, 1), point(t, 2)); }
  Edge edge(std::uint32_t t, int i) const {
    return sorted_edge(input_.triangles[t][i], input_.triangles[t][(i + 1) % 3]);
  }

  void find_near() {
    std::vector<std::pair<double, std::uint32_t>> near;
    for (std::uint32_t t = 0; t < input_.triangles.size(); ++t) {
      const double d = distance(center_, closest_point_on_triangle(center_, point(t, 0), point(t, 1), point(t, 2)));
      if (d <= size_) near.emplace_back(d, t);
    }
    std::sort(near.begin(), near.end());
    near.resize(std::min(near.size(), kMostNear));
    for (const auto& [d, t] : near) near_.push_back(t);
  }

  template <class Words>
  void offer(double degrees, const Words& words) {
    if (degrees < (best_ ? best_->degrees : kWide)) best_ = {degrees, words()};
  }

  /// What lies on a side of a triangle: a body, or nothing.
  std::uint32_t region_towards(std::uint32_t t, Vec3 way) const {
    return input_.sides_of(t)[dot(normal(t), way) > 0 ? 0 : 1];
  }
  std::string name_of_region(std::uint32_t r) const { return fmt::format("\"{}\"", region_name(input_, r)); }
  bool is_contact(std::uint32_t t) const {
    const Sides sides = input_.sides_of(t);
    return sides[0] != kNone && sides[1] != kNone && sides[0] != sides[1];
  }
  /// "at the contact of "a" and "b"": of the triangles themselves, or of one beside them.
  std::string where(std::initializer_list<std::uint32_t> triangles) const {
    for (const std::uint32_t t : triangles)
      if (is_contact(t)) return " at" + contact(t);
    for (const std::uint32_t t : triangles)
      for (const std::uint32_t u : near_)
        if (is_contact(u) && share_a_vertex(t, u)) return " beside" + contact(u);
    const std::uint32_t patch = input_.patch_of(*triangles.begin());
    if (patch < input_.patch_names.size() && !input_.patch_names[patch].empty())
      return fmt::format(" at \"{}\"", input_.patch_names[patch]);
    return "";
  }
  std::string contact(std::uint32_t t) const {
    const Sides sides = input_.sides_of(t);
    return fmt::format(" the contact of {} and {}", name_of_region(std::min(sides[0], sides[1])),
                       name_of_region(std::max(sides[0], sides[1])));
  }

  void look_at_triangles() {
    for (const std::uint32_t t : near_)
      for (int i = 0; i < 3; ++i) {
        const Vec3 u = point(t, i + 1) - point(t, i), v = point(t, i + 2) - point(t, i);
        const double angle = in_degrees(length(cross(u, v)), dot(u, v));
        offer(angle, [&] {
          return fmt::format("a triangle that was kept has an angle of {:.2g} degrees there{}", angle, where({t}));
        });
      }
  }

  void look_at_edges() {
    for (const auto& use : uses_) {
      const Edge& e = use.first;
      const std::vector<std::uint32_t>& around = use.second;
      const Vec3 p = input_.points[e[0]], q = input_.points[e[1]];
      if (distance(center_, closest_point_on_segment(center_, p, q)) > size_) continue;
      for (std::size_t i = 0; i < around.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) look_at_wedge(e, around[i], around[j]);
      const bool is_line =
          around.size() > 2 || (around.size() == 2 && dot(normal(around[0]), normal(around[1])) < kSharp);
      if (!is_line) continue;
      offer(in_degrees(distance(p, q), size_), [&] {
        return fmt::format("an edge of the input is {:.2g} long there{}, and the element {:.2g}", distance(p, q),
                           where({around[0], around.back()}), size_);
      });
    }
  }

  void look_at_wedge(const Edge& e, std::uint32_t s, std::uint32_t t) {
    const Vec3 p = input_.points[e[0]], along = normalized(input_.points[e[1]] - p);
    const auto across = [&](std::uint32_t f) {
      Vec3 way;
      for (int i = 0; i < 3; ++i)
        if (edge(f, i) == e) way = point(f, i + 2) - p;
      return normalized(way - dot(way, along) * along);
    };
    const Vec3 u = across(s), v = across(t);
    if (region_towards(s, v) == kNone && region_towards(t, u) == kNone) return;
    const double angle = in_degrees(length(cross(u, v)), dot(u, v));
    offer(angle, [&] {
      return fmt::format("walls of the input meet at {:.2g} degrees there{}", angle, where({s, t}));
    });
  }

  void look_at_gaps() {
    for (const std::uint32_t s : near_)
      for (const std::uint32_t t : near_)
        if (s != t && !share_a_vertex(s, t)) look_at_gap(s, t);
  }
  bool share_a_vertex(std::uint32_t s, std::uint32_t t) const {
    const Triangle &a = input_.triangles[s], &b = input_.triangles[t];
    return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
  }
  /// From corners and middles of edges of the one, and where it lies nearest to the element, to the other, through a
  /// body.
  void look_at_gap(std::uint32_t s, std::uint32_t t) {
    // The cosine of how far from straight across: 60 degrees.
    constexpr double kAcross = 0.5;
    for (int i = 0; i < 7; ++i) {
      const Vec3 p = i < 3   ? point(s, i)
                     : i < 6 ? (point(s, i) + point(s, i + 1)) / 2
                             : closest_point_on_triangle(center_, point(s, 0), point(s, 1), point(s, 2));
      const Vec3 q = closest_point_on_triangle(p, point(t, 0), point(t, 1), point(t, 2));
      const double gap = distance(p, q);
      if (std::abs(dot(normal(s), q - p)) < kAcross * gap || std::abs(dot(normal(t), q - p)) < kAcross * gap) continue;
      if (distance(center_, (p + q) / 2) > size_ || region_towards(s, q - p) == kNone) continue;
      offer(in_degrees(gap, size_), [&] {
        return fmt::format("walls of the input are {:.2g} apart there{}, and the element {:.2g} long", gap,
                           where({s, t}), size_);
      });
    }
  }

  const SurfaceMesh& input_;
  Vec3 center_;
  double size_ = 0;
  std::vector<std::uint32_t> near_;
  std::map<Edge, std::vector<std::uint32_t>> uses_;
  std::optional<NarrowPlace> best_;
};

}  // namespace

std::optional<NarrowPlace> narrow_place_at(const SurfaceMesh& input, const std::array<Vec3, 4>& element, bool kept) {
  return Around(input, element).narrowest(kept);
}

}  // namespace octafront
