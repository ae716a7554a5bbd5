#include "improve/edit_block.h"

#include <octafront/error.h>

#include "improve/sorted_face.h"

namespace octafront::improve {
namespace {

/// The two other corners p and q of a tet, named so that (i, j, p, q) is positive.
std::array<int, 2> other_corners(int i, int j) {
  int p = 0;
  while (p == i || p == j) ++p;
  const int q = 6 - i - j - p;
  const bool odd = ((i < j) + (i < p) + (i < q) + (j < p) + (j < q) + (p < q)) % 2 != 0;
  return odd ? std::array<int, 2>{q, p} : std::array<int, 2>{p, q};
}

}  // namespace

/// Face matching among the few tets of a replace(): open addressing, sized for the largest cavity at hand.
class EditBlock::SmallFaceTable {
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

EditBlock::EditBlock(EditMesh& mesh, VertexIndex first, VertexIndex count, std::vector<TetIndex> free_tets,
                     std::vector<VertexIndex> free_points)
    : mesh_(mesh),
      first_(first),
      count_(count),
      mark_(mesh.mark_),
      free_tets_(std::move(free_tets)),
      free_points_(std::move(free_points)) {}

bool EditBlock::star(VertexIndex v, std::vector<HalfFace>& faces) {
  faces.clear();
  const std::uint32_t mark = next_mark();
  const TetIndex first = mesh_.tet_of_[v];
  if (!allowed(first)) return false;
  mesh_.tet_mark_[first] = mark;
  faces.push_back(4 * first + mesh_.corner_of(first, v));
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const TetIndex t = faces[k] / 4;
    const int i = static_cast<int>(faces[k] % 4);
    for (int j = 1; j < 4; ++j) {
      const HalfFace o = mesh_.across_[4 * t + ((i + j) & 3)];
      if (is_boundary(o) || mesh_.tet_mark_[o / 4] == mark) continue;
      if (!allowed(o / 4)) return false;
      mesh_.tet_mark_[o / 4] = mark;
      faces.push_back(4 * (o / 4) + mesh_.corner_of(o / 4, v));
    }
  }
  return true;
}

template <typename Accept>
EditBlock::Turn EditBlock::turn_around(TetIndex t, int i, int j, EdgeRing& out, const Accept& accept) const {
  out.tets.clear();
  out.ring.clear();
  out.closed = true;
  const auto [p, q] = other_corners(i, j);
  // Turning from p to q leaves each tet through the face opposite its first ring corner.
  TetIndex at = t;
  VertexIndex from = mesh_.tets_[t][p], to = mesh_.tets_[t][q];
  const VertexIndex start = from;
  for (;;) {
    out.tets.push_back(at);
    out.ring.push_back(from);
    if (to == start) return Turn::kClosed;
    const HalfFace o = mesh_.across_[4 * at + mesh_.corner_of(at, from)];
    if (is_boundary(o)) break;
    if (!accept(o / 4)) return Turn::kGivenUp;
    at = o / 4;
    from = to;
    to = mesh_.tets_[at][o % 4];
  }
  out.ring.push_back(to);
  out.closed = false;
  return Turn::kOpen;
}

bool EditBlock::edge_ring(TetIndex t, int i, int j, EdgeRing& out) {
  const Turn turn = turn_around(t, i, j, out, [&](TetIndex next) { return allowed(next); });
  if (turn != Turn::kOpen) return turn == Turn::kClosed;
  // An open fan: what lies on the other side of t goes before it.
  TetIndex at = t;
  VertexIndex from = out.ring[0], to = out.ring[1];
  for (;;) {
    const HalfFace o = mesh_.across_[4 * at + mesh_.corner_of(at, to)];
    if (is_boundary(o)) return true;
    if (!allowed(o / 4)) return false;
    at = o / 4;
    to = from;
    from = mesh_.tets_[at][o % 4];
    out.tets.insert(out.tets.begin(), at);
    out.ring.insert(out.ring.begin(), from);
  }
}

bool EditBlock::edge_ring_where_worst(TetIndex t, int i, int j, std::size_t longest, EdgeRing& out) {
  return turn_around(t, i, j, out, [&](TetIndex next) {
           return out.tets.size() < longest && allowed(next) && !mesh_.worse(next, t);
         }) == Turn::kClosed;
}

TetIndex EditBlock::slot() {
  if (whole_ && mesh_.free_.empty()) mesh_.reserve_tets(1);
  std::vector<TetIndex>& free = free_tets();
  const TetIndex t = free.back();
  free.pop_back();
  return t;
}

bool EditBlock::replace(std::span<const TetIndex> old_tets, std::span<const Tet> new_tets,
                        std::span<const Shape> shapes, std::vector<TetIndex>& created, const BoundaryTurn* turn) {
  if (new_tets.size() > old_tets.size() && !has_room(new_tets.size() - old_tets.size())) return false;
  // A face seen twice among the old tets lies inside them; what lies across the others must be tied to the new ones.
  SmallFaceTable outside(4 * (old_tets.size() + new_tets.size()));
  for (const TetIndex t : old_tets)
    for (int i = 0; i < 4; ++i) outside.toggle(sorted_face(mesh_.tets_[t], i), mesh_.across_[4 * t + i]);
  const std::uint32_t region = mesh_.region_[old_tets[0]];
  for (const TetIndex t : old_tets)
    for (const VertexIndex v : mesh_.tets_[t]) mesh_.tet_of_[v] = kNone;
  if (turn) turn_boundary(*turn, outside);
  created.clear();
  for (std::size_t k = 0; k < new_tets.size(); ++k) {
    const TetIndex t = k < old_tets.size() ? old_tets[k] : slot();
    mesh_.tets_[t] = new_tets[k];
    mesh_.shapes_[t] = shapes[k];
    mesh_.region_[t] = region;
    created.push_back(t);
  }
  for (std::size_t k = new_tets.size(); k < old_tets.size(); ++k) {
    mesh_.tets_[old_tets[k]] = {kNone, kNone, kNone, kNone};
    mesh_.shapes_[old_tets[k]] = kNoShape;
    free_tets().push_back(old_tets[k]);
  }
  for (const TetIndex t : created) {
    for (const VertexIndex v : mesh_.tets_[t]) mesh_.tet_of_[v] = t;
    for (int i = 0; i < 4; ++i) {
      const HalfFace h = 4 * t + i;
      const HalfFace other = outside.exchange(sorted_face(mesh_.tets_[t], i), h);
      mesh_.across_[h] = other;
      if (other != kNone && !is_boundary(other)) mesh_.across_[other] = h;
    }
  }
  return true;
}

void EditBlock::turn_boundary(const BoundaryTurn& turn, SmallFaceTable& outside) {
  for (const HalfFace b : turn.faces) outside.exchange(sorted_face(mesh_.rest_.boundary[b - kFirstBoundary]), kNone);
  for (int k = 0; k < 2; ++k) {
    const Triangle& corners = turn.triangles[k];
    mesh_.rest_.boundary[turn.faces[k] - kFirstBoundary] = corners;
    // Where a tet goes without another in its place, the triangle lies on its neighbour.
    const HalfFace behind = outside.exchange(sorted_face(corners), turn.faces[k]);
    if (behind == kNone) continue;
    mesh_.across_[behind] = turn.faces[k];
    for (const VertexIndex v : corners) mesh_.tet_of_[v] = behind / 4;
  }
}

VertexIndex EditBlock::add_vertex(Vec3 p, VertexIndex beside, std::size_t tets) {
  if (!has_room(tets)) return kNone;
  std::vector<VertexIndex>& free = whole_ ? mesh_.free_points_ : free_points_;
  if (whole_ && free.empty()) mesh_.reserve_points(1);
  if (free.empty()) return kNone;
  const VertexIndex v = free.back();
  free.pop_back();
  mesh_.points_[v] = p;
  mesh_.key_[v] = mesh_.key_[beside];
  return v;
}

}  // namespace octafront::improve
