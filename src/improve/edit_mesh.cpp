#include "improve/edit_mesh.h"

#include <octafront/error.h>

#include "improve/sorted_face.h"
#include "improve/spatial_order.h"
#include "mesh/index_range.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace octafront::improve {
namespace {

/// Faces in buckets by their least corner: whoever comes second to a pair of other corners finds the first.
class FaceMatcher {
 public:
  explicit FaceMatcher(std::vector<std::uint32_t>&& faces_of_least_corner) : next_(std::move(faces_of_least_corner)) {
    std::uint32_t at = 0;
    for (std::uint32_t& n : next_) {
      const std::uint32_t count = n;
      n = at;
      at += count;
    }
    begin_ = next_;
    entries_.resize(at);
  }

  /// The waiting partner of the face, taken out, or kNone after putting this one in.
  std::uint32_t match(const std::array<VertexIndex, 3>& face, std::uint32_t id) {
    Entry* first = entries_.data() + begin_[face[0]];
    Entry* last = entries_.data() + next_[face[0]];
    const std::uint64_t others = std::uint64_t{face[1]} << 32 | face[2];
    for (Entry* e = first; e != last; ++e)
      if (e->others == others) {
        const std::uint32_t found = e->id;
        *e = *(last - 1);
        --next_[face[0]];
        return found;
      }
    *last = {others, id};
    ++next_[face[0]];
    return kNone;
  }

  bool all_matched() const { return next_ == begin_; }

 private:
  struct Entry {
    std::uint64_t others;
    std::uint32_t id;
  };
  std::vector<std::uint32_t> begin_, next_;
  std::vector<Entry> entries_;
};

}  // namespace

EditMesh::EditMesh(TetMesh&& mesh, ImproveOptions::Objective objective) : objective_(objective) {
  require_in_range(mesh.tets.size(), kMostTetsToImprove, "tetrahedra to improve");
  take(mesh);
  rest_ = std::move(mesh);
  connect();
  compute_shapes();
  tet_mark_.assign(tets_.size(), 0);
}

void EditMesh::take(TetMesh& mesh) {
  original_ = spatial_order(mesh.points);
  std::vector<VertexIndex> new_of_old(mesh.points.size());
  points_.reserve(mesh.points.size());
  key_.reserve(mesh.points.size());
  for (VertexIndex v = 0; v < original_.size(); ++v) {
    new_of_old[original_[v]] = v;
    points_.push_back(mesh.points[original_[v]]);
    key_.push_back(v);
  }
  for (Tet& t : mesh.tets)
    for (VertexIndex& v : t) v = new_of_old[v];
  for (Triangle& t : mesh.boundary)
    for (VertexIndex& v : t) v = new_of_old[v];
  had_regions_ = !mesh.region.empty();
  tets_.reserve(mesh.tets.size());
  region_.reserve(mesh.tets.size());
  for (const TetIndex t : order_by_least_corner(mesh.tets, points_.size())) {
    tets_.push_back(mesh.tets[t]);
    region_.push_back(had_regions_ ? mesh.region[t] : 0);
  }
}

void EditMesh::connect() {
  std::vector<std::uint32_t> count(points_.size(), 0);
  for (const Tet& t : tets_)
    for (int i = 0; i < 4; ++i) ++count[sorted_face(t, i)[0]];
  for (const Triangle& t : rest_.boundary) ++count[sorted_face(t)[0]];
  FaceMatcher matcher(std::move(count));
  across_.assign(4 * tets_.size(), kNone);
  tet_of_.assign(points_.size(), kNone);
  on_boundary_.assign(points_.size(), 0);
  for (std::uint32_t b = 0; b < rest_.boundary.size(); ++b) {
    matcher.match(sorted_face(rest_.boundary[b]), kFirstBoundary + b);
    for (const VertexIndex v : rest_.boundary[b]) on_boundary_[v] = 1;
  }
  for (TetIndex t = 0; t < tets_.size(); ++t) {
    for (const VertexIndex v : tets_[t]) tet_of_[v] = t;
    for (int i = 0; i < 4; ++i) {
      const HalfFace h = 4 * t + i, other = matcher.match(sorted_face(tets_[t], i), h);
      if (other == kNone) continue;
      across_[h] = other;
      if (is_boundary(other)) continue;
      across_[other] = h;
      if (region_[t] != region_[other / 4]) part(h, other);
    }
  }
  for (HalfFace h = 0; h < across_.size(); ++h)
    if (across_[h] == kNone) {
      const auto f = sorted_face(tets_[h / 4], static_cast<int>(h % 4));
      throw MeshingError(fmt::format("face ({}, {}, {}) of tetrahedron {} is neither shared nor on the boundary", f[0],
                                     f[1], f[2], h / 4));
    }
}

void EditMesh::part(HalfFace h, HalfFace other) {
  for (const HalfFace side : {h, other}) across_[side] = kBetweenRegions;
  for (const VertexIndex v : sorted_face(tets_[h / 4], static_cast<int>(h % 4))) on_boundary_[v] = 1;
}

void EditMesh::compute_shapes() {
  shapes_.resize(tets_.size());
  ShapeBatch batch(objective_);
  TetIndex first = 0;
  const auto flush = [&] {
    batch.evaluate();
    for (int i = 0; i < batch.size; ++i) shapes_[first + i] = batch.shape(i);
    first += batch.size;
    batch.size = 0;
  };
  for (const Tet& t : tets_) {
    batch.add(points_[t[0]], points_[t[1]], points_[t[2]], points_[t[3]]);
    if (batch.full()) flush();
  }
  flush();
}

TetMesh EditMesh::release() {
  TetMesh mesh = std::move(rest_);
  // Vertices go back to where they were; those that improvement added follow.
  std::vector<VertexIndex> here(points_.size());
  for (VertexIndex v = 0; v < points_.size(); ++v) here[v < original_.size() ? original_[v] : v] = v;
  std::vector<VertexIndex> new_of_old(points_.size(), kNone);
  mesh.points.clear();
  for (const VertexIndex v : here)
    if (tet_of_[v] != kNone) {
      new_of_old[v] = static_cast<VertexIndex>(mesh.points.size());
      mesh.points.push_back(points_[v]);
    }
  std::size_t kept = 0;
  for (TetIndex t = 0; t < tets_.size(); ++t) {
    if (!alive(t)) continue;
    region_[kept] = region_[t];
    for (int i = 0; i < 4; ++i) tets_[kept][i] = new_of_old[tets_[t][i]];
    ++kept;
  }
  tets_.resize(kept);
  region_.resize(kept);
  for (Triangle& t : mesh.boundary)
    for (VertexIndex& v : t) v = new_of_old[v];
  mesh.tets = std::move(tets_);
  if (had_regions_) mesh.region = std::move(region_);
  return mesh;
}

void EditMesh::move(VertexIndex v, Vec3 to, std::span<const HalfFace> star_faces, const ShapeBatch& shapes) {
  points_[v] = to;
  for (std::size_t k = 0; k < star_faces.size(); ++k) shapes_[star_faces[k] / 4] = shapes.shape(static_cast<int>(k));
}

std::vector<VertexIndex> EditMesh::numbers_here() const {
  std::vector<VertexIndex> here(original_.size());
  for (VertexIndex v = 0; v < original_.size(); ++v) here[original_[v]] = v;
  return here;
}

void EditMesh::reserve_tets(std::size_t more) {
  const std::size_t first = tets_.size(), last = first + more;
  tets_.resize(last, {kNone, kNone, kNone, kNone});
  across_.resize(4 * last);
  shapes_.resize(last, kNoShape);
  region_.resize(last);
  tet_mark_.resize(last, 0);
  for (std::size_t t = last; t-- > first;) free_.push_back(static_cast<TetIndex>(t));
}

void EditMesh::reserve_points(std::size_t more) {
  const std::size_t first = points_.size(), last = first + more;
  points_.resize(last);
  tet_of_.resize(last, kNone);
  on_boundary_.resize(last, 0);
  key_.resize(last, 0);
  for (std::size_t v = last; v-- > first;) free_points_.push_back(static_cast<VertexIndex>(v));
}

Floor EditMesh::floor() const {
  Floor f;
  for (const Shape& s : shapes_) f.add(s);
  return f;
}

double EditMesh::beta_sum() const {
  double sum = 0;
  for (TetIndex t = 0; t < tets_.size(); ++t)
    if (alive(t)) sum += shapes_[t].beta;
  return sum;
}

}  // namespace octafront::improve
