#include <octafront/error.h>

#include "base/core/parallel.h"
#include "base/core/renumber.h"
#include "soup/tidy/steps.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/core.h>

namespace octafront::tidy {
namespace {

/// Range in which the exact predicates are exact (see base/geometry/predicates.h).
constexpr double kSmallest = 1e-50, kLargest = 1e50;

/// Reports and files have a line for each region.
constexpr std::uint32_t kMostRegionNumbers = 1u << 24;

std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93u;
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93u;
  return x ^ (x >> 32);
}

std::uint64_t hash(Vec3 p) {
  std::uint64_t h = 0x9e3779b97f4a7c15u;
  // Adding 0 turns -0 into 0: equal coordinates have equal bits then.
  for (const double x : {p.x, p.y, p.z}) h = mix(h ^ std::bit_cast<std::uint64_t>(x + 0.0)) + 0x9e3779b97f4a7c15u;
  return h;
}

/// Per point: the first of `used` points that equals it. A table of indices, for files with three points for each
/// triangle: a FlatMap of points would take eight times the memory.
std::vector<VertexIndex> first_equal(const std::vector<Vec3>& points, const std::vector<char>& used,
                                     const RunContext& context) {
  std::size_t slots = 16;
  while (slots < 2 * points.size()) slots *= 2;
  std::vector<VertexIndex> table(slots, kNone), first(points.size(), kNone);
  for (VertexIndex v = 0; v < points.size(); ++v) {
    if (v % 4096 == 0) context.check();
    if (!used[v]) continue;
    std::size_t slot = hash(points[v]) & (slots - 1);
    while (table[slot] != kNone && points[table[slot]] != points[v]) slot = (slot + 1) & (slots - 1);
    if (table[slot] == kNone) table[slot] = v;
    first[v] = table[slot];
  }
  return first;
}

std::vector<char> used_vertices(const SurfaceMesh& mesh) {
  std::vector<char> used(mesh.points.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const VertexIndex v : t) used[v] = 1;
  return used;
}

/// Keeps the points v with keep[v] == v; other entries say which point stands for v, or kNone.
void renumber(Draft& draft, const std::vector<VertexIndex>& keep) {
  SurfaceMesh& mesh = draft.mesh;
  draft.known_edges.reset();
  std::vector<VertexIndex> number(keep.size());
  for (VertexIndex v = 0; v < keep.size(); ++v) number[v] = keep[v] == v ? v : kNone;
  keep_numbered(mesh.points, number);
  for (Triangle& t : mesh.triangles)
    for (VertexIndex& v : t) v = number[keep[v]];
}

void check_face(const SurfaceMesh& soup, const Triangle& t, std::uint32_t face) {
  for (const VertexIndex v : t) {
    if (v >= soup.points.size())
      throw InputError(fmt::format("face {} refers to vertex {}, but there are only {}: the file is damaged", face, v,
                                   soup.points.size()));
    const Vec3 p = soup.points[v];
    const double size = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (!is_finite(p) || size > kLargest)
      throw InputError(
          fmt::format("vertex {} of face {} is at ({}, {}, {}): coordinates must be finite numbers below "
                      "{:g}; correct or remove the face",
                      v, face, p.x, p.y, p.z, kLargest));
  }
}

bool is_usable(const SurfaceMesh& soup, const Triangle& t) {
  return std::ranges::all_of(t, [&](VertexIndex v) {
    if (v >= soup.points.size()) return false;
    const Vec3 p = soup.points[v];
    return is_finite(p) && std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kLargest;
  });
}

Box3 box_of_faces(const SurfaceMesh& soup) {
  struct Part {
    Box3 box;
    Part& operator+=(const Part& other) { return box.add(other.box), *this; }
  };
  return parallel_sum(soup.triangles.size(),
                      [&](std::size_t begin, std::size_t end) {
                        Part part;
                        for (std::size_t t = begin; t < end; ++t)
                          for (const VertexIndex v : soup.triangles[t]) part.box.add(soup.points[v]);
                        return part;
                      })
      .box;
}

}  // namespace

void check_input(const SurfaceMesh& soup) {
  const std::size_t faces = soup.triangles.size();
  if (!soup.source.empty() && soup.source.size() != faces)
    throw InputError(fmt::format("{} input faces are given for {} triangles", soup.source.size(), faces));
  if (!soup.patch.empty() && soup.patch.size() != faces)
    throw InputError(fmt::format("{} patches are given for {} triangles", soup.patch.size(), faces));
  if (!soup.sides.empty() && soup.sides.size() != faces)
    throw InputError(fmt::format("{} pairs of sides are given for {} triangles", soup.sides.size(), faces));
  for (std::size_t t = 0; t < soup.sides.size(); ++t)
    for (const std::uint32_t region : soup.sides[t])
      if (region != kNone && region >= kMostRegionNumbers)
        throw InputError(fmt::format("face {} names region {}: regions are numbered from 0, below {}",
                                     soup.source_of(t), region, kMostRegionNumbers));
  // Half-edges are numbered with 32 bits.
  if (faces > kNone / 3 - 1)
    throw InputError(fmt::format("{} triangles are too many (at most {})", faces, kNone / 3 - 1));
  if (const std::size_t bad = parallel_find(faces, [&](std::size_t t) { return !is_usable(soup, soup.triangles[t]); });
      bad < faces)
    check_face(soup, soup.triangles[bad], soup.source_of(bad));
  if (faces == 0) return;
  const Vec3 extent = box_of_faces(soup).extent();
  const double size = std::max({extent.x, extent.y, extent.z});
  if (size > 0 && size < kSmallest)
    throw InputError(fmt::format("the model is only {:g} wide: scale it to a size above {:g}", size, kSmallest));
}

Merged merge_vertices(Draft& draft) {
  const std::vector<char> used = used_vertices(draft.mesh);
  const std::vector<VertexIndex> first = first_equal(draft.mesh.points, used, draft.context);
  Merged merged;
  for (VertexIndex v = 0; v < first.size(); ++v) {
    merged.unused += first[v] == kNone;
    merged.merged += first[v] != kNone && first[v] != v;
  }
  if (merged.merged + merged.unused > 0) renumber(draft, first);
  return merged;
}

std::uint64_t drop_unused_vertices(Draft& draft) {
  const std::vector<char> used = used_vertices(draft.mesh);
  std::vector<VertexIndex> keep(used.size(), kNone);
  std::uint64_t unused = 0;
  for (VertexIndex v = 0; v < used.size(); ++v) {
    if (used[v]) keep[v] = v;
    unused += !used[v];
  }
  if (unused > 0) renumber(draft, keep);
  return unused;
}

void drop_marked(Draft& draft, const std::vector<char>& marked) {
  draft.known_edges.reset();
  SurfaceMesh& mesh = draft.mesh;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (marked[t]) continue;
    mesh.triangles[kept] = mesh.triangles[t];
    draft.face[kept] = draft.face[t];
    if (!mesh.patch.empty()) mesh.patch[kept] = mesh.patch[t];
    if (!mesh.sides.empty()) mesh.sides[kept] = mesh.sides[t];
    ++kept;
  }
  mesh.triangles.resize(kept);
  draft.face.resize(kept);
  if (!mesh.patch.empty()) mesh.patch.resize(kept);
  if (!mesh.sides.empty()) mesh.sides.resize(kept);
}

void sort_unique(InputFaces& faces) {
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
}

}  // namespace octafront::tidy
