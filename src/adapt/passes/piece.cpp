#include "adapt/passes/piece.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace octafront::adapt {
namespace {

/// Moves that change no score by more do not ask for other connections.
constexpr float kLittleChange = 0.04f;

}  // namespace

Vertex between(const Vertex& a, const Vertex& b, double part) {
  Vertex made;
  made.hint = a.hint, made.near = a.near;
  made.exact = a.exact && b.exact;
  if (made.exact) return made;
  made.metric = exp_of((1 - part) * log_of(a.metric) + part * log_of(b.metric));
  made.density = density_of(made.metric);
  return made;
}

Piece::Piece(const Parts& mesh, std::span<const TetIndex> tets, std::span<const Parts::Line> lines,
             std::vector<VertexIndex>& here, std::vector<VertexIndex>& number)
    : isotropic(mesh.isotropic), poor(mesh.poor), line_edges(lines.size()) {
  complex.tets.reserve(tets.size() + tets.size() / 2);
  region.reserve(tets.size());
  wall.reserve(4 * tets.size());
  for (const TetIndex t : tets) {
    Tet corners = mesh.tets[t];
    for (VertexIndex& v : corners) {
      if (here[v] == kNone) {
        here[v] = static_cast<VertexIndex>(vertices.size());
        vertices.push_back(mesh.vertices[v]);
        vertices.back().touched = vertices.back().active;
        number.push_back(v);
      }
      v = here[v];
    }
    complex.tets.push_back(corners);
    region.push_back(mesh.region[t]);
    wall.insert(wall.end(), mesh.wall[t].begin(), mesh.wall[t].end());
  }
  for (const Parts::Line& l : lines)
    if (here[l.edge[0]] != kNone && here[l.edge[1]] != kNone) line_edges.set(here[l.edge[0]], here[l.edge[1]], l.path);
  for (const VertexIndex v : number) here[v] = kNone;
  connect();
}

void Piece::connect() {
  complex.connect(vertices.size(), {});
  for (HalfFace h = 0; h < complex.across.size(); ++h) {
    if (complex.across[h] != kNone) continue;
    complex.across[h] = (wall[h] & kOuter) != 0 ? kOutside : kBeyondRim;
    if (complex.across[h] == kBeyondRim)
      for (const VertexIndex v : complex.face(h)) vertices[v].rim = true;
  }
  score.resize(complex.tets.size());
  for (TetIndex t = 0; t < score.size(); ++t) score[t] = score_of(tet(t));
}

bool Piece::ring(TetIndex t, VertexIndex a, VertexIndex b, EdgeRing& out, float least) const {
  const TetComplex::Turn turn = complex.whole_ring(t, complex.corner_of(t, a), complex.corner_of(t, b), out,
                                                   [&](TetIndex next) { return score[next] >= least; });
  const auto ends_outside = [&](TetIndex end, VertexIndex before) {
    return complex.across[complex.opposite(end, before)] == kOutside;
  };
  return turn == TetComplex::Turn::kClosed ||
         (turn == TetComplex::Turn::kOpen && ends_outside(out.tets.front(), out.ring[1]) &&
          ends_outside(out.tets.back(), out.ring[out.ring.size() - 2]));
}

void Piece::walls_of(VertexIndex a, VertexIndex b, const EdgeRing& ring, std::vector<WallAt>& out) const {
  out.clear();
  if (vertices[a].kind == Kind::kInner || vertices[b].kind == Kind::kInner) return;
  const auto add = [&](TetIndex t, VertexIndex opposite, std::size_t place) {
    if (const Wall w = wall[complex.opposite(t, opposite)]; w != 0) out.push_back({place, ring.ring[place], w});
  };
  for (std::size_t k = 0; k < ring.tets.size(); ++k) add(ring.tets[k], ring.ring[(k + 1) % ring.ring.size()], k);
  if (!ring.closed) add(ring.tets.back(), ring.ring[ring.tets.size() - 1], ring.tets.size());
}

TetIndex Piece::tet_with(VertexIndex a, VertexIndex b, TetIndex guess) {
  if (guess < complex.slots() && complex.alive(guess) && complex.has(guess, a) && complex.has(guess, b)) return guess;
  if (complex.tet_at[a] == kNone || complex.tet_at[b] == kNone) return kNone;
  for (const TetIndex t : star(a))
    if (complex.has(t, b)) return t;
  return kNone;
}

void Piece::OpenFaces::reset(std::size_t faces) {
  const std::size_t least = std::bit_ceil(2 * faces);
  if (slots_.size() < least) slots_.assign(least, {}), use_ = 0;
  if (++use_ == 0) std::ranges::fill(slots_, Slot{}), use_ = 1;
  shift_ = 64 - std::countr_zero(slots_.size());
}

bool Piece::OpenFaces::take_or_put(const Triangle& corners, const Rim& put, Rim& taken) {
  const Triangle key = face_key(corners);
  const auto is_key = [&](const Triangle& k) { return k[0] == key[0] && k[1] == key[1] && k[2] == key[2]; };
  std::size_t at = FlatKeys<Triangle>::hash(key) >> shift_;
  while (slots_[at].use == use_ && !is_key(slots_[at].key)) at = (at + 1) & (slots_.size() - 1);
  Slot& slot = slots_[at];
  if (slot.use == use_ && slot.waits) {
    taken = slot.rim;
    slot.waits = false;
    return true;
  }
  slot = {key, use_, true, put};
  return false;
}

void Piece::tie(TetIndex t) {
  for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
    Rim there;
    if (!rim_.take_or_put(complex.face(h), {h, 0}, there)) {
      wall[h] = 0;
      continue;
    }
    wall[h] = there.wall;
    complex.join(h, there.across);
  }
}

TetIndex Piece::slot() {
  if (!complex.free.empty()) {
    const TetIndex t = complex.free.back();
    complex.free.pop_back();
    return t;
  }
  const TetIndex t = complex.slots();
  complex.tets.push_back({});
  complex.across.resize(4 * complex.tets.size(), kNone);
  complex.marks.push_back(0);
  region.push_back(0);
  wall.resize(4 * complex.tets.size(), 0);
  score.push_back(0);
  return t;
}

void Piece::replace(std::span<const TetIndex> old, std::span<const NewTet> fresh, std::span<const NewWall> walls) {
  rim_.reset(4 * (old.size() + fresh.size()));
  const std::uint32_t goes = complex.new_mark();
  for (const TetIndex t : old) complex.marks[t] = goes;
  Rim there;
  for (const TetIndex t : old)
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      const HalfFace o = complex.across[h];
      if (is_outside(o) || complex.marks[o / 4] != goes) rim_.take_or_put(complex.face(h), {o, wall[h]}, there);
    }
  for (const TetIndex t : old)
    for (const VertexIndex v : tet(t)) complex.tet_at[v] = kNone;
  // Where a tet goes without another in its place, the wall lies on its neighbour.
  for (const NewWall& w : walls) {
    if ((w.wall & kOuter) == 0 || !rim_.take_or_put(w.corners, {kOutside, w.wall}, there)) continue;
    complex.across[there.across] = kOutside;
    wall[there.across] = w.wall;
    for (const VertexIndex v : w.corners) complex.tet_at[v] = there.across / 4;
  }
  for (const TetIndex t : old) {
    complex.destroy(t);
    score[t] = 0;
  }
  created_.clear();
  for (const NewTet& n : fresh) {
    const TetIndex t = slot();
    complex.tets[t] = n.corners;
    region[t] = n.region;
    score[t] = n.score;
    created_.push_back(t);
  }
  for (const TetIndex t : created_) {
    for (const VertexIndex v : tet(t)) complex.tet_at[v] = t, touch(v);
    tie(t);
  }
  for (const NewWall& w : walls) {
    if ((w.wall & kOuter) != 0) continue;
    const Triangle key = face_key(w.corners);
    for (const TetIndex t : created_)
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h)
        if (face_key(complex.face(h)) == key) wall[h] = w.wall;
  }
}

void Piece::move(VertexIndex v, const Vertex& to, std::span<const TetIndex> star, std::span<const float> scores) {
  vertices[v] = to;
  bool far = false;
  for (std::size_t k = 0; k < star.size(); ++k) far |= std::abs(score[star[k]] - scores[k]) > kLittleChange;
  for (std::size_t k = 0; k < star.size(); ++k) {
    score[star[k]] = scores[k];
    for (const VertexIndex u : tet(star[k])) far ? touch(u) : loosen(u);
  }
}

std::vector<Parts::Line> Piece::lines() const {
  std::vector<Parts::Line> all;
  line_edges.for_each([&](const Edge& edge, std::uint32_t path) { all.push_back({edge, path}); });
  std::sort(all.begin(), all.end(), [](const Parts::Line& a, const Parts::Line& b) { return a.edge < b.edge; });
  return all;
}

std::optional<std::string> Piece::first_inconsistency() const {
  if (auto wrong = complex.first_inconsistency()) return wrong;
  for (HalfFace h = 0; h < complex.across.size(); ++h) {
    if (!complex.alive(h / 4)) continue;
    const HalfFace o = complex.across[h];
    const std::string name = "face " + std::to_string(h % 4) + " of tetrahedron " + std::to_string(h / 4);
    if (o == kOutside && (wall[h] & kOuter) == 0) return name + " is outer, and no wall";
    if (o == kNone) return name + " has nothing across";
    if (!is_outside(o) && wall[o] != wall[h]) return name + " has another wall on its other side";
  }
  for (TetIndex t = 0; t < score.size(); ++t) {
    if (!complex.alive(t)) continue;
    if (!(score[t] > 0)) return "tetrahedron " + std::to_string(t) + " is not positive";
    if (score[t] != score_of(tet(t))) return "tetrahedron " + std::to_string(t) + " has another score";
  }
  return std::nullopt;
}

}  // namespace octafront::adapt
