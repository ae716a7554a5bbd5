#include "base/mesh/tet_edges.h"

#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/mesh/face_table.h"

#include <algorithm>

namespace octafront {

namespace {

/// A place where an edge is used, at its lower end.
struct TetEdgeUse {
  VertexIndex high;
  std::uint32_t tet_edge;  // 6 * tet + edge
};

}  // namespace

std::uint32_t TetEdges::find(VertexIndex a, VertexIndex b) const {
  if (a > b) std::swap(a, b);
  const auto begin = high.begin() + first[a], end = high.begin() + first[a + 1];
  const auto at = std::lower_bound(begin, end, b);
  return at != end && *at == b ? static_cast<std::uint32_t>(at - high.begin()) : kNone;
}

TetEdges edges_of_tets(std::span<const Tet> tets, std::size_t vertices,
                       std::vector<std::array<std::uint32_t, 6>>& of_tet) {
  Groups<TetEdgeUse> uses(vertices, [&](const auto& add) {
    for (std::uint32_t t = 0; t < tets.size(); ++t)
      for (std::uint32_t e = 0; e < 6; ++e) {
        const VertexIndex a = tets[t][static_cast<std::size_t>(kTetEdges[e][0])],
                          b = tets[t][static_cast<std::size_t>(kTetEdges[e][1])];
        add(std::min(a, b), TetEdgeUse{std::max(a, b), 6 * t + e});
      }
  });
  TetEdges edges;
  edges.first.assign(vertices + 1, 0);
  parallel_for(vertices, [&](std::size_t v) {
    const auto here = uses[v];
    std::sort(here.begin(), here.end(), [](const TetEdgeUse& x, const TetEdgeUse& y) { return x.high < y.high; });
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < here.size(); ++i) count += i == 0 || here[i].high != here[i - 1].high;
    edges.first[v + 1] = count;
  });
  for (std::size_t v = 0; v < vertices; ++v) edges.first[v + 1] += edges.first[v];
  edges.high.resize(edges.first[vertices]);
  edges.low.resize(edges.high.size());
  of_tet.resize(tets.size());
  parallel_for(vertices, [&](std::size_t v) {
    const auto here = uses[v];
    std::uint32_t e = edges.first[v] - 1;
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (i == 0 || here[i].high != here[i - 1].high) {
        edges.high[++e] = here[i].high;
        edges.low[e] = static_cast<VertexIndex>(v);
      }
      of_tet[here[i].tet_edge / 6][here[i].tet_edge % 6] = e;
    }
  });
  return edges;
}

TetFaces faces_of_tets(std::span<const Tet> tets, std::size_t vertices) {
  struct FaceUse {
    VertexIndex middle, high;
    std::uint32_t half_face;
  };
  Groups<FaceUse> uses(vertices, [&](const auto& add) {
    for (std::uint32_t t = 0; t < tets.size(); ++t)
      for (int i = 0; i < 4; ++i) {
        const Triangle key = face_key(face_of(tets[t], i));
        add(key[0], FaceUse{key[1], key[2], 4 * t + static_cast<std::uint32_t>(i)});
      }
  });
  TetFaces faces;
  faces.of_tet.resize(tets.size());
  for (VertexIndex v = 0; v < uses.size(); ++v) {
    const std::span<FaceUse> here = uses[v];
    std::ranges::sort(here, {}, [](const FaceUse& u) { return std::array{u.middle, u.high, u.half_face}; });
    for (std::size_t i = 0; i < here.size(); ++i) {
      const auto& [middle, high, half_face] = here[i];
      if (i == 0 || here[i - 1].middle != middle || here[i - 1].high != high)
        faces.corners.push_back({v, middle, high});
      faces.of_tet[half_face / 4][half_face % 4] = static_cast<std::uint32_t>(faces.corners.size() - 1);
    }
  }
  return faces;
}

}  // namespace octafront
