#include "improve/pieces/pieces.h"

#include "base/comm/shares.h"
#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/core/shared_value.h"
#include "base/core/stage_timer.h"
#include "base/geometry/self_intersection.h"
#include "base/geometry/spatial_order.h"
#include "base/mesh/index_range.h"
#include "base/mesh/tet_key.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

namespace octafront::improve {

namespace {

/// Numbers from here on are of vertices that a piece made.
constexpr VertexIndex kNewVertex = 1u << 31;

bool is_there(const Tet& t) {
  return t[0] != kNone;
}

template <class Corners>
bool touches(const Corners& corners, const std::vector<std::uint8_t>& marks) {
  return std::ranges::any_of(corners, [&](VertexIndex v) { return marks[v] != 0; });
}

template <class Corners>
void mark_all(const Corners& corners, std::vector<std::uint8_t>& marks) {
  for (const VertexIndex v : corners)
    if (const SharedValue<std::uint8_t> mark(marks[v]); mark.load() == 0) mark.store(1);
}

/// What a cell holds, by cell.
template <class Item>
Buckets<> by_cell(const std::vector<Item>& items, const Cells& cells) {
  return Buckets<>(items.size(), cells.count, [&](std::size_t i, const auto& add) {
    if (items[i][0] == kNone) return;
    if (const std::uint32_t cell = cells.holding(items[i]); cell < cells.count)
      add(cell, static_cast<std::uint32_t>(i));
  });
}

}  // namespace

/// The pieces of a stage. Cells are of all vertices, kNoOwner of those with no element in any piece.
struct MeshOfPieces::Division {
  Cells cells;
  std::vector<std::uint8_t> at_rim;  ///< per vertex: has elements in no piece
  Buckets<> tets, triangles, interfaces, edges, vertices;
};

/// What was done to a piece, in the numbers of the whole; vertices that it made are kNewVertex + their place in
/// `added`.
struct MeshOfPieces::Change {
  std::vector<EditMesh::Moved> moved;
  std::vector<Vec3> added;
  std::vector<TetIndex> gone;
  std::vector<Tet> made;
  std::vector<std::uint32_t> region_of_made;
  std::vector<EditMesh::ChangedTriangle> boundary;
  std::vector<Edge> edges_gone, edges_made;
  Bytes notes;

  /// visit(list) for each.
  template <class Self, class Visit>
  static void for_each_list(Self& self, const Visit& visit) {
    visit(self.moved), visit(self.added), visit(self.gone), visit(self.made), visit(self.region_of_made);
    visit(self.boundary), visit(self.edges_gone), visit(self.edges_made), visit(self.notes);
  }
};

MeshOfPieces::MeshOfPieces(TetMesh&& mesh, ImproveOptions::Objective objective, const BoundaryInput* input,
                           const Comm& comm, std::size_t most)
    : objective_(objective), input_(input), comm_(comm), most_(most) {
  require_in_range(mesh.tets.size(), kMostTetsToImprove, "tetrahedra to improve");
  points_ = std::exchange(mesh.points, {});
  tets_ = std::exchange(mesh.tets, {});
  region_ = std::exchange(mesh.region, {});
  rest_ = std::move(mesh);
  live_ = tets_.size();
  for (const Vec3& p : points_) box_.add(p);
  if (!input) return;
  edges_ = input->of_mesh.edges;
  pinned_.assign(points_.size(), 0), frozen_ = is_corner_ = pinned_;
  for (const VertexIndex v : input->of_mesh.corners) is_corner_[v] = 1;
  for (const VertexIndex v : input->pinned) pinned_[v] = 1;
  for (const VertexIndex v : input->frozen) frozen_[v] = 1;
  home_ = points_;
  origin_ = {rest_, edges_, std::vector<std::uint8_t>(tets_.size(), 1), {}, {}};
}

void MeshOfPieces::freeze(std::span<const VertexIndex> vertices) {
  for (const VertexIndex v : vertices) frozen_[v] = 1;
}

void MeshOfPieces::work(std::vector<std::uint8_t> waiting, int rings, const Work& work, const Notes& notes,
                        const Progress& progress) {
  std::vector<TetIndex> around;  // those that wait; all of them at first
  for (int stage = 0; stage <= kCellStages; ++stage) {
    if (std::ranges::find(waiting, 1) == waiting.end()) return;
    if (before_stage_) before_stage_(*this), around.clear();
    const std::size_t slots = tets_.size();
    const bool all = stage == 0 && std::ranges::find(waiting, 0) == waiting.end();
    const std::vector<std::uint8_t> near = all ? waiting : spread(waiting, rings, around);
    around = touching(near, around);
    const Division division = divide(near, around, stage);
    std::vector<Change> changes = work_on(division, work, progress);
    apply(changes);
    std::vector<Bytes> of_pieces;
    for (Change& change : changes) of_pieces.push_back(std::move(change.notes));
    notes(of_pieces);
    for (std::size_t t = slots; t < tets_.size(); ++t) around.push_back(static_cast<TetIndex>(t));
    parallel_for(waiting.size(), [&](std::size_t v) { waiting[v] &= division.at_rim[v]; });
    waiting.resize(points_.size(), 0);
  }
}

void MeshOfPieces::work_on_one(const std::vector<std::uint8_t>& waiting, int rings,
                               FunctionRef<void(MeshPiece&)> work) {
  const std::vector<std::uint8_t> near = spread(waiting, rings, {});
  const Division division = divide(near, touching(near, {}), kCellStages);
  number_in_piece_.assign(points_.size(), kNone);
  MeshPiece piece = extract(division, 0);
  const std::vector<Edge> edges = piece.features.edges;
  work(piece);
  std::vector<Change> changes{change_of(piece, division.tets[0], edges)};
  apply(changes);
}

/// Of some elements, or all if none are given, those that touch a vertex that is marked.
std::vector<TetIndex> MeshOfPieces::touching(const std::vector<std::uint8_t>& marks,
                                             std::span<const TetIndex> among) const {
  constexpr std::size_t kRange = 16384;
  return parallel_collect<TetIndex>(among.empty() ? tets_.size() : among.size(), kRange,
                                    [&](std::size_t begin, std::size_t end, std::vector<TetIndex>& found) {
                                      for (std::size_t i = begin; i < end; ++i) {
                                        const auto t = among.empty() ? static_cast<TetIndex>(i) : among[i];
                                        if (is_there(tets_[t]) && touches(tets_[t], marks)) found.push_back(t);
                                      }
                                    });
}

/// The marks, and those of so many rings of vertices around.
std::vector<std::uint8_t> MeshOfPieces::spread(std::vector<std::uint8_t> marks, int rings,
                                               std::span<const TetIndex> among) const {
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<std::uint8_t> wider = marks;
    parallel_for(among.empty() ? tets_.size() : among.size(), [&](std::size_t i) {
      const Tet& t = tets_[among.empty() ? i : among[i]];
      if (is_there(t) && touches(t, marks)) mark_all(t, wider);
    });
    marks = std::move(wider);
  }
  return marks;
}

/// Pieces of `tets`, all those around the vertices that are near.
MeshOfPieces::Division MeshOfPieces::divide(const std::vector<std::uint8_t>& near, std::span<const TetIndex> tets,
                                            int stage) const {
  std::vector<std::uint8_t> is_held(points_.size(), 0);
  parallel_for(tets.size(), [&](std::size_t i) { mark_all(tets_[tets[i]], is_held); });
  std::vector<VertexIndex> held;
  std::vector<Vec3> places;
  for (VertexIndex v = 0; v < points_.size(); ++v) {
    if (is_held[v] == 0) continue;
    held.push_back(v);
    places.push_back(points_[v]);
  }
  const Cells of_held = stage < kCellStages ? cells_of(places, cube_of_stage(box_, stage), most_)
                                            : Cells{std::vector<std::uint32_t>(held.size(), 0), 1};
  Cells cells{std::vector<std::uint32_t>(points_.size(), kNoOwner), of_held.count};
  // A vertex that is not near has elements that are not among these.
  std::vector<std::uint8_t> at_rim(points_.size(), 0);
  parallel_for(held.size(), [&](std::size_t k) {
    cells.of[held[k]] = of_held.of[k];
    at_rim[held[k]] = near[held[k]] == 0;
  });
  parallel_for(tets.size(), [&](std::size_t i) {
    if (cells.holding(tets_[tets[i]]) == kNoOwner) mark_all(tets_[tets[i]], at_rim);
  });
  Buckets<> of_cell(tets.size(), cells.count, [&](std::size_t i, const auto& add) {
    if (const std::uint32_t cell = cells.holding(tets_[tets[i]]); cell != kNoOwner) add(cell, tets[i]);
  });
  Buckets<> vertices(held.size(), cells.count, [&](std::size_t k, const auto& add) { add(of_held.of[k], held[k]); });
  Buckets<> triangles = by_cell(rest_.boundary, cells), interfaces = by_cell(rest_.interfaces, cells),
            edges = by_cell(edges_, cells);
  return {std::move(cells),      std::move(at_rim), std::move(of_cell), std::move(triangles),
          std::move(interfaces), std::move(edges),  std::move(vertices)};
}

/// What this rank's threads do to its share of the pieces, and what others do to theirs.
std::vector<MeshOfPieces::Change> MeshOfPieces::work_on(const Division& division, const Work& work,
                                                        const Progress& progress) {
  number_in_piece_.assign(points_.size(), kNone);
  std::vector<Change> changes(division.cells.count);
  std::vector<std::uint64_t> sizes;
  for (std::size_t c = 0; c < changes.size(); ++c) sizes.push_back(1 + division.tets[c].size());
  const Shares shares(sizes, comm_.size());
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<std::size_t> done{0};
  const double start = process_cpu_seconds();
  do_share(comm_, shares, "improve", [&](std::size_t c) {
    if (division.tets[c].empty()) return;
    MeshPiece piece = extract(division, static_cast<std::uint32_t>(c));
    const std::vector<Edge> edges = piece.features.edges;
    Bytes notes = work(piece);
    changes[c] = change_of(piece, division.tets[c], edges);
    changes[c].notes = std::move(notes);
    const double part = static_cast<double>(++done) * comm_.size() / static_cast<double>(changes.size());
    if (std::this_thread::get_id() == caller) progress(std::min(part, 1.0));
  });
  piece_seconds_ += process_cpu_seconds() - start;
  gather_results(
      comm_, shares, "improve", changes,
      [](const Change& change, Packer& to) { Change::for_each_list(change, [&](const auto& list) { to.add(list); }); },
      [](Change& change, Unpacker& from) { Change::for_each_list(change, [&](auto& list) { from.take(list); }); });
  return changes;
}

MeshPiece MeshOfPieces::extract(const Division& division, std::uint32_t cell) {
  MeshPiece piece;
  TetMesh part;
  // Each vertex is of one cell: nobody else writes its number.
  for (const TetIndex t : division.tets[cell])
    for (const VertexIndex v : tets_[t]) number_in_piece_[v] = 0;
  for (const VertexIndex v : division.vertices[cell]) {
    if (number_in_piece_[v] == kNone) continue;
    const auto here = static_cast<VertexIndex>(piece.vertices.size());
    number_in_piece_[v] = here;
    piece.vertices.push_back(v);
    part.points.push_back(points_[v]);
    if (division.at_rim[v] != 0) piece.at_rim.push_back(here);
    if (v < pinned_.size() && pinned_[v] != 0) piece.pinned.push_back(here);
    if (v < frozen_.size() && frozen_[v] != 0) piece.frozen.push_back(here);
    if (v < is_corner_.size() && is_corner_[v] != 0) piece.features.corners.push_back(here);
  }
  const auto numbered = [&](auto corners) {
    for (VertexIndex& v : corners) v = number_in_piece_[v];
    return corners;
  };
  const auto is_in = [&](const auto& corners) {
    return std::ranges::none_of(corners, [&](VertexIndex v) { return number_in_piece_[v] == kNone; });
  };
  for (const TetIndex t : division.tets[cell]) {
    part.tets.push_back(numbered(tets_[t]));
    if (!region_.empty()) part.region.push_back(region_[t]);
  }
  for (const std::uint32_t t : division.triangles[cell]) {
    if (!is_in(rest_.boundary[t])) continue;
    piece.boundary.push_back(t);
    part.boundary.push_back(numbered(rest_.boundary[t]));
    if (!rest_.patch.empty()) part.patch.push_back(rest_.patch[t]);
  }
  for (const std::uint32_t t : division.interfaces[cell])
    if (is_in(rest_.interfaces[t])) part.interfaces.push_back(numbered(rest_.interfaces[t]));
  for (const std::uint32_t e : division.edges[cell])
    if (is_in(edges_[e])) piece.features.edges.push_back(numbered(edges_[e]));
  for (const VertexIndex v : piece.vertices) number_in_piece_[v] = kNone;
  piece.mesh.emplace(std::move(part), objective_, EditMesh::Rim::kHeld);
  piece.mesh->remember();
  return piece;
}

MeshOfPieces::Change MeshOfPieces::change_of(const MeshPiece& piece, std::span<const TetIndex> tets,
                                             const std::vector<Edge>& edges) const {
  EditMesh::Change of_piece = piece.mesh->change();
  const auto count = static_cast<VertexIndex>(piece.vertices.size());
  const auto in_whole = [&](auto corners) {
    for (VertexIndex& v : corners)
      if (v != kNone) v = v < count ? piece.vertices[v] : kNewVertex + (v - count);
    return corners;
  };
  Change change;
  for (const auto& [v, at] : of_piece.moved) change.moved.push_back({piece.vertices[v], at});
  change.added = std::move(of_piece.added);
  for (const TetIndex t : of_piece.gone) change.gone.push_back(tets[t]);
  std::sort(change.gone.begin(), change.gone.end());
  for (const Tet& t : of_piece.made) change.made.push_back(in_whole(t));
  change.region_of_made = std::move(of_piece.region_of_made);
  for (const auto& [number, corners] : of_piece.boundary)
    change.boundary.push_back({piece.boundary[number], in_whole(corners)});
  if (piece.features.edges == edges) return change;
  for (const Edge& e : edges) change.edges_gone.push_back(in_whole(e));
  for (const Edge& e : piece.features.edges) change.edges_made.push_back(in_whole(e));
  return change;
}

void MeshOfPieces::apply(std::vector<Change>& changes) {
  for (Change& change : changes) {
    const auto first_new = static_cast<VertexIndex>(points_.size());
    points_.insert(points_.end(), change.added.begin(), change.added.end());
    for (Tet& t : change.made)
      for (VertexIndex& v : t)
        if (v >= kNewVertex) v = first_new + (v - kNewVertex);
    for (const auto& [v, at] : change.moved) points_[v] = at;
    for (const auto& [number, corners] : change.boundary) rest_.boundary[number] = corners;
    put(change);
  }
  apply_edges(changes);
}

/// All at once: each edge is of one piece.
void MeshOfPieces::apply_edges(const std::vector<Change>& changes) {
  std::vector<Edge> gone, made;
  for (const Change& change : changes) {
    gone.insert(gone.end(), change.edges_gone.begin(), change.edges_gone.end());
    for (const auto& [a, b] : change.edges_made) made.push_back({std::min(a, b), std::max(a, b)});
  }
  if (gone.empty()) return;
  std::sort(gone.begin(), gone.end());
  std::erase_if(edges_, [&](const Edge& e) { return std::binary_search(gone.begin(), gone.end(), e); });
  edges_.insert(edges_.end(), made.begin(), made.end());
  std::sort(edges_.begin(), edges_.end());
}

/// New elements take the places of those that went, as far as these go.
void MeshOfPieces::put(const Change& change) {
  for (const TetIndex t : change.gone) note_gone(t);
  for (std::size_t k = 0; k < change.made.size(); ++k) {
    const std::size_t t = k < change.gone.size() ? change.gone[k] : tets_.size();
    if (t == tets_.size()) {
      tets_.emplace_back();
      if (!region_.empty()) region_.emplace_back();
      if (input_) origin_.came.push_back(0);
    }
    tets_[t] = change.made[k];
    if (!region_.empty()) region_[t] = change.region_of_made[k];
  }
  for (std::size_t k = change.made.size(); k < change.gone.size(); ++k)
    tets_[change.gone[k]] = {kNone, kNone, kNone, kNone};
  live_ += change.made.size();
  live_ -= change.gone.size();
}

void MeshOfPieces::note_gone(TetIndex t) {
  if (!input_ || !std::exchange(origin_.came[t], std::uint8_t{0})) return;
  origin_.gone.push_back(tets_[t]);
  if (!region_.empty()) origin_.region_of_gone.push_back(region_[t]);
}

std::vector<std::uint8_t> MeshOfPieces::corners_below(float threshold) const {
  std::vector<std::uint8_t> marks(points_.size(), 0);
  std::vector<std::uint8_t> any(1, 0);
  parallel_ranges(tets_.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
    for_each_shape(points_, tets_, objective_, begin, end, [&](std::size_t t, const Shape& shape) {
      if (!(shape.score < threshold)) return;
      mark_all(tets_[t], marks);
      SharedValue<std::uint8_t>(any[0]).store(1);
    });
  });
  if (any[0] == 0) marks.clear();
  return marks;
}

std::vector<std::uint8_t> MeshOfPieces::corners_of_crossings() const {
  std::vector<Triangle> triangles;
  for (const Triangle& t : rest_.boundary)
    if (t[0] != kNone) triangles.push_back(t);
  const auto pairs = self_intersections(points_, triangles);
  std::vector<std::uint8_t> marks(pairs.empty() ? 0 : points_.size(), 0);
  for (const auto& pair : pairs)
    for (const std::uint32_t t : pair) mark_all(triangles[t], marks);
  return marks;
}

bool MeshOfPieces::moved_boundary() const {
  const std::vector<Triangle>& was = origin_.rest.boundary;
  return rest_.boundary != was || std::ranges::any_of(was, [&](const Triangle& t) {
           return std::ranges::any_of(t, [&](VertexIndex v) { return points_[v] != home_[v]; });
         });
}

void MeshOfPieces::rewind() {
  points_ = home_;
  rest_ = origin_.rest;
  edges_ = origin_.edges;
  std::vector<Tet> tets = std::exchange(origin_.gone, {});
  std::vector<std::uint32_t> region = std::exchange(origin_.region_of_gone, {});
  for (std::size_t t = 0; t < tets_.size(); ++t) {
    if (origin_.came[t] == 0) continue;
    tets.push_back(tets_[t]);
    if (!region_.empty()) region.push_back(region_[t]);
  }
  tets_ = std::move(tets);
  region_ = std::move(region);
  live_ = tets_.size();
  origin_.came.assign(live_, 1);
}

TetMesh MeshOfPieces::release(Features* features) {
  origin_ = {}, home_ = {};
  TetMesh mesh = std::move(rest_);
  // By their numbers along a curve, the keys of elements say where in space they lie.
  const std::vector<VertexIndex> along = spatial_order(points_);
  std::vector<VertexIndex> place(points_.size());
  parallel_for(along.size(), [&](std::size_t k) { place[along[k]] = static_cast<VertexIndex>(k); });
  std::vector<std::uint8_t> is_used(points_.size(), 0);
  parallel_for(tets_.size(), [&](std::size_t t) {
    if (!is_there(tets_[t])) return;
    mark_all(tets_[t], is_used);
    for (VertexIndex& v : tets_[t]) v = place[v];
  });
  std::vector<VertexIndex> number(points_.size(), kNone);
  for (VertexIndex v = 0; v < points_.size(); ++v) {
    if (is_used[v] == 0) continue;
    number[v] = static_cast<VertexIndex>(mesh.points.size());
    mesh.points.push_back(points_[v]);
  }
  points_ = {};
  const Groups<> order = order_by_key(tets_, along.size());
  const std::vector<TetIndex>& kept = order.items();
  mesh.tets.resize(kept.size());
  mesh.region.resize(region_.empty() ? 0 : kept.size());
  parallel_for(kept.size(), [&](std::size_t k) {
    for (int i = 0; i < 4; ++i) mesh.tets[k][i] = number[along[tets_[kept[k]][i]]];
    if (!region_.empty()) mesh.region[k] = region_[kept[k]];
  });
  tets_ = {};
  drop_removed_triangles(mesh);
  renumber_faces(mesh, number);
  if (features) *features = renumbered(number);
  return mesh;
}

Features MeshOfPieces::renumbered(const std::vector<VertexIndex>& number) const {
  Features features{edges_, input_->of_mesh.corners};
  for (auto& [a, b] : features.edges) {
    const Edge e{number[a], number[b]};
    a = std::min(e[0], e[1]), b = std::max(e[0], e[1]);
  }
  for (VertexIndex& v : features.corners) v = number[v];
  std::sort(features.edges.begin(), features.edges.end());
  std::sort(features.corners.begin(), features.corners.end());
  return features;
}

}  // namespace octafront::improve
