// Evenly spread forces as shares of nodes: the integrals of shape functions over triangles of three and six nodes and
// quadrilaterals of four and eight, curved ones by quadrature.

#include "base/core/groups.h"
#include "formats/jobs/job_plan.h"
#include "formats/parts/mixed_cells.h"

#include <map>

namespace octafront::io {
namespace {

/// Dunavant's six points of degree 4, as two orbits.
struct Orbit {
  double at, weight;
};
constexpr std::array<Orbit, 2> kOrbits{
    {{0.445948490915965, 0.223381589678011}, {0.091576213509771, 0.109951743655322}}};

using Shape6 = std::array<double, 6>;

/// Corners, then edges 12 23 31.
Shape6 shape_of(double a, double b, double c) {
  return {a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a};
}
Shape6 slope_b(double a, double b, double c) {
  return {1 - 4 * a, 4 * b - 1, 0, 4 * (a - b), 4 * c, -4 * c};
}
Shape6 slope_c(double a, double b, double c) {
  return {1 - 4 * a, 0, 4 * c - 1, -4 * b, 4 * b, 4 * (a - c)};
}

/// A force on a face, node by node, in units of area.
class FaceShares {
 public:
  explicit FaceShares(const MeshParts& mesh) : mesh_(mesh) {}

  void add(std::span<const VertexIndex> nodes) {
    if (nodes.size() == 6) return add_curved(nodes);
    const bool is_quad = nodes.size() % 4 == 0;
    const double area = is_quad ? flat(nodes[0], nodes[1], nodes[2]) + flat(nodes[0], nodes[2], nodes[3])
                                : flat(nodes[0], nodes[1], nodes[2]);
    // Of eight nodes on a parallelogram.
    constexpr double kCornerOf8 = -1.0 / 12, kMidOf8 = 1.0 / 3;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      at_[nodes[k]] +=
          area * (nodes.size() == 8 ? (k < 4 ? kCornerOf8 : kMidOf8) : 1.0 / static_cast<double>(nodes.size()));
    area_ += area;
  }

  double area() const { return area_; }
  NodeShares all() const {
    constexpr double kRounding = 1e-12;  // corners of straight triangles of second order have none
    NodeShares shares;
    for (const auto& [node, share] : at_)
      if (std::abs(share) > kRounding * area_) shares.emplace_back(node, share / area_);
    return shares;
  }

 private:
  Vec3 point(VertexIndex v) const { return mesh_.mesh().points[v]; }
  double flat(VertexIndex a, VertexIndex b, VertexIndex c) const {
    return 0.5 * length(cross(point(b) - point(a), point(c) - point(a)));
  }
  Vec3 sum(std::span<const VertexIndex> nodes, const Shape6& weights) const {
    Vec3 total{};
    for (std::size_t k = 0; k < nodes.size(); ++k) total += point(nodes[k]) * weights[k];
    return total;
  }
  void add_at(std::span<const VertexIndex> nodes, double weight, double a, double b, double c) {
    const double area = 0.5 * weight * length(cross(sum(nodes, slope_b(a, b, c)), sum(nodes, slope_c(a, b, c))));
    const Shape6 shape = shape_of(a, b, c);
    for (std::size_t k = 0; k < nodes.size(); ++k) at_[nodes[k]] += area * shape[k];
    area_ += area;
  }
  void add_curved(std::span<const VertexIndex> nodes) {
    for (const auto& [at, weight] : kOrbits) {
      add_at(nodes, weight, 1 - 2 * at, at, at);
      add_at(nodes, weight, at, 1 - 2 * at, at);
      add_at(nodes, weight, at, at, 1 - 2 * at);
    }
  }

  const MeshParts& mesh_;
  std::map<VertexIndex, double> at_;
  double area_ = 0;
};

FaceShares shares_on(const MeshParts& mesh, const Part& part) {
  const MixedCells cells(mesh);
  FaceShares shares(mesh);
  FaceRoom room;
  for (const std::uint32_t f : cells.members(part)) shares.add(cells.face_nodes(f, room));
  return shares;
}

}  // namespace

NodeShares shares_of(const MeshParts& mesh, const Part& part) {
  return shares_on(mesh, part).all();
}

double area_of(const MeshParts& mesh, const Part& part) {
  return shares_on(mesh, part).area();
}

}  // namespace octafront::io
