#include "base/mesh/face_table.h"

#include <algorithm>

namespace octafront {

namespace {

/// Both corners in one number: one comparison instead of two.
std::uint64_t corners_of(const FaceTable::Entry& e) {
  return std::uint64_t{e.middle} << 32 | e.high;
}

}  // namespace

void FaceTable::sort() {
  for (std::size_t v = 0; v < entries_.size(); ++v) {
    const std::span<Entry> at_vertex = entries_[v];
    std::sort(at_vertex.begin(), at_vertex.end(), [](const Entry& a, const Entry& b) {
      const std::uint64_t of_a = corners_of(a), of_b = corners_of(b);
      return of_a != of_b ? of_a < of_b : a.face < b.face;
    });
  }
}

std::span<const FaceTable::Entry> FaceTable::group_of(const Triangle& corners) const {
  const Triangle key = face_key(corners);
  const std::span<const Entry> at_vertex = entries_[key[0] - first_];
  const auto [first, last] =
      std::equal_range(at_vertex.begin(), at_vertex.end(), Entry{key[1], key[2], 0},
                       [](const Entry& a, const Entry& b) { return corners_of(a) < corners_of(b); });
  return {first, last};
}

FaceTable face_table(std::size_t vertices, std::span<const Triangle> faces) {
  return {vertices, [&](const auto& add) {
            for (std::uint32_t i = 0; i < faces.size(); ++i) add(faces[i], i);
          }};
}

}  // namespace octafront
