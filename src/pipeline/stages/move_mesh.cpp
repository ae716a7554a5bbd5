#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/improve_existing.h>
#include <octafront/move.h>
#include <octafront/quality.h>
#include <octafront/second_order.h>
#include <octafront/validity.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/geometry/self_intersection.h"
#include "base/mesh/periodic_nodes.h"
#include "pipeline/stages/moving.h"
#include "pipeline/stages/stages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/core.h>

namespace octafront {
namespace {

/// Steps keep elements above this part of the quality at which they are mended.
constexpr double kQualityOfSteps = 0.5;
/// A step that is shorter than this part of the motion gets nowhere.
constexpr double kShortestStep = 1e-4;
/// How exactly the part of the motion is found at which the body touches itself.
constexpr double kContactFound = 1e-3;
/// How often contact is looked for on the way of one step at most.
constexpr double kMostLooks = 200;
/// A body of less than this part of its volume is flat.
constexpr double kFlat = 1e-6;
/// Pairs of a periodic mesh may differ by this in what they move by, in parts of the longest way: solvers and files
/// round.
constexpr double kSameWay = 1e-5;

/// How far the periods of a mesh move with its pairs. Throws InputError where pairs do not stay copies.
std::vector<Vec3> ways_of_periods(const TetMesh& mesh, std::span<const Vec3> ways) {
  double farthest = 0;
  for (const Vec3& w : ways) farthest = std::max(farthest, length(w));
  std::vector<std::optional<Vec3>> found(mesh.periods.size());
  for (const auto& [period, copy, original] : mesh.periodic_nodes) {
    const Vec3 way = ways[copy] - turned_by_period(mesh, period, ways[original]);
    if (!found[period]) found[period] = way;
    if (distance(way, *found[period]) > kSameWay * farthest)
      throw InputError(fmt::format(
          "the motion is not periodic: at {} the copy moves by another way than its original leads to (point {} of {})",
          at_point(mesh.points[copy]), copy, original));
  }
  std::vector<Vec3> all;
  for (const auto& way : found) all.push_back(way.value_or(Vec3{}));
  return all;
}

/// Paired nodes and periods on a grid as fine as floating point is at the largest of them: so copies of copies come to
/// the same place by whichever period first.
void make_sums_exact(TetMesh& mesh) {
  double largest = 0;
  const auto look = [&](const Vec3& p) { largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)}); };
  for (const auto& [period, copy, original] : mesh.periodic_nodes) look(mesh.points[copy]), look(mesh.points[original]);
  for (const Vec3& t : mesh.periods) look(t);
  // Room for sums of four.
  const double step = std::ldexp(1.0, std::ilogb(largest) - std::numeric_limits<double>::digits + 3);
  const auto snap = [step](Vec3& p) {
    for (const auto k : {&Vec3::x, &Vec3::y, &Vec3::z}) p.*k = step * std::round(p.*k / step);
  };
  for (const auto& [period, copy, original] : mesh.periodic_nodes) snap(mesh.points[copy]), snap(mesh.points[original]);
  for (Vec3& t : mesh.periods) snap(t);
}

class Mover {
 public:
  Mover(const TetMesh& mesh, std::span<const Vec3> displacement, std::span<const MeshField> fields,
        const Options& options, const RunContext& context)
      : options_(options), context_(context), left_(displacement.begin(), displacement.end()) {
    made_.mesh = mesh, made_.fields.assign(fields.begin(), fields.end());
    make_linear(made_.mesh);
    left_.resize(made_.mesh.points.size());
    can_change_ = made_.mesh.wide_cells.empty() && made_.mesh.periods.empty();
    mark_wide();
    for (const Metric& m : metrics::of_edges(made_.mesh))
      lengths_.push_back(options.size.size.value_or(1 / std::sqrt(m.xx)));
    // Improvement that may turn a whole mesh over is for the end; here poor places are enough.
    options_.improve.level = ImproveOptions::Level::kFast;
  }

  MovedMesh move() {
    while (done_ < 1) {
      context_.check();
      context_.report("move", done_);
      take_step();
      mend();
    }
    return std::move(made_);
  }

 private:
  /// With part `r` of what is left.
  std::vector<Vec3> points_after(double r) const {
    std::vector<Vec3> points = made_.mesh.points;
    for (std::size_t v = 0; v < points.size(); ++v) points[v] += r * left_[v];
    return points;
  }

  /// Copies go where the periods, which move too, lead their originals. Copies of copies come there in as many rounds
  /// as there are periods.
  void go(double part) {
    const std::vector<Vec3> ways = ways_of_periods(made_.mesh, left_);
    made_.mesh.points = points_after(part);
    for (std::size_t k = 0; k < ways.size(); ++k) made_.mesh.periods[k] += part * ways[k];
    if (!ways.empty()) make_sums_exact(made_.mesh);
    for (std::size_t round = 0; round < ways.size(); ++round)
      for (const auto& [period, copy, original] : made_.mesh.periodic_nodes)
        made_.mesh.points[copy] = led_by_period(made_.mesh, period, made_.mesh.points[original]);
    for (Vec3& w : left_) w = (1 - part) * w;
    done_ = part == 1 ? 1 : done_ + part * (1 - done_);
  }

  /// The least beta, but of wedges and pyramids; negative where an element is not positive by exact sign.
  double poorest(const std::vector<Vec3>& p) const {
    const auto bad = parallel_find(made_.mesh.tets.size(), [&](std::size_t t) {
      const auto& [a, b, c, d] = made_.mesh.tets[t];
      return orient3d(p[a], p[b], p[c], p[d]) <= 0;
    });
    if (bad < made_.mesh.tets.size()) return -1;
    double least = 1;
    for (TetIndex t = 0; t < made_.mesh.tets.size(); ++t) {
      const auto& [a, b, c, d] = made_.mesh.tets[t];
      if (!is_wide_[t]) least = std::min(least, tet_radius_ratio(p[a], p[b], p[c], p[d]));
    }
    return least;
  }

  /// A place where the boundary crosses or touches itself; none: it does not.
  std::optional<Vec3> contact(const std::vector<Vec3>& points) const {
    const auto pairs = self_intersections(points, made_.mesh.boundary, 1, context_);
    if (pairs.empty()) return std::nullopt;
    const auto& [a, b, c] = made_.mesh.boundary[pairs.front()[0]];
    return centroid(points[a], points[b], points[c]);
  }

  double quality_to_keep() const {
    return std::min(kQualityOfSteps * options_.move.least_quality, kQualityOfSteps * poorest(made_.mesh.points));
  }

  void take_step() {
    if (options_.move.boundary_alone) left_ = harmonic_inside(made_.mesh, std::move(left_), context_);
    const double wanted = quality_to_keep();
    double part = 1;
    const bool at_once = is_better_than_the_way();
    while (!at_once && poorest(points_after(part)) < wanted) {
      part /= 2;
      if (part * (1 - done_) < kShortestStep) refuse_to_follow();
    }
    look_for_contact(part);
    go(part);
  }

  /// Points go straight, also those that are to turn: then the body is worse half way than in the end, which is where
  /// it is to be mended.
  bool is_better_than_the_way() const {
    const double in_the_end = poorest(points_after(1));
    return in_the_end > 0 && in_the_end > poorest(points_after(0.5));
  }

  [[noreturn]] void refuse_to_follow() const {
    throw MeshingError(fmt::format(
        "elements cannot follow the motion beyond {:.2f} % of it, though they are {}: it folds the body, or is "
        "not smooth at the length of elements",
        100 * done_, can_change_ ? "mended" : "improved (beside wedges, pyramids and pairs they are not adapted)"));
  }

  /// On the way, too, each time that something went by the length of an edge against the rest: nothing as thick as an
  /// element passes through another.
  void look_for_contact(double part) const {
    const auto looks =
        static_cast<int>(std::clamp(std::ceil(part * farthest_way() / shortest_length()), 1.0, kMostLooks));
    for (int i = 1; i <= looks; ++i) {
      context_.check();
      // Where elements are turned over on the way (points go straight, also around half a turn) their boundary says
      // nothing; at the end of the step none is.
      const std::vector<Vec3> points = points_after(part * i / looks);
      if (poorest(points) >= 0 && contact(points)) refuse_contact(part * (i - 1) / looks, part * i / looks);
    }
  }

  /// Of what is left, against the mean.
  double farthest_way() const {
    Vec3 mean;
    for (const Vec3& w : left_) mean += w / static_cast<double>(left_.size());
    double farthest = 0;
    for (const Vec3& w : left_) farthest = std::max(farthest, distance(w, mean));
    return farthest;
  }
  double shortest_length() const { return *std::min_element(lengths_.begin(), lengths_.end()); }

  /// The motion up to `free` is possible, that to `part` is not.
  [[noreturn]] void refuse_contact(double free, double part) const {
    Vec3 at = *contact(points_after(part));
    while ((part - free) * (1 - done_) > kContactFound) {
      const double middle = 0.5 * (free + part);
      const std::optional<Vec3> place = contact(points_after(middle));
      if (place) at = *place;
      (place ? part : free) = middle;
    }
    throw MeshingError(fmt::format("the body touches itself at {}: {:.1f} % of the motion is possible", at_point(at),
                                   100 * (done_ + free * (1 - done_))));
  }

  void mend() {
    const bool is_poor = poorest(made_.mesh.points) < options_.move.least_quality;
    const char* change = is_poor || (options_.size.size && can_change_) ? mended() : "moved";
    const QualitySummary quality = summarize_quality(made_.mesh);
    MoveStep step{done_, change, made_.mesh.tets.size(), quality.beta_min, quality.beta_mean, 0};
    for (const auto& [a, b, c, d] : made_.mesh.tets) {
      const auto& p = made_.mesh.points;
      step.volume += signed_volume(p[a], p[b], p[c], p[d]);
    }
    made_.history.push_back(std::move(step));
  }

  /// What was done in the end.
  const char* mended() {
    Improved better = improve_existing(made_.mesh, options_, nullptr, context_);
    take(std::move(better.mesh), nullptr);
    const bool is_enough = poorest(made_.mesh.points) >= options_.move.least_quality && !options_.size.size;
    if (is_enough || !can_change_) return "improved";
    if (!options_.move.remesh) {
      adapt();
      if (poorest(made_.mesh.points) >= kQualityOfSteps * options_.move.least_quality) return "adapted";
    }
    return remesh() ? "remeshed" : "adapted";
  }

  void adapt() {
    MetricMesh wanted{made_.mesh.points, made_.mesh.tets, {}, {}, "the lengths that the mesh had"};
    for (const double h : lengths_) wanted.metrics.push_back(Metric::of_size(h));
    AdaptedMesh adapted = adapt_to_metric(made_.mesh, wanted, options_, context_);
    const KnownItems same{adapted.old_of_new, adapted.old_tet_of_new};
    take(std::move(adapted.mesh), &same);
  }

  /// Whether it is better: the moved walls meshed anew.
  bool remesh() {
    Options options = options_;
    options.size = {}, options.layers = {};
    options.size.mesh = std::make_shared<SizeMesh>(
        SizeMesh{made_.mesh.points, made_.mesh.tets, {}, lengths_, {}, "the lengths that the mesh had"});
    try {
      TetMesh anew = meshed_anew(made_.mesh, options, context_);
      if (!options_.move.remesh && summarize_quality(anew).beta_min <= poorest(made_.mesh.points)) return false;
      tell_lost();
      take(std::move(anew), nullptr);
      return true;
    } catch (const MeshingError&) {
      if (options_.move.remesh) throw;
      return false;
    }
  }

  /// What domain_of() has no place for.
  void tell_lost() {
    std::string lost;
    const auto add = [&](const std::string& name) { lost += (lost.empty() ? "" : ", ") + name; };
    for (const std::string& name : made_.mesh.curve_names) add(name);
    for (const NamedSet& set : made_.mesh.sets)
      if (set.kind == NamedSet::Kind::kElements) add(set.name);
    if (lost.empty()) return;
    made_.notes.push_back(fmt::format(
        "meshed anew at {:.1f} % of the motion, and without these curves and sets of elements: {}", 100 * done_, lost));
  }

  void mark_wide() {
    is_wide_.assign(made_.mesh.tets.size(), 0);
    for (const WideCell& cell : made_.mesh.wide_cells)
      for (std::uint32_t i = 0; i < cell.tet_count; ++i) is_wide_[cell.first + i] = 1;
  }

  /// All that is known goes to another mesh of the body as it is now.
  void take(TetMesh now, const KnownItems* same) {
    std::vector<MeshField> all = made_.fields;
    MeshField left{"", false, 3, {}}, lengths{"", false, 1, lengths_};
    for (const Vec3& w : left_) left.values.insert(left.values.end(), {w.x, w.y, w.z});
    all.push_back(std::move(left)), all.push_back(std::move(lengths));
    all = carry_fields(all, made_.mesh, now, options_.carry, context_, OutsideNodes::kNearest, same).fields;
    lengths_ = std::move(all.back().values), all.pop_back();
    left_.resize(now.points.size());
    for (std::size_t v = 0; v < left_.size(); ++v)
      left_[v] = {all.back().values[3 * v], all.back().values[3 * v + 1], all.back().values[3 * v + 2]};
    all.pop_back();
    made_.fields = std::move(all), made_.mesh = std::move(now);
    mark_wide();
  }

  Options options_;
  const RunContext& context_;
  MovedMesh made_;
  std::vector<Vec3> left_;             ///< of the displacement of each point
  std::vector<double> lengths_;        ///< wanted at each point
  std::vector<std::uint8_t> is_wide_;  ///< per tet: of a wedge or pyramid
  bool can_change_ = true;             ///< by more than improvement
  double done_ = 0;
};

void require_movable(const TetMesh& mesh, std::span<const Vec3> displacement, bool boundary_alone,
                     const RunContext& context) {
  if (displacement.size() != mesh.points.size())
    throw InputError(
        fmt::format("there are {} displacements, and the mesh has {} points", displacement.size(), mesh.points.size()));
  std::vector<std::uint8_t> counts(displacement.size(), boundary_alone ? 0 : 1);
  for (const Triangle& face : mesh.boundary)
    for (const VertexIndex v : face)
      if (v < counts.size()) counts[v] = 1;
  for (std::size_t v = 0; v < displacement.size(); ++v)
    if (counts[v] && !is_finite(displacement[v]))
      throw InputError(fmt::format("the displacement of point {} is not finite", v));
  if (const auto defect = first_defect(mesh, context)) throw InputError("not a valid mesh: " + *defect);
  if (!mesh.split_faces.empty()) throw InputError("a mesh with split faces cannot be moved");
}

/// What the boundary encloses when all is done.
double volume_after(const TetMesh& mesh, std::span<const Vec3> displacement) {
  const VertexIndex first = mesh.boundary.front()[0];
  const Vec3 origin = mesh.points[first] + displacement[first];
  double sum = 0;
  for (const auto& [a, b, c] : mesh.boundary) {
    const auto at = [&](VertexIndex v) { return mesh.points[v] + displacement[v] - origin; };
    sum += dot(at(a), cross(at(b), at(c))) / 6;
  }
  return sum;
}

/// No way of mending helps, and trying would take long.
void refuse_flat(const TetMesh& mesh, std::span<const Vec3> displacement) {
  const double before = enclosed_volume(boundary_of(mesh)), after = volume_after(mesh, displacement);
  if (after > kFlat * before) return;
  throw MeshingError(
      fmt::format("the motion would press the body flat or turn it inside out: of its volume {:.6g} it leaves {:.3g}",
                  before, after));
}

}  // namespace

MovedMesh move_mesh(const TetMesh& mesh, std::span<const Vec3> displacement, std::span<const MeshField> fields,
                    const Options& options, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  require_movable(mesh, displacement, options.move.boundary_alone, context);
  refuse_flat(mesh, displacement);
  MovedMesh made = Mover(mesh, displacement, fields, options, context).move();
  for (std::size_t f = 0; f < fields.size(); ++f)
    made.carried.push_back(report_of_field(fields[f], mesh, made.fields[f], made.mesh, options.carry));
  return made;
}

}  // namespace octafront
