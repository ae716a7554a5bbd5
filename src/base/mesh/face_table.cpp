#include "base/mesh/face_table.h"

#include <algorithm>
#include <utility>

namespace octafront {

namespace {

/// Both corners in one number: one comparison instead of two.
std::uint64_t corners_of(const FaceTable::Entry& e) {
  return std::uint64_t{e.middle} << 32 | e.high;
}

}  // namespace

FaceTable::FaceTable(std::size_t vertices, std::span<const Triangle> faces) : first_(0) {
  const Groups<> by_vertex = group_by_owner(vertices, static_cast<std::uint32_t>(faces.size()),
                                            [&](std::uint32_t f) { return face_key(faces[f])[0]; });
  RawVector<std::uint64_t> first(vertices + 1);
  parallel_for(first.size(), [&](std::size_t v) { first[v] = by_vertex.first(v); });
  RawVector<Entry> entries(faces.size());
  parallel_for(entries.size(), [&](std::size_t i) {
    const std::uint32_t face = by_vertex.items()[i];
    const Triangle key = face_key(faces[face]);
    entries[i] = {key[1], key[2], face};
  });
  entries_ = {std::move(first), std::move(entries)};
  sort();
}

void FaceTable::sort() {
  parallel_for(entries_.size(), [this](std::size_t v) {
    const std::span<Entry> at_vertex = entries_[v];
    std::sort(at_vertex.begin(), at_vertex.end(), [](const Entry& a, const Entry& b) {
      const std::uint64_t of_a = corners_of(a), of_b = corners_of(b);
      return of_a != of_b ? of_a < of_b : a.face < b.face;
    });
  });
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
  return {vertices, faces};
}

}  // namespace octafront
