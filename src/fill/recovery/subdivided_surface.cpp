#include "fill/recovery/subdivided_surface.h"

#include <algorithm>

namespace octafront::recovery {

SubdividedSurface::SubdividedSurface(const std::vector<Triangle>& triangles) : triangles_(triangles) {
  edges_.reserve(triangles.size() * 3 / 2);
  for (const Triangle& t : triangles) {
    for (int i = 0; i < 3; ++i) edges_.insert(t[i], t[(i + 1) % 3]);
  }
}

std::vector<Edge> SubdividedSurface::input_edges() const {
  std::vector<Edge> list;
  list.reserve(3 * triangles_.size());
  for (const Triangle& t : triangles_) {
    for (int i = 0; i < 3; ++i) list.push_back(sorted_edge(t[i], t[(i + 1) % 3]));
  }
  std::ranges::sort(list);
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

void SubdividedSurface::split_edge(VertexIndex a, VertexIndex b, VertexIndex s) {
  edges_.erase(a, b);
  edges_.insert(a, s);
  edges_.insert(s, b);
  middle_.emplace(sorted_edge(a, b), s);
}

void SubdividedSurface::expand(VertexIndex a, VertexIndex b, std::vector<VertexIndex>& chain) const {
  const auto it = middle_.find(sorted_edge(a, b));
  if (it == middle_.end()) {
    chain.push_back(a);
    return;
  }
  expand(a, it->second, chain);
  expand(it->second, b, chain);
}

bool SubdividedSurface::is_divided(const Triangle& t) const {
  if (middle_.empty()) return false;
  for (int i = 0; i < 3; ++i) {
    if (middle_.contains(sorted_edge(t[i], t[(i + 1) % 3]))) return true;
  }
  return false;
}

std::uint32_t SubdividedSurface::add_facet(const Triangle& corners, std::uint32_t parent) {
  facets_.push_back({corners, parent});
  return static_cast<std::uint32_t>(facets_.size() - 1);
}

}  // namespace octafront::recovery
