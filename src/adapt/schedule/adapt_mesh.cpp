#include "adapt/schedule/adapt_mesh.h"

#include "adapt/passes/metric_passes.h"
#include "adapt/passes/worth.h"
#include "adapt/schedule/balance_walls.h"
#include "adapt/schedule/metric_steps.h"
#include "adapt/schedule/parts.h"
#include "adapt/schedule/section.h"
#include "base/core/disjoint_sets.h"
#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/core/renumber.h"
#include "base/core/validate.h"
#include "base/geometry/blocks.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <cmath>

namespace octafront::adapt {
namespace {

/// Fewer vertices would have more of their elements at rims, more share less well among threads.
constexpr std::size_t kMostVerticesOfPiece = 8192;
/// A piece that has grown by so much is divided anew.
constexpr std::size_t kGrowth = 4, kRoomOfPiece = 4096;
constexpr int kMostRoundsOfAdapt = 60;
/// A split that makes shorter edges than this waits until the place is connected better: otherwise elements that lie
/// across the directions of the metric are divided without end. At first longer ones do, too: most of what comes of
/// them would be collapsed again.
constexpr double kShortestOfSplit = 0.55, kShortestAtFirst = 0.65;
/// Cycles of passes within one piece; on the way.
constexpr int kCycles = 4, kCyclesOnTheWay = 2;
/// So many steps at most on the way to a metric, and none more once less than one change for so many elements is made.
constexpr int kMostSteps = 20, kQuiet = 50;
/// None more either once few vertices are on the way, one of so many, and a step brings less than a part of them there:
/// the others are where walls keep elements from the metric.
constexpr std::size_t kFewOnTheWay = 20, kPartOfStep = 10;
/// Where after all steps more vertices are on the way than one of so many, no mesh comes to this metric: it changes
/// faster than elements can follow, and what they are on the way to is as near as they get.
constexpr std::size_t kManyOnTheWay = 4;
/// A piece has the elements that are awake and layers around them, so many in all: what passes look at.
constexpr int kLayersAwake = 3;
/// Less than one change for so many elements is not worth another round.
constexpr int kDone = 200;
/// Elements of a better score are not connected anew, or moved: qualities of .86 and .93; and not while a piece grows.
constexpr float kGoodForSwaps = 0.8f, kGoodScore = 0.9f, kGoodOnTheWay = 0.3f;
/// Edges of other lengths do not come near to what is wanted.
constexpr double kFarShort = 0.5, kFarLong = 2;
/// Rounds in which elements are made smaller where the surface deviates too far, and how many in a row may be in vain.
constexpr int kMostMendings = 10, kMostInVain = 3;
/// Triangles with no edge longer than so many times the bound do not stray because they are large.
constexpr double kLeastEdgeOfStray = 2;
/// When smaller elements against deviation are worth it. A round counts as in vain unless it brings the excess over the
/// bound below kLeastProgress of what it was. What all rounds made is taken if the excess fell below
/// kLeastGainOfMending of the first one; below kLeastProgress is enough if elements are fewer than kFewMore times those
/// before. Rounds end beyond kGrowthOfMending times the elements.
constexpr double kLeastGainOfMending = 0.7, kLeastProgress = 0.98, kFewMore = 1.1;
constexpr std::size_t kGrowthOfMending = 2;
/// Where edges would cut off more than this part of the bound from a bend of the reference surface, the bend is a
/// curve.
constexpr double kShareOfKink = 0.5;
/// Around them lengths grow by this part of the way, both counted in lengths; what changes less is let be.
constexpr double kGradationOfStrays = 0.5, kLeastChangeOfDensity = 1.02;
/// Places nearer than this part of the bound are near enough, however they are measured.
constexpr double kShareOfBound = 0.85;
/// Layers of elements around those that are mended, and how often they are looked for.
constexpr int kLayersOfMending = 3, kMostRoundsOfMending = 6;
/// Where more elements are poor than one of so many, no place is to blame but the metric, which changes faster than
/// elements can follow: mending each of them would take long, and gain little.
constexpr std::size_t kMostPoor = 4;
/// Where less than one element of so many has a score below this (a quality of .63), such are mended, too.
constexpr float kFairOfSize = 0.5f;
constexpr std::size_t kMostFair = 50;
/// Rounds once no piece has grown so far that it had to be divided anew: each place is inside a piece several times.
constexpr int kLastRounds = 2 * kCellStages;

/// The passes on one piece, until sizes fit.
Counts work_on(Piece& piece, const Guide& guide, int cycles) {
  Counts sum;
  const std::size_t most = kGrowth * piece.vertices.size() + kRoomOfPiece;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    Counts c;
    const bool at_first = cycle == 0 && piece.isotropic;
    c.split = split_long_edges(piece, guide, most, at_first ? kShortestAtFirst : kShortestOfSplit);
    validate(piece);
    if (!c.split.unfinished) {
      c.collapse = collapse_short_edges(piece, guide);
      validate(piece);
      c.swap = swap_edges(piece, guide, kGoodForSwaps);
      if (at_first) c.split += split_long_edges(piece, guide, most, kShortestOfSplit);
    }
    if (c.split.unfinished) {  // it goes on in smaller pieces: what is here is good enough for that
      c.swap += swap_edges(piece, guide, kGoodOnTheWay);
      c.move = smooth_vertices(piece, guide, kGoodOnTheWay);
      for (Vertex& v : piece.vertices) v.active = v.loose = true;
      sum += c, sum.grown = true;
      break;
    }
    validate(piece);
    c.move = settle_on_ground(piece, guide);
    c.move += smooth_vertices(piece, guide, kGoodScore);
    validate(piece);
    sum += c;
    if (c.changes() == 0) break;
  }
  return sum;
}

class Adapter {
 public:
  Adapter(Parts& mesh, const Guide& guide, const AdaptRules& rules, const Stage& stage)
      : mesh_(mesh),
        guide_(guide),
        stage_(stage),
        feature_angle_(rules.feature_angle),
        walls_ahead_(rules.walls_ahead),
        on_the_way_(!guide.metric.is_isotropic()) {}

  Counts run() {
    Counts sum;
    bool is_quiet = false;
    for (int round = 0, since_growth = 0; round < kMostRoundsOfAdapt && since_growth < kLastRounds; ++round) {
      if (round == kMostSteps && steps_left_ * kManyOnTheWay > mesh_.vertices.size()) on_the_way_ = false;
      if (on_the_way_) step(round >= kMostSteps || is_quiet);
      const Counts c = this->round(cells_of_stage(round % kCellStages));
      sum += c;
      is_quiet = c.changes() * kQuiet < mesh_.tets.size();
      stage_.progress(-1);
      since_growth = c.grown || on_the_way_ ? 0 : since_growth + 1;
      if (c.changes() == 0 && !c.grown && !on_the_way_ && round + 1 >= kCellStages) break;
      if (since_growth >= kCellStages && c.changes() * kDone < mesh_.tets.size()) break;
    }
    stage_.count("balanced vertices", static_cast<double>(balance_walls(mesh_, guide_, feature_angle_)));
    mend(sum);
    sum.tell(stage_);
    stage_.count("mended places", static_cast<double>(sum.mend.done));
    return sum;
  }

 private:
  void step(bool last) {
    const std::size_t before = steps_left_;
    steps_left_ = take_step(mesh_, guide_, last || is_stuck_, walls_ahead_);
    on_the_way_ = steps_left_ > 0;
    is_stuck_ = steps_left_ * kFewOnTheWay < mesh_.vertices.size() && steps_left_ + before / kPartOfStep > before;
  }

  /// What is still poor, each place by itself: what is so long that it was at the rim of all its pieces, too.
  void mend(Counts& sum) {
    choose_poor();
    if (!mesh_.isotropic && count_poor() * kMostPoor > mesh_.tets.size()) return;
    mends_ = true;
    for (int k = 0; k < kMostRoundsOfMending; ++k) {
      const Cells places = poor_places(k > 0);
      if (places.count == 0) break;
      const Counts c = round(places);
      sum += c;
      if (c.mend.done == 0 && !c.grown) break;
    }
    mends_ = false;
  }

  /// Where few elements are less than good those are mended, too.
  void choose_poor() {
    mesh_.poor = mesh_.isotropic ? kFairOfSize : kPoorInMetric;
    if (mesh_.isotropic && count_poor() * kMostFair > mesh_.tets.size()) mesh_.poor = kPoorOfSize;
  }

  std::size_t count_poor() const {
    return parallel_sum(mesh_.tets.size(), [&](std::size_t begin, std::size_t end) {
      std::size_t count = 0;
      for (std::size_t t = begin; t < end; ++t) count += is_poor(mesh_, mesh_.tets[t]);
      return count;
    });
  }

  /// A cell for each lot of poor elements and some layers around, numbered by their least vertices; other vertices are
  /// in none. Poor elements are awake then; all others, the room around them too, sleep until something changes beside
  /// them: otherwise places would grow by their rims from round to round, over the whole mesh. `again`: what mending
  /// has changed counts as poor, too, for lengths may have changed.
  Cells poor_places(bool again) {
    const auto is_active = [&](VertexIndex v) { return mesh_.vertices[v].active; };
    std::vector<std::uint8_t> poor(mesh_.tets.size()), near(mesh_.vertices.size(), 0);
    parallel_for(poor.size(), [&](std::size_t t) {
      const Tet& c = mesh_.tets[t];
      poor[t] = is_to_mend(mesh_, c) || (again && std::any_of(c.begin(), c.end(), is_active));
    });
    mark_vertices(mesh_.tets, poor, near);
    for (VertexIndex v = 0; v < near.size(); ++v) mesh_.vertices[v].active = mesh_.vertices[v].loose = near[v] != 0;
    for (int layer = 0; layer < kLayersOfMending; ++layer) grow_layer(mesh_.tets, poor, near);
    DisjointSets lots(mesh_.vertices.size());
    for (std::size_t t = 0; t < poor.size(); ++t)
      if (poor[t])
        for (int i = 1; i < 4; ++i) lots.join(mesh_.tets[t][0], mesh_.tets[t][i]);
    Cells places;
    places.of.assign(mesh_.vertices.size(), kNoOwner);
    std::vector<std::uint32_t> number(mesh_.vertices.size(), kNoOwner);
    for (VertexIndex v = 0; v < near.size(); ++v) {
      if (!near[v]) continue;
      std::uint32_t& place = number[lots.find(v)];
      if (place == kNoOwner) place = places.count++;
      places.of[v] = place;
    }
    return places;
  }

  /// A piece that was worked on, as it goes back into the mesh. `vertices`: the new ones, counted on behind kFresh.
  struct Done : Parts {
    std::vector<std::pair<VertexIndex, Vertex>> changed;
    Counts counts;
  };
  static constexpr VertexIndex kFresh = 0x80000000u;

  Cells cells_of_stage(int stage) const {
    std::vector<Vec3> points;
    Box3 box;
    for (const Vertex& v : mesh_.vertices) points.push_back(v.at), box.add(v.at);
    return cells_of(points, cube_of_stage(box, stage), kMostVerticesOfPiece);
  }

  Counts round(const Cells& cells) {
    std::vector<TetIndex> all(mesh_.tets.size());
    for (TetIndex t = 0; t < all.size(); ++t) all[t] = t;
    const ItemsByCell<TetIndex> tets(std::span<const TetIndex>(all), cells.count,
                                     [&](TetIndex t) { return cells.holding(mesh_.tets[t]); });
    const ItemsByCell<Parts::Line> lines(std::span<const Parts::Line>(mesh_.lines), cells.count,
                                         [&](const Parts::Line& l) { return cells.holding(l.edge); });
    std::vector<Done> done(cells.count);
    PerThread<std::vector<VertexIndex>> scratch;
    parallel_for(
        cells.count,
        [&](std::size_t c) {
          const auto cell = static_cast<std::uint32_t>(c);
          stage_.check();
          std::vector<VertexIndex>& here =
              scratch.local([&] { return std::vector<VertexIndex>(mesh_.vertices.size(), kNone); });
          done[c] = work_in(tets[cell], lines[cell], here);
        },
        Split::kSingly);
    return merge(done, tets.left(), lines.left());
  }

  /// The tets that are to be a piece: all of a place that is mended, else those where something may be left to do, and
  /// some layers around. All others are done as they are, and so are lines that the piece does not know.
  std::vector<TetIndex> take_awake(std::span<const TetIndex> tets, std::span<const Parts::Line> lines,
                                   std::vector<VertexIndex>& here, Done& done) const {
    const auto is_awake = [&](VertexIndex v) {
      return mends_ || here[v] != kNone || mesh_.vertices[v].active || mesh_.vertices[v].loose;
    };
    std::vector<std::uint8_t> taken(tets.size(), 0);
    for (int layer = 0; layer < kLayersAwake; ++layer) {
      for (std::size_t k = 0; k < tets.size(); ++k) {
        const Tet& c = mesh_.tets[tets[k]];
        taken[k] = taken[k] || std::any_of(c.begin(), c.end(), is_awake);
      }
      for (std::size_t k = 0; k < tets.size(); ++k)
        if (taken[k])
          for (const VertexIndex v : mesh_.tets[tets[k]]) here[v] = 0;
    }
    std::vector<TetIndex> awake;
    for (std::size_t k = 0; k < tets.size(); ++k) {
      const TetIndex t = tets[k];
      if (taken[k]) {
        awake.push_back(t);
        continue;
      }
      done.add(mesh_, t);
    }
    for (const Parts::Line& l : lines)
      if (here[l.edge[0]] == kNone || here[l.edge[1]] == kNone) done.lines.push_back(l);
    for (const TetIndex t : awake)
      for (const VertexIndex v : mesh_.tets[t]) here[v] = kNone;
    return awake;
  }

  Done work_in(std::span<const TetIndex> tets, std::span<const Parts::Line> lines, std::vector<VertexIndex>& here) {
    Done done;
    const std::vector<TetIndex> awake = take_awake(tets, lines, here, done);
    if (awake.empty()) return done;
    std::vector<VertexIndex> number;
    Piece piece(mesh_, awake, lines, here, number);
    done.counts = work_on(piece, guide_, on_the_way_ ? kCyclesOnTheWay : kCycles);
    if (mends_) done.counts.mend = mend_poor(piece, guide_);
    validate(piece);
    settle(piece);
    const auto known = static_cast<VertexIndex>(number.size());
    const auto global = [&](VertexIndex v) { return v < known ? number[v] : kFresh + (v - known); };
    for (VertexIndex v = 0; v < piece.vertices.size(); ++v) {
      if (v >= known)
        done.vertices.push_back(piece.vertices[v]);
      else
        done.changed.emplace_back(number[v], piece.vertices[v]);
    }
    for (TetIndex t = 0; t < piece.complex.slots(); ++t) {
      if (!piece.complex.alive(t)) continue;
      Tet c = piece.tet(t);
      for (VertexIndex& v : c) v = global(v);
      done.tets.push_back(c);
      done.region.push_back(piece.region[t]);
      done.wall.push_back({piece.wall[4 * t], piece.wall[4 * t + 1], piece.wall[4 * t + 2], piece.wall[4 * t + 3]});
    }
    for (const Parts::Line& l : piece.lines()) done.lines.push_back({{global(l.edge[0]), global(l.edge[1])}, l.path});
    return done;
  }

  /// What is left to do lies where passes did not come to an end, and around the rim.
  static void settle(Piece& piece) {
    std::vector<std::uint8_t> beside_rim(piece.vertices.size(), 0);
    for (TetIndex t = 0; t < piece.complex.slots(); ++t) {
      if (!piece.complex.alive(t)) continue;
      const Tet& c = piece.tet(t);
      if (std::any_of(c.begin(), c.end(), [&](VertexIndex v) { return piece.vertices[v].rim; }))
        for (const VertexIndex v : c) beside_rim[v] = 1;
    }
    for (VertexIndex v = 0; v < beside_rim.size(); ++v) {
      // What was active before this round may be so because of its other side.
      if (beside_rim[v]) piece.vertices[v].active = piece.vertices[v].loose = piece.vertices[v].touched;
      piece.vertices[v].rim = false;
    }
  }

  Counts merge(std::vector<Done>& done, std::span<const TetIndex> left, std::span<const Parts::Line> left_lines) {
    Parts next;
    next.isotropic = mesh_.isotropic, next.poor = mesh_.poor;
    Counts sum;
    next.vertices = std::move(mesh_.vertices);
    std::size_t tets = left.size();
    for (const Done& d : done) tets += d.tets.size();
    next.tets.reserve(tets), next.region.reserve(tets), next.wall.reserve(tets);
    std::vector<VertexIndex> first_fresh;
    for (const Done& d : done) {
      for (const auto& [v, vertex] : d.changed) next.vertices[v] = vertex;
      first_fresh.push_back(static_cast<VertexIndex>(next.vertices.size()));
      next.vertices.insert(next.vertices.end(), d.vertices.begin(), d.vertices.end());
      sum += d.counts;
    }
    for (std::size_t k = 0; k < done.size(); ++k) {
      const auto global = [&](VertexIndex v) { return v < kFresh ? v : v - kFresh + first_fresh[k]; };
      for (Tet c : done[k].tets) {
        for (VertexIndex& v : c) v = global(v);
        next.tets.push_back(c);
      }
      next.region.insert(next.region.end(), done[k].region.begin(), done[k].region.end());
      next.wall.insert(next.wall.end(), done[k].wall.begin(), done[k].wall.end());
      for (const Parts::Line& l : done[k].lines)
        next.lines.push_back({sorted_edge(global(l.edge[0]), global(l.edge[1])), l.path});
      done[k] = {};
    }
    for (const TetIndex t : left) next.add(mesh_, t);
    next.lines.insert(next.lines.end(), left_lines.begin(), left_lines.end());
    mesh_ = compacted(std::move(next));
    return sum;
  }

  /// Without the vertices that no tet has.
  static Parts compacted(Parts mesh) {
    std::vector<VertexIndex> number(mesh.vertices.size(), kNone);
    for (const Tet& t : mesh.tets)
      for (const VertexIndex v : t) number[v] = 0;
    keep_numbered(mesh.vertices, number);
    renumber(mesh.tets, number);
    for (Parts::Line& l : mesh.lines) l.edge = sorted_edge(number[l.edge[0]], number[l.edge[1]]);
    return mesh;
  }

  Parts& mesh_;
  const Guide& guide_;
  const Stage& stage_;
  double feature_angle_;
  bool walls_ahead_, on_the_way_, mends_ = false;
  std::size_t steps_left_ = kNone;  ///< vertices that are on the way
  bool is_stuck_ = false;
};

}  // namespace

FitFinder::FitFinder(std::span<const Vec3> points, const MetricField& metric, std::size_t edges)
    : at_(points.size()), seen_(edges) {
  parallel_for(at_.size(), [&](std::size_t v) {
    at_[v].at = points[v];
    at_[v].metric = metric.at(at_[v].at, at_[v].hint);
    at_[v].density = density_of(at_[v].metric);
  });
  fit_.quality_min = 1, fit_.shortest = HUGE_VAL;
}

void FitFinder::add(double quality, double complexity, Vec3 middle) {
  if (quality < fit_.quality_min) fit_.quality_min = quality, fit_.quality_min_at = middle;
  qualities_ += quality, ++elements_;
  fit_.complexity += complexity;
}

void FitFinder::add_edge(VertexIndex a, VertexIndex b) {
  if (!seen_.insert(sorted_edge(a, b))) return;
  const double l = metric_length(at_[b].at - at_[a].at, at_[a].metric, at_[b].metric);
  ++fit_.edges, fit_.fitting += l >= kShortest && l <= kLongest;
  fit_.far += l < kFarShort || l > kFarLong;
  const Vec3 middle = 0.5 * (at_[a].at + at_[b].at);
  if (l < fit_.shortest) fit_.shortest = l, fit_.shortest_at = middle;
  if (l > fit_.longest) fit_.longest = l, fit_.longest_at = middle;
}

MetricFit FitFinder::found() const {
  MetricFit fit = fit_;
  fit.quality_mean = elements_ == 0 ? 0 : qualities_ / static_cast<double>(elements_);
  return fit;
}

MetricFit fit_of(const TetMesh& mesh, const MetricField& metric) {
  FitFinder fit(mesh.points, metric, 8 * mesh.points.size());
  for (const Tet& t : mesh.tets) {
    const Vertex& densest = densest_of({&fit.at(t[0]), &fit.at(t[1]), &fit.at(t[2]), &fit.at(t[3])});
    double densities = 0;
    for (const VertexIndex v : t) densities += fit.at(v).density;
    const Vec3 a = fit.at(t[0]).at, b = fit.at(t[1]).at, c = fit.at(t[2]).at, d = fit.at(t[3]).at;
    const double six = dot(cross(b - a, c - a), d - a);
    fit.add(quality_of_score(metric_score(six, densest.metric, densest.density, a, b, c, d)), six / 24 * densities,
            0.25 * (a + b + c + d));
    for (const auto& [i, j] : kTetEdges) fit.add_edge(t[i], t[j]);
  }
  return fit.found();
}

namespace {

/// Freezes the vertices, and leaves out the tets, and the lines between vertices of no other, that cannot change.
void freeze(Parts& parts, std::span<const std::uint8_t> frozen) {
  for (VertexIndex v = 0; v < frozen.size(); ++v) parts.vertices[v].frozen = frozen[v] != 0;
  std::vector<std::uint8_t> used(parts.vertices.size(), 0);
  std::size_t count = 0;
  for (TetIndex t = 0; t < parts.tets.size(); ++t) {
    const Tet& c = parts.tets[t];
    if (std::all_of(c.begin(), c.end(), [&](VertexIndex v) { return frozen[v] != 0; })) continue;
    for (const VertexIndex v : c) used[v] = 1;
    parts.tets[count] = c, parts.region[count] = parts.region[t], parts.wall[count] = parts.wall[t];
    ++count;
  }
  parts.tets.resize(count), parts.region.resize(count), parts.wall.resize(count);
  std::erase_if(parts.lines, [&](const Parts::Line& l) { return !used[l.edge[0]] || !used[l.edge[1]]; });
}

}  // namespace

namespace {

/// Lengths grow no faster than by a part of the way from these vertices on.
void grade_from(Parts& parts, std::vector<VertexIndex> queue) {
  const Groups<> corners = group_by_owner(static_cast<std::uint32_t>(parts.vertices.size()),
                                          static_cast<std::uint32_t>(4 * parts.tets.size()),
                                          [&](std::uint32_t c) { return parts.tets[c / 4][c % 4]; });
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const Vertex from = parts.vertices[queue[k]];
    for (const std::uint32_t c : corners[queue[k]])
      for (const VertexIndex u : parts.tets[c / 4]) {
        Vertex& to = parts.vertices[u];
        const double most = 1 + kGradationOfStrays * std::sqrt(from.metric.squared(to.at - from.at));
        if (u == queue[k] || to.density >= from.density) continue;
        const Metric limited = within(from.metric, to.metric, 0, most);
        if (density_of(limited) <= kLeastChangeOfDensity * to.density) continue;
        ask_for(to, limited);
        queue.push_back(u);
      }
  }
}

/// Brings walls that stray too far nearer to the ground.
void mend_walls(Parts& parts, const Ground& ground, const AdaptRules& rules, Adapter& adapter, Adapted& out,
                const WallBounds& bounds, const Stage& stage) {
  if (rules.tolerance <= 0 || bounds.tolerance.empty()) return;
  SmoothWalls smooth(ground, bounds);
  // Walls that stay are frozen, and those are not looked at.
  out.deviations = rules.keep_walls ? smooth.of_old() : smooth.of(parts);
  if (rules.keep_walls || excess_of(out.deviations) <= 1) return;
  const Parts first = parts;
  Parts best = parts;
  std::vector<Deviation> nearest = out.deviations;
  for (int k = 0, in_vain = 0; k < kMostMendings && in_vain < kMostInVain && excess_of(nearest) > 1; ++k) {
    stage.check();
    const std::vector<SmoothWalls::Stray> strays = smooth.strays(parts, kShareOfBound, kLeastEdgeOfStray);
    if (strays.empty() || parts.tets.size() > kGrowthOfMending * first.tets.size() + kRoomOfPiece) break;
    stage.count("wall triangles that strayed", static_cast<double>(strays.size()));
    grade_from(parts, ask_for_smaller(parts.vertices, strays));
    adapter.run();
    const std::vector<Deviation> now = smooth.of(parts);
    in_vain = excess_of(now) < kLeastProgress * excess_of(nearest) ? 0 : in_vain + 1;
    if (excess_of(now) < excess_of(nearest)) nearest = now, best = parts;
  }
  // Smaller elements are no use where the ground itself has a step.
  const bool is_cheap = static_cast<double>(best.tets.size()) < kFewMore * static_cast<double>(first.tets.size());
  const double gain = is_cheap ? kLeastProgress : kLeastGainOfMending;
  const double reached = excess_of(nearest);
  const bool helped = reached <= 1 || reached < gain * excess_of(out.deviations);
  if (helped) out.deviations = std::move(nearest);
  parts = helped ? std::move(best) : first;
}

}  // namespace

GivenFit given_fit(const Ground& ground, std::span<const Vertex> vertices) {
  GivenFit fit;
  if (!ground.given()) return fit;
  const SurfaceMesh& walls = ground.walls().surface;
  fit.walls = walls.triangles.size();
  for (std::uint32_t t = 0; t < walls.triangles.size(); ++t) {
    if (ground.is_covered(t)) continue;
    const auto& [a, b, c] = walls.triangles[t];
    if (fit.own_walls++ == 0) fit.own_wall_at = centroid(walls.points[a], walls.points[b], walls.points[c]);
  }
  for (const Vertex& v : vertices)
    if (v.off && !v.frozen && !v.held && fit.held++ == 0) fit.held_at = v.at;
  return fit;
}

namespace {

/// Per part of walls, by its sets.
WallBounds bounds_of(const TetMesh& mesh, const TakenApart& taken, const AdaptRules& rules) {
  WallBounds bounds{{}, {}, taken.kept, rules.kept.empty() ? rules.frozen : rules.kept};
  for (const std::uint32_t face : taken.labels.walls) {
    double tolerance = rules.tolerance;
    bool strict = rules.strict, is_own = false;
    for (const ToleranceOfSet& own : rules.tolerances) {
      if (!has_member(mesh.sets[own.set], face)) continue;
      if (is_own && own.tolerance >= tolerance) continue;
      tolerance = own.tolerance, strict = own.strict, is_own = true;
    }
    bounds.tolerance.push_back(tolerance);
    bounds.strict.push_back(strict);
  }
  return bounds;
}

/// Where a bound is asked for, edges at which the ground bends too much for the sizes wanted are lines, too.
TakenApart taken_apart(const TetMesh& mesh, const MetricField& metric, const AdaptRules& rules) {
  TakenApart taken = take_apart(mesh, rules.feature_angle);
  const bool any_strict = rules.strict || std::any_of(rules.tolerances.begin(), rules.tolerances.end(),
                                                      [](const ToleranceOfSet& t) { return t.strict; });
  if (!any_strict || rules.tolerance <= 0) return taken;
  const WallBounds bounds = bounds_of(mesh, taken, rules);
  std::vector<double> cut_off;
  for (std::size_t p = 0; p < bounds.tolerance.size(); ++p)
    cut_off.push_back(bounds.strict[p] ? kShareOfKink * bounds.tolerance[p] : HUGE_VAL);
  const Ground ground(std::move(taken.walls), rules.given);
  const auto wanted = [&](Vec3 p, Vec3 direction) {
    std::uint32_t hint = 0;
    return 1 / std::sqrt(metric.at(p, hint).squared(direction));
  };
  return take_apart(mesh, rules.feature_angle, ground.kinks(wanted, cut_off));
}

}  // namespace

Adapted adapt_mesh(const TetMesh& mesh, const MetricField& metric, const AdaptRules& rules, const Stage& stage) {
  TakenApart taken = taken_apart(mesh, metric, rules);
  if (!rules.frozen.empty()) freeze(taken.parts, rules.frozen);
  hold_sets(taken, mesh, rules.kept_sets);
  const Ground ground(std::move(taken.walls), rules.given);
  const WallBounds bounds = bounds_of(mesh, taken, rules);
  const auto least = std::min_element(bounds.tolerance.begin(), bounds.tolerance.end());
  const Guide guide{metric,          ground,     least == bounds.tolerance.end() ? rules.tolerance : *least,
                    stage.context(), taken.kept, bounds.tolerance};
  taken.parts.isotropic = metric.is_isotropic();
  const std::vector<Triangle>& walls = ground.walls().surface.triangles;
  for (std::uint32_t t = 0; t < walls.size(); ++t)
    for (const VertexIndex v : walls[t]) taken.parts.vertices[v].near = t;
  parallel_for(taken.parts.vertices.size(), [&](std::size_t v) { guide.ask(taken.parts.vertices[v]); });
  if (rules.keep_walls)
    for (Vertex& v : taken.parts.vertices) v.frozen |= v.kind != Kind::kInner;
  for (VertexIndex v = 0; v < rules.kept.size(); ++v) taken.parts.vertices[v].frozen |= rules.kept[v] != 0;
  Adapter adapter(taken.parts, guide, rules, stage);
  adapter.run();
  Adapted out;
  mend_walls(taken.parts, ground, rules, adapter, out, bounds, stage);
  out.given = given_fit(ground, taken.parts.vertices);
  out.mesh = put_together(taken.parts, taken.labels, mesh, out.from);
  return out;
}

}  // namespace octafront::adapt
