#pragma once

#include <octafront/tet_mesh.h>

#include "base/core/groups.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace octafront {

/// Face i of a tet, counter-clockwise seen from outside.
inline Triangle face_of(const Tet& t, int i) {
  const auto& f = kTetFaces[i];
  return {t[f[0]], t[f[1]], t[f[2]]};
}

/// Whether the corners are an even permutation of the ascending ones. Faces on the same vertices have the same side in
/// front of them if both are even or both odd.
inline bool is_even(const Triangle& t) {
  return ((t[0] > t[1]) + (t[1] > t[2]) + (t[0] > t[2])) % 2 == 0;
}

/// Faces by number, those on the same three vertices side by side.
class FaceTable {
 public:
  struct Entry {
    VertexIndex middle, high;  ///< of the key; the lowest vertex owns the group
    std::uint32_t face;
  };

  /// visit(add) calls add(corners, number) for each face; it is called twice and must visit the same both times.
  /// REQUIRES vertex indices in range. Some 10 ns a face.
  template <class Visit>
  FaceTable(std::size_t vertices, const Visit& visit) : FaceTable(0, vertices, visit) {}
  /// Of faces whose lowest vertices are the `vertices` ones from `first` on.
  template <class Visit>
  FaceTable(VertexIndex first, std::size_t vertices, const Visit& visit)
      : first_(first), entries_(vertices, [&](const auto& add) {
          visit([&](const Triangle& corners, std::uint32_t face) {
            const Triangle key = face_key(corners);
            add(key[0] - first, Entry{key[1], key[2], face});
          });
        }) {
    sort();
  }
  /// Of a list of faces, numbered by their places in it, by several threads.
  FaceTable(std::size_t vertices, std::span<const Triangle> faces);
  /// Calls visit(key, entries) for each set of faces on the same vertices, numbers ascending, in the order of the keys.
  template <class Visit>
  void for_each_group(Visit&& visit) const {
    for (std::size_t v = 0; v < entries_.size(); ++v) {
      const std::span<const Entry> at_vertex = entries_[v];
      for (std::size_t i = 0, j = 0; i < at_vertex.size(); i = j) {
        while (j < at_vertex.size() && at_vertex[j].middle == at_vertex[i].middle &&
               at_vertex[j].high == at_vertex[i].high)
          ++j;
        visit(Triangle{first_ + static_cast<VertexIndex>(v), at_vertex[i].middle, at_vertex[i].high},
              at_vertex.subspan(i, j - i));
      }
    }
  }
  /// The entries of the faces on the same vertices as this one.
  std::span<const Entry> group_of(const Triangle& corners) const;

 private:
  void sort();

  VertexIndex first_;
  Groups<Entry, std::uint64_t> entries_;  ///< by lowest vertex, sorted by middle, high, face
};

/// The faces of a list by their places in it.
FaceTable face_table(std::size_t vertices, std::span<const Triangle> faces);

}  // namespace octafront
