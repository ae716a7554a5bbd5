#include "improve/passes/vertex_blocks.h"

#include "base/geometry/spatial_order.h"

#include <bit>

namespace octafront::improve {

namespace {

constexpr std::size_t kLeastVertexBlock = 4096;  ///< vertices: below this most of a block is its rim
constexpr std::size_t kMostVertexBlocks = 256;

/// A cube twice as large as that of the numbering, a third of it lower: its halves, quarters and so on, at any depth,
/// never lie on one plane with those of the numbering's.
std::vector<VertexIndex> order_in_shifted_cells(const EditMesh& mesh, const std::vector<VertexIndex>& vertices) {
  Box3 box;
  for (VertexIndex v = 0; v < mesh.vertices(); ++v) box.add(mesh.point(v));
  const Vec3 extent = box.extent();
  const double side = std::max({extent.x, extent.y, extent.z}), lower = side * 2 / 3;
  std::vector<Vec3> points(vertices.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = mesh.point(vertices[i]);
  return spatial_order(points, {box.lo - Vec3{lower, lower, lower}, 2 * side});
}

}  // namespace

int VertexBlocks::bits_of_stretch(std::size_t vertices) {
  return std::countr_zero(std::max(kLeastVertexBlock, std::bit_ceil(vertices / kMostVertexBlocks + 1)));
}

VertexBlocks::VertexBlocks(const EditMesh& mesh, const BoundaryGuide* guide, std::vector<std::uint8_t> marks) {
  const auto n = static_cast<VertexIndex>(mesh.vertices());
  const int bits = bits_of_stretch(n);
  std::vector<std::vector<VertexIndex>> blocks((n >> bits) + 1);
  std::vector<VertexIndex> waiting;
  for (VertexIndex v = 0; v < n; ++v) {
    if (mesh.on_boundary(v) && !(guide && guide->may_slide(v))) marks[v] &= ~kWorked;
    if (marks[v] & kWorked) (marks[v] & kAtRim ? waiting : blocks[v >> bits]).push_back(v);
  }
  stages_.push_back(std::move(blocks));
  stars_ = group_by_owner(n, static_cast<HalfFace>(4 * mesh.slots()), [&](HalfFace h) {
    const VertexIndex v = mesh.tet(h / 4)[h % 4];
    return mesh.alive(h / 4) && (marks[v] & kWorked) ? v : kNoOwner;
  });
  if (stages_[0].size() > 1) waiting = divide_shifted(mesh, waiting);
  stages_.push_back({std::move(waiting)});
}

std::vector<VertexIndex> VertexBlocks::divide_shifted(const EditMesh& mesh, const std::vector<VertexIndex>& waiting) {
  const std::vector<VertexIndex> order = order_in_shifted_cells(mesh, waiting);
  const int bits = bits_of_stretch(waiting.size());
  std::vector<std::uint32_t> block_of(mesh.vertices(), kNone);
  for (std::size_t i = 0; i < order.size(); ++i) block_of[waiting[order[i]]] = static_cast<std::uint32_t>(i >> bits);
  std::vector<std::uint8_t> at_rim(order.size());
  parallel_for(order.size(), [&](std::size_t i) {
    const std::uint32_t own = block_of[waiting[order[i]]];
    at_rim[i] = std::ranges::any_of(star(waiting[order[i]]), [&](HalfFace h) {
      return std::ranges::any_of(mesh.tet(h / 4),
                                 [&](VertexIndex u) { return block_of[u] != own && block_of[u] != kNone; });
    });
  });
  std::vector<std::vector<VertexIndex>> blocks((order.size() >> bits) + 1);
  std::vector<VertexIndex> left;
  for (std::size_t i = 0; i < order.size(); ++i) (at_rim[i] ? left : blocks[i >> bits]).push_back(waiting[order[i]]);
  stages_.push_back(std::move(blocks));
  return left;
}

}  // namespace octafront::improve
