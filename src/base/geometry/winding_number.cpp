#include "base/geometry/winding_number.h"

#include <octafront/surface_mesh.h>

#include "base/geometry/measures.h"

#include <algorithm>
#include <numbers>

namespace octafront {

namespace {

constexpr std::uint32_t kLeafSize = 8;
/// A cluster is far from a point at this many of its radii. The publication takes 2 and one more term.
constexpr double kFarInRadii = 2.6;
constexpr int kMaxDepth = 64;

/// The integral of n . (x - p) / |x - p|^3 over a far cluster: its dipole, and the next term of the expansion.
double far_sum(Vec3 r, Vec3 area, const std::array<Vec3, 3>& moment) {
  const double r2 = squared_length(r), r3 = r2 * std::sqrt(r2);
  const double trace = moment[0].x + moment[1].y + moment[2].z;
  const Vec3 mr{dot(moment[0], r), dot(moment[1], r), dot(moment[2], r)};
  return (dot(area, r) + trace - 3 * dot(r, mr) / r2) / r3;
}

}  // namespace

WindingNumber::WindingNumber(const SurfaceMesh& soup) {
  triangles_.reserve(soup.triangles.size());
  for (const auto& [a, b, c] : soup.triangles) triangles_.push_back({soup.points[a], soup.points[b], soup.points[c]});
  if (triangles_.empty()) return;
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(triangles_.size()));
}

void WindingNumber::expand(Node& node, std::uint32_t begin, std::uint32_t end) const {
  double weight = 0;
  Vec3 center, plain;
  for (std::uint32_t i = begin; i < end; ++i) {
    const auto& [a, b, c] = triangles_[i];
    const double w = triangle_area(a, b, c);
    weight += w;
    center += centroid(a, b, c) * w;
    plain += centroid(a, b, c);
  }
  node.center = weight > 0 ? center / weight : plain / static_cast<double>(end - begin);
  for (std::uint32_t i = begin; i < end; ++i) {
    const auto& [a, b, c] = triangles_[i];
    const Vec3 area = double_area_normal(a, b, c) * 0.5, d = centroid(a, b, c) - node.center;
    node.area += area;
    for (int k = 0; k < 3; ++k) node.moment[k] += area * d[k];
    for (const Vec3 p : {a, b, c}) node.radius = std::max(node.radius, distance(p, node.center));
  }
}

std::uint32_t WindingNumber::build(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
  expand(nodes_[node], begin, end);
  if (end - begin <= kLeafSize) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return node;
  }
  Box3 box;
  for (std::uint32_t i = begin; i < end; ++i) box.add(centroid(triangles_[i][0], triangles_[i][1], triangles_[i][2]));
  const Vec3 e = box.extent();
  const int axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
  const std::uint32_t middle = begin + (end - begin) / 2;
  const auto key = [axis](const std::array<Vec3, 3>& t) { return t[0][axis] + t[1][axis] + t[2][axis]; };
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                   [&](const auto& s, const auto& t) { return key(s) < key(t); });
  const auto left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = left;
  build(left, begin, middle);
  build(left + 1, middle, end);
  return node;
}

double WindingNumber::leaf_sum(const Node& node, Vec3 p) const {
  double sum = 0;
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    sum += solid_angle(p, triangles_[i][0], triangles_[i][1], triangles_[i][2]);
  return sum;
}

double WindingNumber::at(Vec3 p) const {
  if (nodes_.empty()) return 0;
  double sum = 0;
  std::array<std::uint32_t, kMaxDepth> stack;
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    const Vec3 r = node.center - p;
    const double far = kFarInRadii * node.radius;
    if (squared_length(r) > far * far) {
      sum += far_sum(r, node.area, node.moment);
    } else if (node.count > 0) {
      sum += leaf_sum(node, p);
    } else {
      stack[depth++] = node.first + 1;
      stack[depth++] = node.first;
    }
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace octafront
