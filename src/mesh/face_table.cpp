#include "mesh/face_table.h"

#include <algorithm>
#include <tuple>

namespace octafront {

void FaceTable::sort() {
  for (std::size_t v = 0; v < entries_.size(); ++v) {
    const std::span<Entry> at_vertex = entries_[v];
    std::sort(at_vertex.begin(), at_vertex.end(), [](const Entry& a, const Entry& b) {
      return std::tie(a.middle, a.high, a.face) < std::tie(b.middle, b.high, b.face);
    });
  }
}

std::span<const FaceTable::Entry> FaceTable::group_of(const Triangle& corners) const {
  const Triangle key = face_key(corners);
  const std::span<const Entry> at_vertex = entries_[key[0] - first_];
  const auto [first, last] = std::equal_range(
      at_vertex.begin(), at_vertex.end(), Entry{key[1], key[2], 0},
      [](const Entry& a, const Entry& b) { return std::tie(a.middle, a.high) < std::tie(b.middle, b.high); });
  return {first, last};
}

FaceTable face_table(std::size_t vertices, std::span<const Triangle> faces) {
  return {vertices, [&](const auto& add) {
            for (std::uint32_t i = 0; i < faces.size(); ++i) add(faces[i], i);
          }};
}

}  // namespace octafront
