#include "improve/passes/mesh_editor.h"

#include "base/core/validate.h"
#include "base/geometry/predicates.h"
#include "base/mesh/face_table.h"

#include <algorithm>

namespace octafront::improve {
namespace {

constexpr std::size_t kUsualStar = 32;  ///< tets: room for them at first

}  // namespace

void MeshEditor::star(VertexIndex v, std::vector<HalfFace>& faces) {
  faces.clear();
  seen_.reset(kUsualStar);
  const TetIndex first = complex_.tet_at[v];
  seen_.insert(first);
  faces.push_back(4 * first + mesh_.corner_of(first, v));
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const TetIndex t = faces[k] / 4;
    const int i = static_cast<int>(faces[k] % 4);
    for (int j = 1; j < 4; ++j) {
      const HalfFace o = complex_.across[4 * t + ((i + j) & 3)];
      if (is_outside(o) || seen_.contains(o / 4)) continue;
      seen_.insert(o / 4);
      faces.push_back(4 * (o / 4) + mesh_.corner_of(o / 4, v));
    }
  }
}

bool MeshEditor::edge_ring_where_worst(TetIndex t, int i, int j, std::size_t longest, EdgeRing& out) {
  return complex_.turn_around(t, i, j, out, [&](TetIndex next) {
    return out.tets.size() < longest && !mesh_.worse(next, t);
  }) == TetComplex::Turn::kClosed;
}

TetIndex MeshEditor::slot() {
  if (complex_.free.empty()) mesh_.reserve_tets(1);
  const TetIndex t = complex_.free.back();
  complex_.free.pop_back();
  return t;
}

/// Whether an interface lies between two of the tets, which come together around its rim: it would go with them.
bool MeshEditor::have_both_sides(std::span<const TetIndex> tets) {
  parted_.clear();
  for (const TetIndex t : tets)
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h)
      if (complex_.across[h] == kBetweenRegions) parted_.push_back(face_key(complex_.face(h)));
  if (parted_.size() < 2) return false;
  std::sort(parted_.begin(), parted_.end());
  return std::adjacent_find(parted_.begin(), parted_.end()) != parted_.end();
}

bool MeshEditor::is_usable(const Tet& t, const Shape& shape, const Floor& floor) const {
  return floor.below(shape) && (shape.beta >= kCertainBeta || orient3d(mesh_.point(t[0]), mesh_.point(t[1]),
                                                                       mesh_.point(t[2]), mesh_.point(t[3])) > 0);
}

bool MeshEditor::replace(const Refill& refill, const BoundaryChange* change) {
  const auto& [old_tets, new_tets, shapes] = refill;
  if (have_both_sides(old_tets)) return false;
  rim_.reset(4 * (old_tets.size() + new_tets.size()));
  for (const TetIndex t : old_tets) rim_.open(complex_, t);
  const bool has_regions = mesh_.had_regions_;
  const std::uint32_t region = has_regions ? mesh_.region_[old_tets[0]] : 0;
  for (const TetIndex t : old_tets) {
    for (const VertexIndex v : complex_.tets[t]) complex_.tet_at[v] = kNone;
    if (mesh_.taken_) note_gone(t);
  }
  if (change) change_boundary(*change);
  created_.clear();
  for (std::size_t k = 0; k < new_tets.size(); ++k) {
    const TetIndex t = k < old_tets.size() ? old_tets[k] : slot();
    complex_.tets[t] = new_tets[k];
    mesh_.shapes_[t] = shapes[k];
    if (has_regions) mesh_.region_[t] = region;
    created_.push_back(t);
  }
  for (std::size_t k = new_tets.size(); k < old_tets.size(); ++k) {
    complex_.tets[old_tets[k]] = {kNone, kNone, kNone, kNone};
    mesh_.shapes_[old_tets[k]] = kNoShape;
    complex_.free.push_back(old_tets[k]);
  }
  for (const TetIndex t : created_) {
    for (const VertexIndex v : complex_.tets[t]) complex_.tet_at[v] = t;
    rim_.tie(complex_, t);
  }
  validate(mesh_, created_);
  return true;
}

bool MeshEditor::replace_by_star(std::span<const TetIndex> old_tets, std::span<const Triangle> faces,
                                 const ShapeBatch& star, Vec3 apex) {
  const VertexIndex v = add_vertex(apex);
  Refill refill;
  refill.old_tets.assign(old_tets.begin(), old_tets.end());
  for (std::size_t k = 0; k < faces.size(); ++k)
    refill.add({v, faces[k][0], faces[k][1], faces[k][2]}, star.shape(static_cast<int>(k)));
  return replace(refill);
}

void MeshEditor::note_gone(TetIndex t) {
  EditMesh::Taken& taken = *mesh_.taken_;
  const TetIndex number = std::exchange(taken.number[t], kNone);
  if (number == kNone) return;
  taken.gone.push_back(number);
}

void MeshEditor::change_boundary(const BoundaryChange& change) {
  std::vector<Triangle>& boundary = mesh_.rest_.boundary;
  for (const HalfFace b : change.gone) {
    rim_.toggle(boundary[b - kFirstOutside], kNone);
    boundary[b - kFirstOutside] = {kNone, kNone, kNone};
  }
  for (const auto& [number, corners] : change.made) {
    boundary[number - kFirstOutside] = corners;
    // Where a tet goes without another in its place, the triangle lies on its neighbour.
    const HalfFace behind = rim_.toggle(corners, number);
    if (behind == kNone) continue;
    complex_.across[behind] = number;
    for (const VertexIndex v : corners) complex_.tet_at[v] = behind / 4;
  }
}

VertexIndex MeshEditor::add_vertex(Vec3 p) {
  if (mesh_.free_points_.empty()) mesh_.reserve_points(1);
  const VertexIndex v = mesh_.free_points_.back();
  mesh_.free_points_.pop_back();
  mesh_.points_[v] = p;
  return v;
}

}  // namespace octafront::improve
