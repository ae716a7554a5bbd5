#include "mesh/adjacency.h"

#include "mesh/index_range.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace octafront {

FaceKey::FaceKey(const Triangle& t) : low(t[0]), middle(t[1]), high(t[2]), even(true) {
  const auto order = [this](VertexIndex& a, VertexIndex& b) {
    if (a <= b) return;
    std::swap(a, b);
    even = !even;
  };
  order(low, middle);
  order(middle, high);
  order(low, middle);
}

FaceTable::FaceTable(std::span<const Tet> tets, std::size_t vertex_count) : first_of_vertex(vertex_count + 2, 0) {
  // Counting sort by the lowest vertex. Counts stand two places ahead, so that after the sums place v + 1 is the
  // cursor of bucket v, and after filling it is the end of it.
  require_in_range(tets.size(), kMostTetsWithHalfFaces, "tetrahedra with half-faces");
  const auto half_faces = static_cast<HalfFace>(4 * tets.size());
  for (HalfFace h = 0; h < half_faces; ++h) {
    const Triangle t = corners_of(tets, h);
    ++first_of_vertex[std::min({t[0], t[1], t[2]}) + 2];
  }
  std::partial_sum(first_of_vertex.begin(), first_of_vertex.end(), first_of_vertex.begin());
  entries.resize(half_faces);
  for (HalfFace h = 0; h < half_faces; ++h) {
    const FaceKey key(corners_of(tets, h));
    entries[first_of_vertex[key.low + 1]++] = {key.middle, key.high, h};
  }
  first_of_vertex.pop_back();
  const auto before = [](const Entry& a, const Entry& b) {
    return std::tie(a.middle, a.high, a.half_face) < std::tie(b.middle, b.high, b.half_face);
  };
  for (std::size_t v = 0; v < vertex_count; ++v)
    std::sort(entries.begin() + static_cast<std::ptrdiff_t>(first_of_vertex[v]),
              entries.begin() + static_cast<std::ptrdiff_t>(first_of_vertex[v + 1]), before);
}

std::vector<HalfFace> half_face_neighbors(std::span<const Tet> tets, std::size_t vertex_count) {
  require_in_range(tets.size(), kMostTetsWithHalfFaces, "tetrahedra with half-faces");
  std::vector<HalfFace> across(4 * tets.size(), kNone);
  FaceTable(tets, vertex_count).for_each_face([&](VertexIndex, std::span<const FaceTable::Entry> on_face) {
    if (on_face.size() != 2) return;
    across[on_face[0].half_face] = on_face[1].half_face;
    across[on_face[1].half_face] = on_face[0].half_face;
  });
  return across;
}

std::vector<Triangle> boundary_triangles(std::span<const Tet> tets, std::span<const HalfFace> across) {
  std::vector<Triangle> boundary;
  for (HalfFace h = 0; h < across.size(); ++h)
    if (across[h] == kNone) boundary.push_back(corners_of(tets, h));
  return boundary;
}

}  // namespace octafront
