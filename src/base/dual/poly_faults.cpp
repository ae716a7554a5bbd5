#include "base/dual/poly_faults.h"

#include "base/core/parallel.h"
#include "base/dual/poly_measures.h"

#include <algorithm>

namespace octafront::dual {
namespace {

constexpr std::size_t kCellsAtOnce = 2048;
/// The cosine of 65 degrees: OpenFOAM calls faces severely non-orthogonal from 70 on.
constexpr double kLeastCosine = 0.4226182617406994;

class FaultFinder {
 public:
  explicit FaultFinder(const PolyMesh& mesh) : mesh_(mesh), faces_(faces_of_cells(mesh)), middles_(mesh.cells()) {
    parallel_for(mesh.cells(),
                 [&](std::size_t c) { middles_[c] = middle_of_cell(mesh, static_cast<std::uint32_t>(c), faces_[c]); });
  }

  bool is_unsound(std::uint32_t c) const {
    return !is_closed(mesh_, c, faces_[c]) || !(volume_of(mesh_, c, faces_[c]) > 0);
  }
  bool is_turned(std::uint32_t c) const {
    return std::ranges::any_of(faces_[c], [&](std::uint32_t f) { return is_turned_face(f); });
  }
  bool is_askew(std::uint32_t c) const {
    return std::ranges::any_of(faces_[c], [&](std::uint32_t f) { return is_askew_face(f); });
  }

 private:
  bool is_turned_face(std::size_t f) const {
    const FaceMeasure face = measure(mesh_, f);
    return dot(face.area, face.middle - middles_[mesh_.owner[f]]) <= 0 ||
           (f < mesh_.inner_faces() && dot(face.area, middles_[mesh_.neighbour[f]] - face.middle) <= 0);
  }
  bool is_askew_face(std::size_t f) const {
    if (f >= mesh_.inner_faces()) return false;
    const Vec3 across = middles_[mesh_.neighbour[f]] - middles_[mesh_.owner[f]];
    return dot(normalized(measure(mesh_, f).area), normalized(across)) < kLeastCosine;
  }

  const PolyMesh& mesh_;
  Groups<> faces_;
  std::vector<Vec3> middles_;
};

}  // namespace

PolyFaults faults_of(const PolyMesh& mesh) {
  const FaultFinder finder(mesh);
  const auto those = [&](const auto& test) { return parallel_select(mesh.cells(), test, kCellsAtOnce); };
  PolyFaults faults;
  const std::vector<std::uint32_t> unsound = those([&](std::uint32_t c) { return finder.is_unsound(c); });
  const std::vector<std::uint32_t> turned = those([&](std::uint32_t c) { return finder.is_turned(c); });
  faults.unsound = unsound.size(), faults.turned = turned.size();
  faults.cells = those([&](std::uint32_t c) {
    return std::ranges::binary_search(unsound, c) || std::ranges::binary_search(turned, c) || finder.is_askew(c);
  });
  return faults;
}

}  // namespace octafront::dual
