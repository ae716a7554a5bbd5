#include "recovery/subdivided_surface.h"

#include <algorithm>

namespace octafront::recovery {

namespace {

bool has(const Triangle& t, VertexIndex v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

}  // namespace

SubdividedSurface::SubdividedSurface(const std::vector<Triangle>& triangles, VertexIndex vertices)
    : first_(vertices + 1, 0), facet_at_(3 * triangles.size()) {
  edges_.reserve(triangles.size() * 3 / 2);
  facets_.reserve(triangles.size());
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    const Triangle& t = triangles[f];
    facets_.push_back({t, f});
    for (int i = 0; i < 3; ++i) {
      edges_.insert(t[i], t[(i + 1) % 3]);
      ++first_[t[i] + 1];
    }
  }
  for (VertexIndex v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    for (const VertexIndex v : triangles[f]) facet_at_[next[v]++] = f;
  }
}

std::vector<Edge> SubdividedSurface::edge_list() const {
  std::vector<Edge> list;
  list.reserve(3 * facets_.size());
  for (const Facet& f : facets_) {
    for (int i = 0; f.alive && i < 3; ++i) {
      const VertexIndex a = f.corners[i], b = f.corners[(i + 1) % 3];
      list.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::ranges::sort(list);
  list.erase(std::ranges::unique(list).begin(), list.end());
  return list;
}

std::vector<std::uint32_t> SubdividedSurface::facets_around(VertexIndex a, VertexIndex b) const {
  std::vector<std::uint32_t> result;
  const auto look = [&](std::uint32_t f) {
    if (facets_[f].alive && has(facets_[f].corners, a) && has(facets_[f].corners, b)) result.push_back(f);
  };
  if (a + 1 < first_.size()) {
    for (std::uint32_t k = first_[a]; k < first_[a + 1]; ++k) look(facet_at_[k]);
  }
  if (const auto it = added_at_.find(a); it != added_at_.end()) {
    for (const std::uint32_t f : it->second) look(f);
  }
  return result;
}

void SubdividedSurface::add_facet(const Triangle& corners, std::uint32_t parent) {
  const auto f = static_cast<std::uint32_t>(facets_.size());
  facets_.push_back({corners, parent});
  for (const VertexIndex v : corners) added_at_[v].push_back(f);
}

void SubdividedSurface::split_edge(VertexIndex a, VertexIndex b, VertexIndex s, std::vector<Edge>& new_edges) {
  edges_.erase(a, b);
  edges_.insert(a, s);
  edges_.insert(s, b);
  for (const std::uint32_t f : facets_around(a, b)) {
    facets_[f].alive = false;
    for (const VertexIndex v : {a, b}) {
      Triangle t = facets_[f].corners;
      std::ranges::replace(t, v, s);
      add_facet(t, facets_[f].parent);
    }
    for (const VertexIndex c : Triangle(facets_[f].corners)) {
      if (c == a || c == b) continue;
      edges_.insert(c, s);
      new_edges.push_back({c, s});
    }
  }
}

void SubdividedSurface::split_facet(std::uint32_t f, VertexIndex s, std::vector<Edge>& new_edges) {
  facets_[f].alive = false;
  const Triangle corners = facets_[f].corners;
  for (const VertexIndex v : corners) {
    Triangle t = corners;
    std::ranges::replace(t, v, s);
    add_facet(t, facets_[f].parent);
    edges_.insert(v, s);
    new_edges.push_back({v, s});
  }
}

}  // namespace octafront::recovery
