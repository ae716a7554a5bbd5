#include "report/picture/scene.h"

#include "base/core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace octafront {

namespace {

constexpr double kCosineOfFeature = 0.766;  // of 40 degrees

Vec3 normal_of(const SceneTriangle& t) {
  return normalized(cross(t.at[1] - t.at[0], t.at[2] - t.at[0]));
}

/// An edge of a triangle, by its vertices in ascending order.
struct SceneEdge {
  VertexIndex low = 0, high = 0;
  std::uint32_t triangle = 0;
  std::uint8_t edge = 0;
  friend bool operator<(const SceneEdge& a, const SceneEdge& b) {
    return std::array{a.low, a.high, a.triangle, std::uint32_t{a.edge}} <
           std::array{b.low, b.high, b.triangle, std::uint32_t{b.edge}};
  }
};

std::vector<SceneEdge> edges_of(const std::vector<Triangle>& corners) {
  std::vector<SceneEdge> edges(3 * corners.size());
  parallel_for(corners.size(), [&](std::size_t t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(corners[t][i], corners[t][(i + 1) % 3]);
      edges[3 * t + i] = {low, high, static_cast<std::uint32_t>(t), static_cast<std::uint8_t>(i)};
    }
  });
  parallel_sort(edges);
  return edges;
}

}  // namespace

Rgb colour_of_mark(std::uint32_t place) {
  constexpr std::array<Rgb, 5> kMarks{
      {{0xd1, 0x00, 0x6c}, {0x00, 0x72, 0xb2}, {0xe6, 0x9f, 0x00}, {0x00, 0x9e, 0x73}, {0x56, 0xb4, 0xe9}}};
  return kMarks[place % kMarks.size()];
}

CutPlane::CutPlane(const PictureCut& cut, const std::vector<Vec3>& points) : normal_(normalized(cut.normal)) {
  if (cut.through) {
    offset_ = dot(normal_, *cut.through);
    return;
  }
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const Vec3 p : points) least = std::min(least, dot(normal_, p)), most = std::max(most, dot(normal_, p));
  offset_ = least + cut.share * (most - least);
}

void find_features(Scene& scene, const std::vector<Triangle>& corners, const std::vector<std::uint32_t>& parts,
                   const std::vector<char>& is_outer) {
  const std::vector<SceneEdge> edges = edges_of(corners);
  const auto is_feature = [&](const SceneEdge& a, const SceneEdge& b) {
    if (is_outer[a.triangle] != is_outer[b.triangle]) return false;
    if (parts[a.triangle] != parts[b.triangle]) return true;
    return is_outer[a.triangle] != 0 &&
           dot(normal_of(scene.triangles[a.triangle]), normal_of(scene.triangles[b.triangle])) < kCosineOfFeature;
  };
  const auto make_strong = [&](const SceneEdge& e) { scene.triangles[e.triangle].lines[e.edge] = EdgeLine::kStrong; };
  for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
    while (j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high) ++j;
    // The border of a hole, or where more than two meet, is a feature too.
    if (j - i == 2 ? !is_feature(edges[i], edges[i + 1]) : !is_outer[edges[i].triangle]) continue;
    for (std::size_t k = i; k < j; ++k) make_strong(edges[k]);
  }
}

void smooth_normals(Scene& scene, const std::vector<Triangle>& corners) {
  const std::size_t n = scene.triangles.size();
  std::vector<std::uint32_t> start;
  for (const Triangle& t : corners)
    for (const VertexIndex v : t) start.resize(std::max<std::size_t>(start.size(), v + std::size_t{2})), ++start[v + 1];
  for (std::size_t v = 0; v + 1 < start.size(); ++v) start[v + 1] += start[v];
  std::vector<std::uint32_t> next = start, at(3 * n);
  for (std::uint32_t t = 0; t < n; ++t)
    for (const VertexIndex v : corners[t]) at[next[v]++] = t;
  std::vector<Vec3> doubled(n);
  parallel_for(n, [&](std::size_t t) {
    const SceneTriangle& s = scene.triangles[t];
    doubled[t] = cross(s.at[1] - s.at[0], s.at[2] - s.at[0]);
  });
  scene.normals.resize(n);
  parallel_for(n, [&](std::size_t t) {
    const Vec3 own = normalized(doubled[t]);
    for (std::size_t i = 0; i < 3; ++i) {
      Vec3 sum;
      for (std::uint32_t k = start[corners[t][i]]; k < start[corners[t][i] + 1]; ++k)
        if (dot(normalized(doubled[at[k]]), own) > kCosineOfFeature) sum += doubled[at[k]];
      scene.normals[t][i] = normalized(sum);
    }
  });
}

}  // namespace octafront
