#include "improve/shuffle.h"

#include <numeric>
#include <utility>

namespace octafront::improve {

template <class Item>
void EditMeshShuffle::shuffle(std::vector<Item>& items) {
  for (std::size_t k = items.size(); k > 1; --k) std::swap(items[k - 1], items[random_.below(k)]);
}

void EditMeshShuffle::operator()(EditMesh& mesh) {
  TetComplex& complex = mesh.complex_;
  std::vector<TetIndex> to(complex.tets.size());
  std::iota(to.begin(), to.end(), TetIndex{0});
  shuffle(to);
  const TetComplex was = complex;
  const std::vector<Shape> shapes = mesh.shapes_;
  const std::vector<std::uint32_t> region = mesh.region_;
  const std::vector<std::uint8_t> is_there = mesh.taken_ ? mesh.taken_->is_there : std::vector<std::uint8_t>{};
  for (TetIndex t = 0; t < to.size(); ++t) {
    complex.tets[to[t]] = was.tets[t];
    mesh.shapes_[to[t]] = shapes[t];
    if (!region.empty()) mesh.region_[to[t]] = region[t];
    if (mesh.taken_) mesh.taken_->is_there[to[t]] = is_there[t];
    for (HalfFace i = 0; i < 4; ++i) {
      const HalfFace o = was.across[4 * t + i];
      complex.across[4 * to[t] + i] = is_outside(o) ? o : 4 * to[o / 4] + o % 4;
    }
  }
  for (TetIndex& t : complex.free) t = to[t];
  shuffle(complex.free);
  shuffle(mesh.free_points_);
  std::vector<TetIndex> order(to);
  shuffle(order);
  for (const TetIndex t : order)
    if (complex.alive(t))
      for (const VertexIndex v : complex.tets[t]) complex.tet_at[v] = t;
}

}  // namespace octafront::improve
