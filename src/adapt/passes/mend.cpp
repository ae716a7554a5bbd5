// Poor elements, mended where they are. A new vertex: the tets around a place from which all faces of what they fill
// are seen well make way for those that join it to these faces (B. Klingner, J. Shewchuk, "Aggressive tetrahedral mesh
// improvement", 2007).

#include "adapt/passes/metric_passes.h"
#include "adapt/passes/worth.h"

#include <algorithm>
#include <cmath>

namespace octafront::adapt {
namespace {

constexpr int kMostMendingCycles = 6;
/// Tets that make way for one vertex.
constexpr std::size_t kMostOfCavity = 40;
/// Steps by which a new vertex looks for its place, in lengths of the metric.
constexpr std::array<double, 2> kStepsOfPlace{0.25, 0.1};
constexpr int kCheckMendEvery = 64;

class Inserter {
 public:
  Inserter(Piece& piece, const Guide& guide) : piece_(piece), guide_(guide) {}

  PassCount run() {
    PassCount count;
    const TetIndex slots = piece_.complex.slots();
    for (TetIndex t = 0; t < slots; ++t) {
      if (!piece_.complex.alive(t) || !is_to_mend(piece_, t)) continue;
      if (++steps_ % kCheckMendEvery == 0) guide_.context.check();
      ++count.tried;
      count.done += insert_in(t);
    }
    return count;
  }

 private:
  struct Cavity {
    std::vector<TetIndex> tets;
    std::vector<Triangle> faces;  ///< counter-clockwise seen from outside
    Vertex at;
    float worst = 0;
  };

  bool insert_in(TetIndex t) {
    const Tet c = piece_.tet(t);
    const float least = kGainOfMending * worth_of(piece_, c);
    Cavity best;
    best.worst = least;
    const auto point = [&](int i) { return piece_.point(c[i]); };
    for (const auto& [i, j] : kTetEdges) try_at(t, 0.5 * (point(i) + point(j)), best);
    for (int i = 0; i < 4; ++i) {
      const Triangle f = face_of(c, i);
      try_at(t, 1.0 / 3 * (piece_.point(f[0]) + piece_.point(f[1]) + piece_.point(f[2])), best);
    }
    try_at(t, 0.25 * (point(0) + point(1) + point(2) + point(3)), best);
    if (best.tets.empty()) return false;
    apply(best);
    return true;
  }

  void try_at(TetIndex t, Vec3 place, Cavity& best) {
    Cavity cavity;
    cavity.at.at = place;
    cavity.at.hint = piece_.vertices[piece_.tet(t)[0]].hint;
    guide_.ask(cavity.at);
    if (!grow(t, cavity, best.worst) || !may_go(cavity)) return;
    // The least that it takes away must be worse than the least that it makes.
    float had = HUGE_VALF;
    for (const TetIndex old : cavity.tets) had = std::min(had, worth_of(piece_, piece_.tet(old)));
    find_place(cavity);
    if (cavity.worst > best.worst && cavity.worst >= kGainOfMending * had) best = std::move(cavity);
  }

  /// The tets that must make way such that all faces are seen from the place with a worth above `least`.
  bool grow(TetIndex first, Cavity& cavity, float least) {
    const std::uint32_t mark = piece_.complex.new_mark();
    const auto take = [&](TetIndex t) { piece_.complex.marks[t] = mark, cavity.tets.push_back(t); };
    take(first);
    // Faces that are seen badly take the tet behind in; what became of faces is looked at in the end.
    for (std::size_t k = 0; k < cavity.tets.size(); ++k)
      for (HalfFace h = 4 * cavity.tets[k]; h < 4 * cavity.tets[k] + 4; ++h) {
        const HalfFace o = piece_.complex.across[h];
        if (!is_outside(o) && piece_.complex.marks[o / 4] == mark) continue;
        if (worth_with(piece_.complex.face(h), cavity.at) > least) continue;
        if (is_outside(o) || piece_.wall[h] != 0 || is_frozen(h) || cavity.tets.size() >= kMostOfCavity) return false;
        take(o / 4);
      }
    cavity.worst = HUGE_VALF;
    for (const TetIndex t : cavity.tets)
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
        const HalfFace o = piece_.complex.across[h];
        if (!is_outside(o) && piece_.complex.marks[o / 4] == mark) {
          if (piece_.wall[h] != 0) return false;
          continue;
        }
        cavity.faces.push_back(piece_.complex.face(h));
        cavity.worst = std::min(cavity.worst, worth_with(cavity.faces.back(), cavity.at));
      }
    return cavity.worst > least;
  }

  bool is_frozen(HalfFace h) const {
    const Triangle f = piece_.complex.face(h);
    return std::all_of(f.begin(), f.end(), [&](VertexIndex v) { return piece_.vertices[v].frozen; });
  }

  float worth_with(const Triangle& f, const Vertex& at) const {
    // Seen from outside the face turns the other way than from the vertex inside.
    return worth_of_corners({&at, &piece_.vertices[f[0]], &piece_.vertices[f[1]], &piece_.vertices[f[2]]}, piece_);
  }

  /// Whether what lies inside, edges and vertices, may vanish.
  bool may_go(const Cavity& cavity) {
    edges_.clear(), rim_.clear();
    for (const Triangle& f : cavity.faces)
      for (std::size_t i = 0; i < 3; ++i) edges_.push_back(sorted_edge(f[i], f[(i + 1) % 3])), rim_.push_back(f[i]);
    std::sort(edges_.begin(), edges_.end()), std::sort(rim_.begin(), rim_.end());
    for (const TetIndex t : cavity.tets) {
      const Tet& c = piece_.tet(t);
      for (const VertexIndex v : c) {
        const Vertex& vertex = piece_.vertices[v];
        if ((vertex.kind != Kind::kInner || vertex.stays()) && !std::binary_search(rim_.begin(), rim_.end(), v))
          return false;
      }
      for (const auto& [i, j] : kTetEdges) {
        const bool stays = piece_.line(c[i], c[j]) || (piece_.vertices[c[i]].frozen && piece_.vertices[c[j]].frozen);
        if (stays && !std::binary_search(edges_.begin(), edges_.end(), sorted_edge(c[i], c[j]))) return false;
      }
    }
    return true;
  }

  void find_place(Cavity& cavity) const {
    const Eigen axes = eigen(cavity.at.metric);
    for (const double length : kStepsOfPlace)
      for (std::size_t i = 0; i < 6; ++i) {
        Vertex to = cavity.at;
        to.at += (i % 2 == 0 ? length : -length) / std::sqrt(axes.value[i / 2]) * axes.vector[i / 2];
        guide_.ask(to);
        float worst = HUGE_VALF;
        for (std::size_t k = 0; k < cavity.faces.size() && worst > cavity.worst; ++k)
          worst = std::min(worst, worth_with(cavity.faces[k], to));
        if (worst > cavity.worst) cavity.at = to, cavity.worst = worst;
      }
  }

  void apply(const Cavity& cavity) {
    const auto v = static_cast<VertexIndex>(piece_.vertices.size());
    const std::uint32_t region = piece_.region[cavity.tets.front()];
    piece_.vertices.push_back(cavity.at);
    piece_.complex.tet_at.push_back(kNone);
    std::vector<Piece::NewTet> fresh;
    for (const Triangle& f : cavity.faces) {
      const Tet c{v, f[0], f[1], f[2]};
      fresh.push_back({c, region, piece_.score_of(c)});
    }
    piece_.replace(cavity.tets, fresh, {});
  }

  Piece& piece_;
  const Guide& guide_;
  std::vector<Edge> edges_;
  std::vector<VertexIndex> rim_;
  int steps_ = 0;
};

}  // namespace

PassCount insert_at_poor(Piece& piece, const Guide& guide) {
  return Inserter(piece, guide).run();
}

PassCount mend_poor(Piece& piece, const Guide& guide) {
  PassCount sum;
  const auto replace = [&](Vertex::Calmness from, Vertex::Calmness to) {
    for (Vertex& v : piece.vertices)
      if (v.calmness == from) v.calmness = to;
  };
  for (int cycle = 0; cycle < kMostMendingCycles; ++cycle) {
    replace(Vertex::kStirred, Vertex::kSettling);
    PassCount count = swap_poor(piece, guide);
    count += move_poor(piece, guide);
    count += collapse_poor(piece, guide);
    count += split_poor(piece, guide);
    count += insert_at_poor(piece, guide);
    replace(Vertex::kSettling, Vertex::kCalm);
    sum += count;
    if (count.done == 0) break;
  }
  return sum;
}

}  // namespace octafront::adapt
