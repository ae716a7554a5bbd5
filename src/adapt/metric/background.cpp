#include "adapt/metric/background.h"

#include <octafront/error.h>

#include "base/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace octafront::adapt {
namespace {

/// Lengths of more diagonals are no wish, and rounding would make nonsense of them.
constexpr double kLongestOfDiagonal = 1e12;

/// A size for each metric, that of the same density: MeshSizes finds places for sizes.
std::shared_ptr<const SizeMesh> as_sizes(const MetricMesh& mesh) {
  const std::string name = mesh.name.empty() ? "the metric" : mesh.name;
  require_metrics(mesh.metrics, mesh.points.size(), mesh.points, name);
  const auto in_range = [&](const auto& element) {
    return std::all_of(element.begin(), element.end(), [&](VertexIndex v) { return v < mesh.points.size(); });
  };
  if (mesh.tets.empty() && mesh.triangles.empty())
    throw InputError(name + ": has no tetrahedra or triangles: there is nothing that it could be linear in");
  if (!std::all_of(mesh.tets.begin(), mesh.tets.end(), in_range) ||
      !std::all_of(mesh.triangles.begin(), mesh.triangles.end(), in_range))
    throw InputError(
        fmt::format("{}: an element has a corner that is none of the {} points", name, mesh.points.size()));
  if (!std::all_of(mesh.points.begin(), mesh.points.end(), is_finite))
    throw InputError(name + ": a point is no place: its coordinates are not finite");
  SizeMesh sizes{mesh.points, mesh.tets, mesh.tets.empty() ? mesh.triangles : std::vector<Triangle>{}, {}, {}, name};
  for (const Metric& m : mesh.metrics) sizes.point_sizes.push_back(1 / std::sqrt(std::max({m.xx, m.yy, m.zz})));
  return std::make_shared<const SizeMesh>(std::move(sizes));
}

enum class Fault { kNone, kNotPositive, kOutOfRange };

/// `diagonal`: of the mesh.
Fault fault_of(const Metric& m, double diagonal) {
  // Tensors of any magnitude are positive definite or not.
  const double largest = std::max({m.xx, m.yy, m.zz});
  if (!(largest > 0) || !is_metric((1 / largest) * m)) return Fault::kNotPositive;
  if (!is_metric(m)) return Fault::kOutOfRange;
  const auto values = eigen(m).value;
  const double longest = kLongestOfDiagonal * diagonal;
  return *std::min_element(values.begin(), values.end()) < 1 / (longest * longest) ? Fault::kOutOfRange : Fault::kNone;
}

/// Throws where some are, with the first of them.
template <class IsSo>
void refuse_those(std::span<const Metric> metrics, std::span<const Vec3> points, const std::string& what,
                  const char* words, const IsSo& is_so) {
  constexpr std::uint64_t kTold = 3;
  std::uint64_t wrong = 0;
  std::string places;
  for (std::size_t v = 0; v < metrics.size(); ++v) {
    if (!is_so(metrics[v]) || ++wrong > kTold) continue;
    const Metric& m = metrics[v];
    places += fmt::format("{}point {}", places.empty() ? "" : "; ", v);
    if (v < points.size()) places += fmt::format(" ({:.6g}, {:.6g}, {:.6g})", points[v].x, points[v].y, points[v].z);
    places += fmt::format(" has xx {:.6g} xy {:.6g} xz {:.6g} yy {:.6g} yz {:.6g} zz {:.6g}", m.xx, m.xy, m.xz, m.yy,
                          m.yz, m.zz);
  }
  if (wrong > 0)
    throw InputError(fmt::format("{}: {} of {} tensors {} {}: {}{}", what, wrong, metrics.size(),
                                 wrong == 1 ? "is" : "are", words, places, wrong > kTold ? "; ..." : ""));
}

bool is_round(const Metric& m) {
  return m.xy == 0 && m.xz == 0 && m.yz == 0 && m.xx == m.yy && m.yy == m.zz;
}

}  // namespace

void require_metrics(std::span<const Metric> metrics, std::size_t count, std::span<const Vec3> points,
                     const std::string& what) {
  if (metrics.size() != count)
    throw InputError(fmt::format("{}: {} tensors, but the mesh has {} points", what, metrics.size(), count));
  Box3 box;
  for (const Vec3 p : points) box.add(p);
  const double diagonal = points.empty() ? HUGE_VAL : box.diagonal();
  for (const auto& [fault, words] : {std::pair{Fault::kNotPositive, "not positive definite"},
                                     std::pair{Fault::kOutOfRange, "out of range: lengths that no mesh has"}})
    refuse_those(metrics, points, what, words,
                 [&, wanted = fault](const Metric& m) { return fault_of(m, diagonal) == wanted; });
}

BackgroundMetric::BackgroundMetric(const MetricMesh& mesh)
    : mesh_(as_sizes(mesh)), places_(mesh_), logarithms_(mesh.metrics.size()) {
  parallel_for(logarithms_.size(), [&](std::size_t v) { logarithms_[v] = log_of(mesh.metrics[v]); });
  is_isotropic_ = std::all_of(mesh.metrics.begin(), mesh.metrics.end(), is_round);
}

Metric BackgroundMetric::at(Vec3 p, std::uint32_t&) const {
  const MeshSizes::Place place = places_.place(p);
  Metric log{0, 0, 0, 0, 0, 0};
  for (std::size_t k = 0; k < 4; ++k)
    if (place.weights[k] > 0) log = log + place.weights[k] * logarithms_[place.corners[k]];
  return exp_of(log);
}

}  // namespace octafront::adapt
