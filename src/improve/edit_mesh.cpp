#include "improve/edit_mesh.h"

#include <octafront/error.h>

#include "improve/spatial_order.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace octafront::improve {
namespace {

std::array<VertexIndex, 3> sorted_face(const Tet& t, int i) {
  VertexIndex a = t[kTetFaces[i][0]], b = t[kTetFaces[i][1]], c = t[kTetFaces[i][2]];
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  return {a, b, c};
}

std::array<VertexIndex, 3> sorted_face(const Triangle& t) {
  return sorted_face(Tet{kNone, t[0], t[1], t[2]}, 0);
}

/// The two other corners p and q of a tet, named so that (i, j, p, q) is positive.
std::array<int, 2> other_corners(int i, int j) {
  int p = 0;
  while (p == i || p == j) ++p;
  const int q = 6 - i - j - p;
  const bool odd = ((i < j) + (i < p) + (i < q) + (j < p) + (j < q) + (p < q)) % 2 != 0;
  return odd ? std::array<int, 2>{q, p} : std::array<int, 2>{p, q};
}

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

/// Face matching among the few tets of a replace(): open addressing, sized for the largest cavity at hand.
class EditMesh::SmallFaceTable {
 public:
  explicit SmallFaceTable(std::size_t faces) {
    std::size_t size = 64;
    while (size < 2 * faces) size *= 2;
    slots_.assign(size, {{kNone, kNone, kNone}, kNone});
  }
  /// Stores the value of a face that is seen once; a face seen twice is inside and leaves nothing.
  void toggle(const std::array<VertexIndex, 3>& face, std::uint32_t value) {
    if (exchange(face, value) != kNone) exchange(face, kNone);
  }
  /// The value stored under the face, replaced by `value`; kNone if there was none.
  std::uint32_t exchange(const std::array<VertexIndex, 3>& face, std::uint32_t value) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (face[0] * 0x9E3779B1u + face[1] * 0x85EBCA77u + face[2] * 0xC2B2AE3Du) & mask;
    while (slots_[at].face[0] != kNone && slots_[at].face != face) at = (at + 1) & mask;
    const std::uint32_t old = slots_[at].value;
    slots_[at] = {face, value};
    return old;
  }

 private:
  struct Slot {
    std::array<VertexIndex, 3> face;
    std::uint32_t value;
  };
  std::vector<Slot> slots_;
};

EditMesh::EditMesh(TetMesh&& mesh) {
  if (mesh.tets.size() >= kBoundaryBit / 4) throw MeshingError("improvement holds at most 2^29 tetrahedra");
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
  for (VertexIndex v = 0; v < original_.size(); ++v) {
    new_of_old[original_[v]] = v;
    points_.push_back(mesh.points[original_[v]]);
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
    matcher.match(sorted_face(rest_.boundary[b]), kBoundaryBit | b);
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
  for (const HalfFace side : {h, other}) across_[side] = kBoundaryBit | kBetweenRegions;
  for (const VertexIndex v : sorted_face(tets_[h / 4], static_cast<int>(h % 4))) on_boundary_[v] = 1;
}

void EditMesh::compute_shapes() {
  shapes_.resize(tets_.size());
  ShapeBatch batch;
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

void EditMesh::star(VertexIndex v, std::vector<HalfFace>& faces) const {
  faces.clear();
  ++mark_;
  const TetIndex first = tet_of_[v];
  tet_mark_[first] = mark_;
  faces.push_back(4 * first + corner_of(first, v));
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const TetIndex t = faces[k] / 4;
    const int i = static_cast<int>(faces[k] % 4);
    for (int j = 1; j < 4; ++j) {
      const HalfFace o = across_[4 * t + ((i + j) & 3)];
      if (is_boundary(o) || tet_mark_[o / 4] == mark_) continue;
      tet_mark_[o / 4] = mark_;
      faces.push_back(4 * (o / 4) + corner_of(o / 4, v));
    }
  }
}

void EditMesh::edge_ring(TetIndex t, int i, int j, EdgeRing& out) const {
  out.tets.clear();
  out.ring.clear();
  out.closed = true;
  const auto [p, q] = other_corners(i, j);
  // Turning from p to q leaves each tet through the face opposite its first ring corner.
  TetIndex at = t;
  VertexIndex from = tets_[t][p], to = tets_[t][q];
  const VertexIndex start = from;
  for (;;) {
    out.tets.push_back(at);
    out.ring.push_back(from);
    if (to == start) return;
    const HalfFace o = across_[4 * at + corner_of(at, from)];
    if (is_boundary(o)) break;
    at = o / 4;
    from = to;
    to = tets_[at][o % 4];
  }
  // An open fan: what lies on the other side of t goes before it.
  out.ring.push_back(to);
  out.closed = false;
  at = t;
  from = start;
  to = tets_[t][q];
  for (;;) {
    const HalfFace o = across_[4 * at + corner_of(at, to)];
    if (is_boundary(o)) return;
    at = o / 4;
    to = from;
    from = tets_[at][o % 4];
    out.tets.insert(out.tets.begin(), at);
    out.ring.insert(out.ring.begin(), from);
  }
}

bool EditMesh::edge_ring_where_worst(TetIndex t, int i, int j, std::size_t longest, EdgeRing& out) const {
  out.tets.clear();
  out.ring.clear();
  out.closed = true;
  const auto [p, q] = other_corners(i, j);
  TetIndex at = t;
  VertexIndex from = tets_[t][p], to = tets_[t][q];
  const VertexIndex start = from;
  for (;;) {
    out.tets.push_back(at);
    out.ring.push_back(from);
    if (to == start) return true;
    if (out.tets.size() == longest) return false;
    const HalfFace o = across_[4 * at + corner_of(at, from)];
    if (is_boundary(o) || worse(o / 4, t)) return false;
    at = o / 4;
    from = to;
    to = tets_[at][o % 4];
  }
}

void EditMesh::move(VertexIndex v, Vec3 to, std::span<const HalfFace> star_faces, const ShapeBatch& shapes) {
  points_[v] = to;
  for (std::size_t k = 0; k < star_faces.size(); ++k) shapes_[star_faces[k] / 4] = shapes.shape(static_cast<int>(k));
}

void EditMesh::replace(std::span<const TetIndex> old_tets, std::span<const Tet> new_tets, std::span<const Shape> shapes,
                       std::vector<TetIndex>& created, const BoundaryTurn* turn) {
  // A face seen twice among the old tets lies inside them; what lies across the others must be tied to the new ones.
  SmallFaceTable outside(4 * (old_tets.size() + new_tets.size()));
  for (const TetIndex t : old_tets)
    for (int i = 0; i < 4; ++i) outside.toggle(sorted_face(tets_[t], i), across_[4 * t + i]);
  const std::uint32_t region = region_[old_tets[0]];
  for (const TetIndex t : old_tets)
    for (const VertexIndex v : tets_[t]) tet_of_[v] = kNone;
  if (turn) turn_boundary(*turn, outside);
  created.clear();
  for (std::size_t k = 0; k < new_tets.size(); ++k) {
    TetIndex t;
    if (k < old_tets.size()) {
      t = old_tets[k];
    } else if (!free_.empty()) {
      t = free_.back();
      free_.pop_back();
    } else {
      t = static_cast<TetIndex>(tets_.size());
      if (t >= kBoundaryBit / 4) throw MeshingError("improvement holds at most 2^29 tetrahedra");
      tets_.push_back({});
      across_.resize(across_.size() + 4);
      shapes_.push_back({});
      region_.push_back(region);
      tet_mark_.push_back(0);
    }
    tets_[t] = new_tets[k];
    shapes_[t] = shapes[k];
    region_[t] = region;
    created.push_back(t);
  }
  for (std::size_t k = new_tets.size(); k < old_tets.size(); ++k) {
    tets_[old_tets[k]] = {kNone, kNone, kNone, kNone};
    free_.push_back(old_tets[k]);
  }
  for (const TetIndex t : created) {
    for (const VertexIndex v : tets_[t]) tet_of_[v] = t;
    for (int i = 0; i < 4; ++i) {
      const HalfFace h = 4 * t + i;
      const HalfFace other = outside.exchange(sorted_face(tets_[t], i), h);
      across_[h] = other;
      if (other != kNone && !is_boundary(other)) across_[other] = h;
    }
  }
}

void EditMesh::turn_boundary(const BoundaryTurn& turn, SmallFaceTable& outside) {
  for (const HalfFace b : turn.faces) outside.exchange(sorted_face(rest_.boundary[b & ~kBoundaryBit]), kNone);
  for (int k = 0; k < 2; ++k) {
    const Triangle& corners = turn.triangles[k];
    rest_.boundary[turn.faces[k] & ~kBoundaryBit] = corners;
    // Where a tet goes without another in its place, the triangle lies on its neighbour.
    const HalfFace behind = outside.exchange(sorted_face(corners), turn.faces[k]);
    if (behind == kNone) continue;
    across_[behind] = turn.faces[k];
    for (const VertexIndex v : corners) tet_of_[v] = behind / 4;
  }
}

std::vector<VertexIndex> EditMesh::numbers_here() const {
  std::vector<VertexIndex> here(original_.size());
  for (VertexIndex v = 0; v < original_.size(); ++v) here[original_[v]] = v;
  return here;
}

VertexIndex EditMesh::add_vertex(Vec3 p) {
  points_.push_back(p);
  tet_of_.push_back(kNone);
  on_boundary_.push_back(0);
  return static_cast<VertexIndex>(points_.size() - 1);
}

Floor EditMesh::floor() const {
  Floor f;
  for (TetIndex t = 0; t < tets_.size(); ++t)
    if (alive(t)) f.add(shapes_[t]);
  return f;
}

double EditMesh::beta_sum() const {
  double sum = 0;
  for (TetIndex t = 0; t < tets_.size(); ++t)
    if (alive(t)) sum += shapes_[t].beta;
  return sum;
}

}  // namespace octafront::improve
