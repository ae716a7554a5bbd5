#include "improve/schedule/mesh_of_pieces.h"

#include "base/core/groups.h"
#include "base/core/index_range.h"
#include "base/core/parallel.h"
#include "base/core/shared_value.h"
#include "base/core/stage_timer.h"
#include "base/core/system_memory.h"
#include "base/geometry/self_intersection.h"
#include "base/geometry/spatial_order.h"
#include "base/mesh/renumber_mesh.h"
#include "base/shared/in_parts.h"
#include "base/shared/marks.h"
#include "base/shared/packing.h"

#include <algorithm>
#include <array>
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

bool is_any_marked(const std::vector<std::uint8_t>& marks) {
  return std::ranges::find(marks, 1) != marks.end();
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
  Shares shares;                     ///< of the cells, whose tets are with the rank that works on them
  std::vector<std::uint8_t> at_rim;  ///< per vertex: has elements in no piece
  Buckets<> tets, triangles, interfaces, edges, vertices;
};

/// An element on its way to another rank.
struct MeshOfPieces::Traveller {
  Tet corners;
  std::uint32_t region;
  std::uint8_t came;
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

  /// Gives new vertices their numbers.
  void number(VertexIndex first_new) {
    const auto renumber = [&](auto& row) {
      for (VertexIndex& v : row)
        if (v != kNone && v >= kNewVertex) v = first_new + (v - kNewVertex);
    };
    std::ranges::for_each(made, renumber);
    std::ranges::for_each(edges_made, renumber);
    for (EditMesh::ChangedTriangle& t : boundary) renumber(t.corners);
  }
};

MeshOfPieces::MeshOfPieces(TetMesh&& mesh, ImproveOptions::Objective objective, const BoundaryInput* input,
                           const Comm& comm, Tets tets, std::size_t most)
    : objective_(objective), input_(input), comm_(comm), shares_(tets), most_(most) {
  require_in_range(mesh.tets.size(), kMostTetsToImprove, "tetrahedra to improve");
  if (tets == Tets::kAll) keep_share(mesh, comm_);
  points_ = std::exchange(mesh.points, {});
  tets_ = std::exchange(mesh.tets, {});
  region_ = std::exchange(mesh.region, {});
  rest_ = std::move(mesh);
  std::array<std::int64_t, 2> of_all{static_cast<std::int64_t>(tets_.size()),
                                     static_cast<std::int64_t>(region_.size())};
  comm_.sum(of_all, "improve");
  live_ = came_ = static_cast<std::size_t>(of_all[0]);
  has_regions_ = of_all[1] != 0;
  for (const Vec3& p : points_) box_.add(p);
  remembers_ = input != nullptr;
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
  std::vector<TetIndex> around;  // those that wait; once some are known, no others come near
  Among among = nullptr;
  for (int stage = 0; stage <= kCellStages; ++stage) {
    if (!is_any_marked(waiting)) return;
    if (before_stage_) before_stage_(*this), among = nullptr;
    const bool all = stage == 0 && std::ranges::find(waiting, 0) == waiting.end();
    const std::vector<std::uint8_t> near = all ? waiting : spread(waiting, rings, among);
    around = touching(near, among);
    among = &around;
    const Division division = divide(near, around, stage);
    const std::size_t slots = tets_.size();
    std::vector<Change> changes = work_on(division, work, progress);
    notes(apply(changes, division.shares));
    for (std::size_t t = slots; t < tets_.size(); ++t) around.push_back(static_cast<TetIndex>(t));
    parallel_for(waiting.size(), [&](std::size_t v) { waiting[v] &= division.at_rim[v]; });
    waiting.resize(points_.size(), 0);
  }
}

Bytes MeshOfPieces::work_on_one(const std::vector<std::uint8_t>& waiting, int rings, const Work& work) {
  const std::vector<std::uint8_t> near = spread(waiting, rings, nullptr);
  std::vector<TetIndex> around = touching(near, nullptr);
  const Division division = divide(near, around, kCellStages);
  std::vector<Change> changes = work_on(division, work, [](double) {});
  return apply(changes, division.shares)[0];
}

/// Those that touch a vertex that is marked.
std::vector<TetIndex> MeshOfPieces::touching(const std::vector<std::uint8_t>& marks, Among among) const {
  constexpr std::size_t kRange = 16384;
  return parallel_collect<TetIndex>(among ? among->size() : tets_.size(), kRange,
                                    [&](std::size_t begin, std::size_t end, std::vector<TetIndex>& found) {
                                      for (std::size_t i = begin; i < end; ++i) {
                                        const auto t = among ? (*among)[i] : static_cast<TetIndex>(i);
                                        if (is_there(tets_[t]) && touches(tets_[t], marks)) found.push_back(t);
                                      }
                                    });
}

/// The marks, and those of so many rings of vertices around.
std::vector<std::uint8_t> MeshOfPieces::spread(std::vector<std::uint8_t> marks, int rings, Among among) const {
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<std::uint8_t> wider = marks;
    parallel_for(among ? among->size() : tets_.size(), [&](std::size_t i) {
      const Tet& t = tets_[among ? (*among)[i] : i];
      if (is_there(t) && touches(t, marks)) mark_all(t, wider);
    });
    marks = std::move(wider);
    join_marks(comm_, marks, "rings");
  }
  return marks;
}

/// Pieces of `tets`, all those around the vertices that are near; of which this rank then has those it works on.
MeshOfPieces::Division MeshOfPieces::divide(const std::vector<std::uint8_t>& near, std::vector<TetIndex>& tets,
                                            int stage) {
  std::vector<std::uint8_t> is_held(points_.size(), 0);
  parallel_for(tets.size(), [&](std::size_t i) { mark_all(tets_[tets[i]], is_held); });
  join_marks(comm_, is_held, "vertices of pieces");
  std::vector<VertexIndex> held;
  for (VertexIndex v = 0; v < points_.size(); ++v)
    if (is_held[v] != 0) held.push_back(v);
  is_held = {};
  const Cells of_held =
      stage < kCellStages ? cells_of_points(held, stage) : Cells{std::vector<std::uint32_t>(held.size(), 0), 1};
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
  join_marks(comm_, at_rim, "rims of pieces");
  const Shares shares = shared_cells(cells, tets);
  deal(cells, shares, tets);
  Buckets<> of_cell(tets.size(), cells.count, [&](std::size_t i, const auto& add) {
    if (const std::uint32_t cell = cells.holding(tets_[tets[i]]); cell != kNoOwner) add(cell, tets[i]);
  });
  Buckets<> vertices(held.size(), cells.count, [&](std::size_t k, const auto& add) { add(of_held.of[k], held[k]); });
  Buckets<> triangles = by_cell(rest_.boundary, cells), interfaces = by_cell(rest_.interfaces, cells),
            edges = by_cell(edges_, cells);
  return {std::move(cells),      shares,           std::move(at_rim),  std::move(of_cell), std::move(triangles),
          std::move(interfaces), std::move(edges), std::move(vertices)};
}

Cells MeshOfPieces::cells_of_points(std::span<const VertexIndex> held, int stage) const {
  const Cube cube = cube_of_stage(box_, stage);
  if (held.size() == points_.size()) return cells_of(points_, cube, most_);
  std::vector<Vec3> places(held.size());
  parallel_for(held.size(), [&](std::size_t k) { places[k] = points_[held[k]]; });
  return cells_of(places, cube, most_);
}

/// By the elements of the cells, on all ranks.
Shares MeshOfPieces::shared_cells(const Cells& cells, std::span<const TetIndex> tets) const {
  std::vector<std::int64_t> count(cells.count, 0);
  if (!comm_.alone())
    for (const TetIndex t : tets)
      if (const std::uint32_t cell = cells.holding(tets_[t]); cell != kNoOwner) ++count[cell];
  comm_.sum(count, "sizes of pieces");
  std::vector<std::uint64_t> work;
  for (const std::int64_t n : count) work.push_back(static_cast<std::uint64_t>(1 + n));
  return {work, comm_.size()};
}

/// Elements of cells go to the ranks that work on these.
void MeshOfPieces::deal(const Cells& cells, const Shares& shares, std::vector<TetIndex>& tets) {
  if (comm_.alone()) return;
  std::vector<std::vector<Traveller>> out(static_cast<std::size_t>(comm_.size()));
  std::vector<TetIndex> stay, free;
  for (const TetIndex t : tets) {
    const std::uint32_t cell = cells.holding(tets_[t]);
    const int rank = cell == kNoOwner ? comm_.rank() : shares.rank_of(cell);
    if (rank == comm_.rank()) {
      stay.push_back(t);
      continue;
    }
    out[static_cast<std::size_t>(rank)].push_back(traveller(t));
    tets_[t] = {kNone, kNone, kNone, kNone};
    free.push_back(t);
  }
  tets = std::move(stay);
  exchange_in_parts(comm_, std::move(out), "tetrahedra of pieces", [&](int, std::span<const Traveller> part) {
    for (const Traveller& tet : part) {
      if (free.empty()) free.push_back(add_slot());
      take_in(tet, free.back());
      tets.push_back(free.back());
      free.pop_back();
    }
  });
}

MeshOfPieces::Traveller MeshOfPieces::traveller(TetIndex t) const {
  return {tets_[t], has_regions_ ? region_[t] : 0, remembers_ ? origin_.came[t] : std::uint8_t{0}};
}

void MeshOfPieces::take_in(const Traveller& tet, TetIndex slot) {
  tets_[slot] = tet.corners;
  if (has_regions_) region_[slot] = tet.region;
  if (remembers_) origin_.came[slot] = tet.came;
}

TetIndex MeshOfPieces::add_slot() {
  const auto t = static_cast<TetIndex>(tets_.size());
  tets_.emplace_back();
  if (has_regions_) region_.emplace_back();
  if (remembers_) origin_.came.push_back(0);
  return t;
}

/// What this rank's threads do to its share of the pieces, and what others do to theirs.
std::vector<MeshOfPieces::Change> MeshOfPieces::work_on(const Division& division, const Work& work,
                                                        const Progress& progress) {
  number_in_piece_.assign(points_.size(), kNone);
  std::vector<Change> changes(division.cells.count);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<std::size_t> done{0};
  const double start = process_cpu_seconds();
  do_share(comm_, division.shares, "improve", [&](std::size_t c) {
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
    if (has_regions_) part.region.push_back(region_[t]);
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

/// Each rank puts its elements; all get the rest. Returns the notes of all pieces.
std::vector<Bytes> MeshOfPieces::apply(std::vector<Change>& changes, const Shares& shares) {
  const std::size_t begin = shares.begin(comm_.rank()), end = shares.end(comm_.rank());
  const std::vector<VertexIndex> first_new = number_new(std::span(changes).subspan(begin, end - begin));
  std::int64_t more_tets = 0;
  std::vector<EditMesh::Moved> placed;
  std::vector<EditMesh::ChangedTriangle> boundary;
  std::vector<Edge> edges_gone, edges_made;
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (std::size_t c = begin; c < end; ++c) {
    Change& change = changes[c];
    change.number(first_new[c]);
    put(change);
    more_tets += static_cast<std::int64_t>(change.made.size()) - static_cast<std::int64_t>(change.gone.size());
    append(placed, change.moved), append(boundary, change.boundary);
    append(edges_gone, change.edges_gone), append(edges_made, change.edges_made);
    for (std::size_t k = 0; k < change.added.size(); ++k)
      placed.push_back({first_new[c] + static_cast<VertexIndex>(k), change.added[k]});
    Bytes notes = std::move(change.notes);
    change = Change();
    change.notes = std::move(notes);
  }
  comm_.sum(std::span(&more_tets, 1), "numbers of elements");
  live_ = static_cast<std::size_t>(static_cast<std::int64_t>(live_) + more_tets);
  gather_in_parts(comm_, placed, "vertices of pieces", [&](int, std::span<const EditMesh::Moved> part) {
    parallel_for(part.size(), [&](std::size_t i) { points_[part[i].vertex] = part[i].to; });
  });
  gather_in_parts(comm_, boundary, "boundary of pieces", [&](int, std::span<const EditMesh::ChangedTriangle> part) {
    for (const auto& [number, corners] : part) rest_.boundary[number] = corners;
  });
  apply_edges(gathered_lists(comm_, edges_gone, "edges of pieces"),
              gathered_lists(comm_, edges_made, "edges of pieces"));
  gather_results(
      comm_, shares, "notes of pieces", changes, [](const Change& change, Packer& to) { to.add(change.notes); },
      [](Change& change, Unpacker& from) { from.take(change.notes); });
  std::vector<Bytes> notes;
  for (Change& change : changes) notes.push_back(std::move(change.notes));
  return notes;
}

/// Makes room for the vertices that pieces have made. Returns the first number of each piece, of all ranks.
std::vector<VertexIndex> MeshOfPieces::number_new(std::span<const Change> changes) {
  std::vector<std::uint32_t> added;
  for (const Change& change : changes) added.push_back(static_cast<std::uint32_t>(change.added.size()));
  std::size_t next = points_.size();
  std::vector<VertexIndex> first_new;
  for (const std::uint32_t count : gathered_lists(comm_, added, "new vertices")) {
    first_new.push_back(static_cast<VertexIndex>(next));
    next += count;
  }
  points_.resize(next);
  return first_new;
}

/// All at once: each edge is of one piece.
void MeshOfPieces::apply_edges(std::vector<Edge> gone, const std::vector<Edge>& made) {
  if (gone.empty()) return;
  std::sort(gone.begin(), gone.end());
  std::erase_if(edges_, [&](const Edge& e) { return std::binary_search(gone.begin(), gone.end(), e); });
  for (const auto& [a, b] : made) edges_.push_back({std::min(a, b), std::max(a, b)});
  std::sort(edges_.begin(), edges_.end());
}

/// New elements take the places of those that went, as far as these go.
void MeshOfPieces::put(const Change& change) {
  for (const TetIndex t : change.gone) note_gone(t);
  for (std::size_t k = 0; k < change.made.size(); ++k) {
    const TetIndex t = k < change.gone.size() ? change.gone[k] : add_slot();
    tets_[t] = change.made[k];
    if (has_regions_) region_[t] = change.region_of_made[k];
  }
  for (std::size_t k = change.made.size(); k < change.gone.size(); ++k)
    tets_[change.gone[k]] = {kNone, kNone, kNone, kNone};
}

void MeshOfPieces::note_gone(TetIndex t) {
  if (!remembers_ || !std::exchange(origin_.came[t], std::uint8_t{0})) return;
  origin_.gone.push_back(tets_[t]);
  if (has_regions_) origin_.region_of_gone.push_back(region_[t]);
}

template <class IsWanted>
std::vector<std::uint8_t> MeshOfPieces::corners_where(const IsWanted& is_wanted) const {
  std::vector<std::uint8_t> marks(points_.size(), 0);
  parallel_ranges(tets_.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
    for_each_shape(points_, tets_, objective_, begin, end, [&](std::size_t t, const Shape& shape) {
      if (is_wanted(shape)) mark_all(tets_[t], marks);
    });
  });
  join_marks(comm_, marks, "corners of elements");
  if (!is_any_marked(marks)) marks.clear();
  return marks;
}

std::vector<std::uint8_t> MeshOfPieces::corners_below(float score) const {
  return corners_where([=](const Shape& s) { return s.score < score; });
}

std::vector<std::uint8_t> MeshOfPieces::corners_to_improve(float beta, float score) const {
  return corners_where([=](const Shape& s) { return s.beta <= beta || s.score < score; });
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
    if (has_regions_) region.push_back(region_[t]);
  }
  tets_ = std::move(tets);
  region_ = std::move(region);
  live_ = came_;
  origin_.came.assign(tets_.size(), 1);
}

TetMesh MeshOfPieces::release(Features* features, std::vector<VertexIndex>* numbers) {
  origin_ = {}, home_ = {}, remembers_ = false;
  return_freed_memory();
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
  place = {};
  join_marks(comm_, is_used, "vertices in use");
  std::vector<VertexIndex> number(points_.size(), kNone);
  for (VertexIndex v = 0; v < points_.size(); ++v)
    if (is_used[v] != 0) number[v] = 0;
  keep_numbered(points_, number);
  drop_removed_triangles(mesh);
  renumber_vertices(mesh, number);
  mesh.points = std::exchange(points_, {});
  is_used = {};
  if (!comm_.alone()) sort_among_ranks(along.size());
  const Groups<> order = order_by_key(tets_, along.size());
  const std::span<const TetIndex> kept = order.items();
  // In their own place, corner by corner: all at once would be there twice.
  std::vector<std::uint32_t> column(kept.size());
  for (std::size_t i = 0; i < 4; ++i) {
    parallel_for(kept.size(), [&](std::size_t k) { column[k] = number[along[tets_[kept[k]][i]]]; });
    parallel_for(kept.size(), [&](std::size_t k) { tets_[k][i] = column[k]; });
  }
  tets_.resize(kept.size());
  mesh.tets = std::exchange(tets_, {});
  if (has_regions_) {
    parallel_for(kept.size(), [&](std::size_t k) { column[k] = region_[kept[k]]; });
    mesh.region = std::move(column);
  }
  region_ = {};
  if (shares_ == Tets::kAll) gather_tets(mesh, comm_);
  if (features) *features = renumbered(number);
  if (numbers) *numbers = std::move(number);
  return mesh;
}

/// Elements, of places along the curve, go to ranks by the first place of each, so that those of a rank come before
/// those of the next in order of keys.
void MeshOfPieces::sort_among_ranks(std::size_t vertices) {
  constexpr std::size_t kStretches = 4096;  // of places; enough for about equal shares
  const auto stretch_of = [&](const Tet& t) { return std::ranges::min(t) * kStretches / vertices; };
  std::vector<std::int64_t> count(kStretches, 0);
  for (const Tet& t : tets_)
    if (is_there(t)) ++count[stretch_of(t)];
  comm_.sum(count, "elements in order");
  const Shares shares(std::vector<std::uint64_t>(count.begin(), count.end()), comm_.size());
  std::vector<std::vector<Traveller>> out(static_cast<std::size_t>(comm_.size()));
  std::vector<TetIndex> free;
  for (TetIndex t = 0; t < tets_.size(); ++t) {
    if (is_there(tets_[t])) {
      const int rank = shares.rank_of(stretch_of(tets_[t]));
      if (rank == comm_.rank()) continue;
      out[static_cast<std::size_t>(rank)].push_back(traveller(t));
    }
    tets_[t] = {kNone, kNone, kNone, kNone};
    free.push_back(t);
  }
  exchange_in_parts(comm_, std::move(out), "elements in order", [&](int, std::span<const Traveller> part) {
    for (const Traveller& tet : part) {
      if (free.empty()) free.push_back(add_slot());
      take_in(tet, free.back());
      free.pop_back();
    }
  });
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
