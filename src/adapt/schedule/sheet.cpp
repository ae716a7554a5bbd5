#include "adapt/schedule/sheet.h"

#include <algorithm>
#include <cmath>

namespace octafront::adapt {

Sheet::Sheet(std::vector<Vertex> all, std::span<const Triangle> triangles, std::span<const std::uint32_t> part)
    : vertices(std::move(all)), line_edges(triangles.size()), star_(vertices.size()) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    faces_.push_back({triangles[t], part[t]});
    for (const VertexIndex v : triangles[t]) star_[v].push_back(static_cast<std::uint32_t>(t));
  }
}

std::vector<std::uint32_t> Sheet::around(VertexIndex a, VertexIndex b) const {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t t : star_[a])
    if (const Triangle& c = faces_[t].corners; c[0] == b || c[1] == b || c[2] == b) found.push_back(t);
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<VertexIndex> Sheet::neighbours(VertexIndex v) const {
  std::vector<VertexIndex> all;
  for (const std::uint32_t t : star_[v])
    for (const VertexIndex u : faces_[t].corners)
      if (u != v) all.push_back(u);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

double Sheet::score_of(const std::array<const Vertex*, 3>& corners) {
  const Vertex* densest = corners[0];
  for (const Vertex* v : corners)
    if (v->density > densest->density) densest = v;
  const Metric& m = densest->metric;
  const Vec3 u = corners[1]->at - corners[0]->at, w = corners[2]->at - corners[0]->at;
  const double uu = m.squared(u), ww = m.squared(w), uw = dot(u, m.times(w));
  const double sum = uu + ww + m.squared(w - u);
  constexpr double kRegular = 3.4641016151377544;  // a regular triangle has an area of sqrt 3 / 12 of the sum
  return sum > 0 ? kRegular * std::sqrt(std::max(uu * ww - uw * uw, 0.0)) / sum : 0;
}

VertexIndex Sheet::add(const Vertex& v) {
  vertices.push_back(v);
  star_.emplace_back();
  return static_cast<VertexIndex>(vertices.size() - 1);
}

void Sheet::replace(std::span<const std::uint32_t> old, std::span<const Face> fresh) {
  for (const std::uint32_t t : old) {
    for (const VertexIndex v : faces_[t].corners) std::erase(star_[v], t), touch(v);
    faces_[t].corners = {kNone, kNone, kNone};
    free_.push_back(t);
  }
  for (const Face& face : fresh) {
    auto t = static_cast<std::uint32_t>(faces_.size());
    if (free_.empty()) {
      faces_.push_back(face);
    } else {
      t = free_.back();
      free_.pop_back();
      faces_[t] = face;
    }
    for (const VertexIndex v : face.corners) star_[v].push_back(t), touch(v);
  }
}

std::optional<std::string> Sheet::first_inconsistency() const {
  for (VertexIndex v = 0; v < star_.size(); ++v)
    for (const std::uint32_t t : star_[v]) {
      const Triangle& c = faces_[t].corners;
      if (std::find(c.begin(), c.end(), v) == c.end())
        return "vertex " + std::to_string(v) + " has triangle " + std::to_string(t) + " around it, which has it not";
    }
  for (std::uint32_t t = 0; t < faces_.size(); ++t) {
    if (!alive(t)) continue;
    const Triangle& c = faces_[t].corners;
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) return "triangle " + std::to_string(t) + " has a corner twice";
    for (const VertexIndex v : c)
      if (std::find(star_[v].begin(), star_[v].end(), t) == star_[v].end())
        return "triangle " + std::to_string(t) + " is not around its corner " + std::to_string(v);
  }
  std::optional<std::string> wrong;
  line_edges.for_each([&](const Edge& e, std::uint32_t) {
    if (!wrong && around(e[0], e[1]).empty())
      wrong = "the line from " + std::to_string(e[0]) + " to " + std::to_string(e[1]) + " has no triangle";
  });
  return wrong;
}

}  // namespace octafront::adapt
