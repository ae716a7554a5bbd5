#include "io/boundary.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace octafront::io {
namespace {

using Key = std::array<VertexIndex, 3>;  ///< the vertices of a face in increasing order

Key key_of(VertexIndex a, VertexIndex b, VertexIndex c) {
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  return {a, b, c};
}

Triangle face_of(const Tet& t, int i) {
  const auto& f = kTetFaces[static_cast<std::size_t>(i)];
  return {t[static_cast<std::size_t>(f[0])], t[static_cast<std::size_t>(f[1])], t[static_cast<std::size_t>(f[2])]};
}

Key key_of(const Triangle& t) {
  return key_of(t[0], t[1], t[2]);
}

/// Numbers of faces, sorted into buckets by their smallest vertex: bucket v is [begin[v], begin[v + 1]).
struct Buckets {
  std::vector<std::uint64_t> begin;
  std::vector<std::uint64_t> face;
};

template <class KeyAt>
Buckets bucketed(std::uint64_t faces, std::size_t points, const KeyAt& key_at) {
  Buckets b;
  b.begin.assign(points + 1, 0);
  for (std::uint64_t f = 0; f < faces; ++f) ++b.begin[key_at(f)[0] + 1];
  for (std::size_t v = 0; v < points; ++v) b.begin[v + 1] += b.begin[v];
  b.face.resize(faces);
  std::vector<std::uint64_t> next(b.begin.begin(), b.begin.end() - 1);
  for (std::uint64_t f = 0; f < faces; ++f) b.face[next[key_at(f)[0]]++] = f;
  return b;
}

}  // namespace

std::vector<TetIndex> tets_of_faces(std::span<const Tet> tets, std::span<const Triangle> faces, std::size_t points) {
  const Buckets buckets = bucketed(faces.size(), points, [&](std::uint64_t f) { return key_of(faces[f]); });
  std::vector<TetIndex> tet_of(faces.size(), kNone);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (int i = 0; i < 4; ++i) {
      const Key key = key_of(face_of(tets[t], i));
      for (std::uint64_t k = buckets.begin[key[0]]; k < buckets.begin[key[0] + 1]; ++k) {
        const std::uint64_t f = buckets.face[k];
        if (tet_of[f] == kNone && key_of(faces[f]) == key) tet_of[f] = static_cast<TetIndex>(t);
      }
    }
  }
  return tet_of;
}

std::vector<Triangle> boundary_of(std::span<const Tet> tets, std::size_t points) {
  const auto half_face = [&](std::uint64_t h) { return face_of(tets[h / 4], static_cast<int>(h % 4)); };
  const auto key_at = [&](std::uint64_t h) { return key_of(half_face(h)); };
  Buckets buckets = bucketed(4 * std::uint64_t{tets.size()}, points, key_at);
  std::vector<Triangle> boundary;
  std::vector<std::pair<Key, std::uint64_t>> bucket;
  for (std::size_t v = 0; v < points; ++v) {
    bucket.clear();
    for (std::uint64_t k = buckets.begin[v]; k < buckets.begin[v + 1]; ++k)
      bucket.emplace_back(key_at(buckets.face[k]), buckets.face[k]);
    std::sort(bucket.begin(), bucket.end());
    for (std::size_t i = 0; i < bucket.size();) {
      std::size_t j = i + 1;
      while (j < bucket.size() && bucket[j].first == bucket[i].first) ++j;
      if (j == i + 1) boundary.push_back(half_face(bucket[i].second));
      i = j;
    }
  }
  return boundary;
}

}  // namespace octafront::io
