#include "sizing/face_neighbours.h"

#include <algorithm>

namespace octafront {

namespace {

/// The half-edges of a surface, grouped by the smaller of their ends.
struct HalfEdges {
  struct Entry {
    VertexIndex larger;
    std::uint32_t half_edge;  ///< 3 * triangle + corner
  };
  std::vector<std::uint32_t> first;
  std::vector<Entry> entries;
};

HalfEdges group_half_edges(const SurfaceMesh& surface) {
  HalfEdges h;
  h.first.assign(surface.points.size() + 1, 0);
  for (const Triangle& t : surface.triangles) {
    for (int i = 0; i < 3; ++i) ++h.first[std::min(t[i], t[(i + 1) % 3]) + 1];
  }
  for (std::size_t v = 0; v < surface.points.size(); ++v) h.first[v + 1] += h.first[v];
  h.entries.resize(h.first.back());
  std::vector<std::uint32_t> next(h.first.begin(), h.first.end() - 1);
  for (std::uint32_t f = 0; f < surface.triangles.size(); ++f) {
    const Triangle& t = surface.triangles[f];
    for (std::uint32_t i = 0; i < 3; ++i) {
      const VertexIndex a = t[i], b = t[(i + 1) % 3];
      h.entries[next[std::min(a, b)]++] = {std::max(a, b), 3 * f + i};
    }
  }
  return h;
}

}  // namespace

FaceNeighbours smooth_face_neighbours(const SurfaceMesh& surface, const std::vector<Edge>& features) {
  HalfEdges h = group_half_edges(surface);
  FaceNeighbours across(surface.triangles.size(), {kNone, kNone, kNone});
  auto feature = features.begin();
  for (VertexIndex v = 0; v < surface.points.size(); ++v) {
    const auto begin = h.entries.begin() + h.first[v], end = h.entries.begin() + h.first[v + 1];
    std::sort(begin, end, [](const auto& a, const auto& b) {
      return a.larger != b.larger ? a.larger < b.larger : a.half_edge < b.half_edge;
    });
    for (auto i = begin; i != end;) {
      auto j = i;
      while (j != end && j->larger == i->larger) ++j;
      while (feature != features.end() && *feature < Edge{v, i->larger}) ++feature;
      const bool is_feature = feature != features.end() && *feature == Edge{v, i->larger};
      if (j - i == 2 && !is_feature) {
        across[i->half_edge / 3][i->half_edge % 3] = (i + 1)->half_edge / 3;
        across[(i + 1)->half_edge / 3][(i + 1)->half_edge % 3] = i->half_edge / 3;
      }
      i = j;
    }
  }
  return across;
}

}  // namespace octafront
