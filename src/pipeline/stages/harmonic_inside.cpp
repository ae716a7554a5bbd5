#include "base/core/conjugate_gradients.h"
#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "pipeline/stages/moving.h"

#include <algorithm>
#include <array>

namespace octafront {
namespace {

/// Far below what a motion is known by.
constexpr SolverLimits kExactEnough{5000, 1e-24};

/// The matrix of Laplace's equation in linear elements, its rows put together element by element, always in one order.
class Stiffness {
 public:
  explicit Stiffness(const TetMesh& mesh)
      : mesh_(mesh),
        of_tets_(mesh.tets.size()),
        around_(mesh.points.size(),
                [&](const auto& add) {
                  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
                    for (const VertexIndex v : mesh.tets[t]) add(v, t);
                }),
        is_inside_(mesh.points.size(), 1) {
    for (const Triangle& face : mesh.boundary)
      for (const VertexIndex v : face) is_inside_[v] = 0;
    parallel_for(of_tets_.size(), [&](std::size_t t) { of_tets_[t] = of_tet(static_cast<TetIndex>(t)); });
  }

  bool is_inside(std::size_t v) const { return is_inside_[v] != 0; }

  /// 0 at the boundary.
  std::vector<double> times(const std::vector<double>& x) const {
    return rows([&](const Row& row, const Tet& tet) {
      double sum = 0;
      for (std::size_t j = 0; j < 4; ++j) sum += row[j] * x[tet[j]];
      return sum;
    });
  }
  std::vector<double> diagonal() const {
    return rows([](const Row& row, const Tet&) { return row[4]; });
  }

 private:
  /// Of a corner of a tet its products with the four corners, and with itself.
  using Row = std::array<double, 5>;

  /// V grad i . grad j of the four corners.
  std::array<std::array<double, 4>, 4> of_tet(TetIndex t) const {
    const auto& [a, b, c, d] = mesh_.tets[t];
    const auto& p = mesh_.points;
    // Inward, twice the areas: 6 V grad.
    const std::array<Vec3, 4> normals{
        -1.0 * double_area_normal(p[b], p[c], p[d]), -1.0 * double_area_normal(p[a], p[d], p[c]),
        -1.0 * double_area_normal(p[a], p[b], p[d]), -1.0 * double_area_normal(p[a], p[c], p[b])};
    const double scale = 1 / (36 * signed_volume(p[a], p[b], p[c], p[d]));
    std::array<std::array<double, 4>, 4> products{};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) products[i][j] = scale * dot(normals[i], normals[j]);
    return products;
  }

  template <class Part>
  std::vector<double> rows(const Part& part) const {
    std::vector<double> sums(around_.size(), 0);
    parallel_for(sums.size(), [&](std::size_t v) {
      if (!is_inside(v)) return;
      for (const TetIndex t : around_[v]) {
        const Tet& tet = mesh_.tets[t];
        const auto i = static_cast<std::size_t>(std::find(tet.begin(), tet.end(), v) - tet.begin());
        const auto& products = of_tets_[t][i];
        sums[v] += part({products[0], products[1], products[2], products[3], products[i]}, tet);
      }
    });
    return sums;
  }

  const TetMesh& mesh_;
  std::vector<std::array<std::array<double, 4>, 4>> of_tets_;
  Groups<> around_;
  std::vector<std::uint8_t> is_inside_;
};

}  // namespace

std::vector<Vec3> harmonic_inside(const TetMesh& mesh, std::vector<Vec3> values, const RunContext& context) {
  const Stiffness matrix(mesh);
  const std::vector<double> diagonal = matrix.diagonal();
  for (const auto component : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    context.check();
    std::vector<double> at_boundary(values.size(), 0);
    for (std::size_t v = 0; v < values.size(); ++v)
      if (!matrix.is_inside(v)) at_boundary[v] = values[v].*component;
    std::vector<double> missing = matrix.times(at_boundary);
    for (double& m : missing) m = -m;
    const std::vector<double> inside = solved_by_conjugate_gradients(
        diagonal, std::move(missing), [&](const std::vector<double>& x) { return matrix.times(x); }, kExactEnough);
    for (std::size_t v = 0; v < values.size(); ++v)
      if (matrix.is_inside(v)) values[v].*component = inside[v];
  }
  return values;
}

}  // namespace octafront
