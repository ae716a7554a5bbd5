#include "soup/cells/bodies.h"

#include <octafront/complex.h>
#include <octafront/repair.h>

#include "base/core/elementary.h"
#include "base/core/utf8.h"
#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "base/geometry/self_intersection.h"
#include "base/mesh/complex.h"
#include "soup/cells/cell_steps.h"
#include "soup/cells/labelled.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace octafront {
namespace {

using cells::Labelled;

/// All bodies in one soup: `body` and `patch` per triangle.
struct Together {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> body, patch, source;
};

/// Shells of one file have no names.
std::string name_of(const std::vector<Body>& bodies, std::uint32_t b) {
  return bodies[b].name.empty() ? fmt::format("shell {}", b + 1) : bodies[b].name;
}

/// Why a body cannot be used, with its name.
RepairedSurface repaired_body(const Body& body, const RunContext& context) {
  try {
    RepairedSurface repaired = repair_surface(body.surface, context);
    const SurfaceDefects defects = find_defects(repaired, context);
    if (!defects.clean()) throw DefectsError(fmt::format("{}: {}", body.name, defects.describe()), defects);
    return repaired;
  } catch (const DefectsError&) {
    throw;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", body.name, error.what()));
  }
}

Together put_together(const std::vector<Body>& bodies, Complex& complex, const RunContext& context) {
  Together all;
  std::uint32_t faces = 0;
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    const RepairedSurface repaired = repaired_body(bodies[b], context);
    for (const std::string& note : repaired.notes)
      complex.notes.push_back(fmt::format("{}: {}", name_of(bodies, b), note));
    const auto first = static_cast<VertexIndex>(all.points.size());
    all.points.insert(all.points.end(), repaired.surface.points.begin(), repaired.surface.points.end());
    for (std::size_t t = 0; t < repaired.surface.triangles.size(); ++t) {
      const auto [p, q, r] = repaired.surface.triangles[t];
      all.triangles.push_back({first + p, first + q, first + r});
      all.body.push_back(b);
      all.patch.push_back(repaired.surface.patch_of(t));
      all.source.push_back(faces + bodies[b].surface.source_of(repaired.surface.source_of(t)));
    }
    faces += static_cast<std::uint32_t>(bodies[b].surface.triangles.size());
  }
  return all;
}

std::vector<std::string> names_of(const std::vector<std::uint32_t>& bodies, const std::vector<std::string>& names) {
  std::vector<std::string> some;
  for (const std::uint32_t b : bodies) some.push_back(names[b]);
  return some;
}

/// How often each body winds around each cell; bodies that do not are left out.
using Windings = std::map<std::uint32_t, int>;

std::vector<Windings> windings_of_bodies(const Arrangement& arranged, const Cells& cells,
                                         const std::vector<std::uint32_t>& body) {
  std::vector<std::vector<std::uint32_t>> walls(cells.count());
  for (std::uint32_t t = 0; t < arranged.triangles.size(); ++t)
    for (const std::uint32_t c : cells.sides_of(t)) walls[c].push_back(t);
  std::vector<Windings> windings(cells.count());
  std::vector<char> seen(cells.count(), 0);
  std::queue<std::uint32_t> queue({0});
  seen[0] = 1;
  while (!queue.empty()) {
    const std::uint32_t c = queue.front();
    queue.pop();
    for (const std::uint32_t t : walls[c]) {
      const auto [front, back] = cells.sides_of(t);
      const std::uint32_t other = front == c ? back : front;
      if (seen[other]) continue;
      seen[other] = 1;
      windings[other] = windings[c];
      // A step from the front to the back of an outward triangle leads inside.
      for (const Origin& o : arranged.origins_of(t)) {
        int& w = windings[other][body[o.triangle]];
        w += (front == c) != o.reversed ? 1 : -1;
        if (w == 0) windings[other].erase(body[o.triangle]);
      }
      queue.push(other);
    }
  }
  return windings;
}

/// Which region each cell goes to; those of several bodies together follow the bodies, and their names `names`.
std::vector<std::uint32_t> regions_of(const std::vector<Windings>& windings, ComplexOptions::Overlap overlap,
                                      std::vector<std::string>& names) {
  const std::vector<std::string> of_bodies = names;
  std::map<std::vector<std::uint32_t>, std::uint32_t> together;
  std::vector<std::uint32_t> region;
  for (const Windings& w : windings) {
    std::vector<std::uint32_t> around;
    for (const auto& [body, times] : w)
      if (times > 0) around.push_back(body);
    if (around.size() < 2 || overlap != ComplexOptions::Overlap::kNew) {
      const bool first = overlap == ComplexOptions::Overlap::kFirst;
      region.push_back(around.empty() ? kNone : first ? around.front() : around.back());
      continue;
    }
    const auto [at, is_new] = together.try_emplace(around, static_cast<std::uint32_t>(names.size()));
    if (is_new) names.push_back(fmt::format("{}", fmt::join(names_of(around, of_bodies), "&")));
    region.push_back(at->second);
  }
  return region;
}

/// Cells thinner than the misfit of the bodies around them are nobody's: walls of later bodies give way there, so that
/// the wall of the earliest one is left.
class Slivers {
 public:
  /// `place`: of each body, by which the earliest one is found.
  Slivers(Labelled& labelled, const std::vector<Windings>& windings, const std::vector<std::uint32_t>& body,
          const std::vector<std::uint32_t>& place, const cells::Misfits& misfits)
      : labelled_(labelled),
        windings_(windings),
        body_(body),
        place_(place),
        misfits_(misfits),
        walls_(labelled.cells.count()) {
    for (std::uint32_t t = 0; t < labelled.arranged.triangles.size(); ++t)
      for (const std::uint32_t c : labelled.cells.sides_of(t)) walls_[c].push_back(t);
  }

  /// Which cells these are, how many changed hands, and their volume.
  struct Given {
    std::vector<char> is_sliver;  ///< per cell
    std::uint64_t count = 0;
    double volume = 0;
  };
  Given give_away() {
    const std::vector<double> volumes = labelled_.cells.volumes();
    const std::vector<char> is_body = cells_that_are_bodies(volumes);
    std::vector<char> waits(labelled_.cells.count(), 0);
    Given given;
    for (std::uint32_t c = 1; c < waits.size(); ++c) {
      if (is_body[c]) continue;
      double area = 0;
      for (const std::uint32_t t : walls_[c]) area += area_of(t);
      waits[c] = 2 * volumes[c] < reach_around(c) * area;
    }
    given.is_sliver = waits;
    for (bool any = true; any;) {
      any = false;
      std::vector<std::pair<std::uint32_t, std::uint32_t>> settled;
      for (std::uint32_t c = 1; c < waits.size(); ++c)
        if (waits[c])
          if (const std::optional<std::uint32_t> r = region_beyond(c, waits)) settled.emplace_back(c, *r);
      for (const auto& [c, r] : settled) {
        any = true;
        waits[c] = 0;
        if (labelled_.region[c] == r) continue;
        labelled_.region[c] = r;
        ++given.count;
        given.volume += volumes[c];
      }
    }
    return given;
  }

 private:
  double area_of(std::uint32_t t) const {
    return triangle_area(labelled_.arranged.points, labelled_.arranged.triangles[t]);
  }

  /// Cells that are most of a body: however thin it is, it stays.
  std::vector<char> cells_that_are_bodies(const std::vector<double>& volumes) const {
    std::map<std::uint32_t, double> whole;
    for (std::uint32_t c = 1; c < volumes.size(); ++c)
      for (const auto& [b, times] : windings_[c]) whole[b] += volumes[c];
    std::vector<char> are(volumes.size(), 0);
    for (std::uint32_t c = 1; c < volumes.size(); ++c)
      are[c] = std::ranges::any_of(windings_[c], [&](const auto& w) { return 2 * volumes[c] > whole[w.first]; });
    return are;
  }

  std::vector<std::uint32_t> bodies_around(std::uint32_t c) const {
    std::vector<std::uint32_t> around;
    for (const std::uint32_t t : walls_[c])
      for (const Origin& o : labelled_.arranged.origins_of(t)) around.push_back(body_[o.triangle]);
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    return around;
  }

  /// The largest misfit of two bodies around a cell, one of which has it, if any has.
  double reach_around(std::uint32_t c) const {
    const std::vector<std::uint32_t> around = bodies_around(c);
    double most = 0;
    for (const std::uint32_t a : around)
      for (const std::uint32_t b : around) {
        if (a == b) continue;
        if (!windings_[c].empty() && !windings_[c].contains(a) && !windings_[c].contains(b)) continue;
        most = std::max(most, misfits_.reach(a, b));
      }
    return most;
  }

  /// The region across most of the walls that are not the earliest body's; of walls to cells that are settled.
  std::optional<std::uint32_t> region_beyond(std::uint32_t c, const std::vector<char>& waits) const {
    const std::vector<std::uint32_t> around = bodies_around(c);
    const std::uint32_t earliest = *std::ranges::min_element(around, {}, [&](std::uint32_t b) { return place_[b]; });
    std::map<std::uint32_t, double> areas;
    for (const std::uint32_t t : walls_[c]) {
      const auto origins = labelled_.arranged.origins_of(t);
      if (std::any_of(origins.begin(), origins.end(), [&](const Origin& o) { return body_[o.triangle] == earliest; }))
        continue;
      const auto [front, back] = labelled_.cells.sides_of(t);
      const std::uint32_t other = front == c ? back : front;
      if (!waits[other]) areas[labelled_.region[other]] += area_of(t);
    }
    if (areas.empty()) return std::nullopt;
    return std::max_element(areas.begin(), areas.end(),
                            [](const auto& x, const auto& y) { return x.second < y.second; })
        ->first;
  }

  Labelled& labelled_;
  const std::vector<Windings>& windings_;
  const std::vector<std::uint32_t>& body_;
  const std::vector<std::uint32_t>& place_;
  const cells::Misfits& misfits_;
  std::vector<std::vector<std::uint32_t>> walls_;  ///< per cell
};

/// Only what lies in the first body stays.
void empty_outside_first(const std::vector<Windings>& windings, const std::vector<Body>& bodies, Labelled& labelled) {
  for (std::size_t c = 0; c < windings.size(); ++c) {
    const auto first = windings[c].find(0);
    if (first == windings[c].end() || first->second <= 0) labelled.region[c] = kNone;
  }
  for (std::uint32_t b = 1; b < bodies.size(); ++b) {
    const bool is_in = std::any_of(windings.begin(), windings.end(),
                                   [&](const Windings& w) { return w.contains(0) && w.contains(b); });
    if (!is_in)
      throw InputError(
          fmt::format("{}: lies outside of {}, and nothing of it is left", bodies[b].name, bodies[0].name));
  }
}

/// From body `first` on.
void refuse_covered_bodies(const Labelled& labelled, const std::vector<Body>& bodies,
                           const std::vector<Windings>& windings, bool earlier, std::uint32_t first) {
  const char* others = earlier ? "earlier" : "later";
  for (std::uint32_t b = first; b < bodies.size(); ++b) {
    if (std::find(labelled.region.begin(), labelled.region.end(), b) != labelled.region.end()) continue;
    std::uint32_t by = kNone;
    for (std::size_t c = 0; c < windings.size(); ++c)
      if (windings[c].contains(b)) by = labelled.region[c];
    throw InputError(
        fmt::format("{}: nothing of it is left, for {} bodies lie over all of it{}; {} ones have their way: give it {} "
                    "them, or leave one out",
                    bodies[b].name, others, by < bodies.size() ? fmt::format(" (as {} does)", bodies[by].name) : "",
                    others, earlier ? "before" : "behind"));
  }
}

/// Names the bodies that share space, those with most of it first. `who`: has its way.
void note_overlaps(const Labelled& labelled, const std::vector<Windings>& windings, const std::vector<Body>& bodies,
                   const char* who, std::vector<std::string>& notes) {
  const std::vector<double> volumes = labelled.cells.volumes();
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> shared;  // by who has it, and who would have had it
  for (std::size_t c = 0; c < windings.size(); ++c)
    for (const auto& [body, times] : windings[c])
      if (times > 0 && body != labelled.region[c] && labelled.region[c] < bodies.size())
        shared[{labelled.region[c], body}] += volumes[c];
  if (shared.empty()) return;
  std::vector<std::pair<double, std::pair<std::uint32_t, std::uint32_t>>> pairs;
  for (const auto& [pair, volume] : shared) pairs.emplace_back(-volume, pair);
  std::sort(pairs.begin(), pairs.end());
  constexpr std::size_t kMostNamed = 5;
  std::string words;
  for (std::size_t i = 0; i < std::min(kMostNamed, pairs.size()); ++i) {
    const auto& [volume, pair] = pairs[i];
    words += fmt::format("{}\"{}\" takes {:.4g} from \"{}\"", i == 0 ? "" : ", ", name_of(bodies, pair.first), -volume,
                         name_of(bodies, pair.second));
  }
  if (pairs.size() > kMostNamed) words += fmt::format(" and {} more pairs", pairs.size() - kMostNamed);
  notes.push_back(fmt::format("bodies overlap, and the {} one has its way, by volume: {}", who, words));
}

/// Says which regions are what bodies share.
void note_common_regions(const Labelled& labelled, std::size_t bodies, std::size_t end,
                         std::vector<std::string>& notes) {
  if (end == bodies) return;
  const std::vector<double> volumes = labelled.cells.volumes();
  std::string words;
  for (std::size_t r = bodies; r < end; ++r) {
    double volume = 0;
    for (std::size_t c = 0; c < volumes.size(); ++c)
      if (labelled.region[c] == r) volume += volumes[c];
    if (volume == 0) continue;
    words += fmt::format("{}\"{}\" {:.4g}", words.empty() ? "" : ", ", labelled.names[r], volume);
  }
  if (words.empty()) return;
  notes.push_back("bodies overlap, and what they share are regions of their own, by volume: " + words);
}

/// Whether of two bodies that share cells one always has all of its cells in common with the other.
bool are_nested(const std::vector<Windings>& windings) {
  std::map<std::uint32_t, std::size_t> cells_of;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> shared;
  for (const Windings& w : windings)
    for (auto a = w.begin(); a != w.end(); ++a) {
      ++cells_of[a->first];
      for (auto b = std::next(a); b != w.end(); ++b) ++shared[{a->first, b->first}];
    }
  return std::all_of(shared.begin(), shared.end(), [&](const auto& pair) {
    return pair.second == std::min(cells_of[pair.first.first], cells_of[pair.first.second]);
  });
}

/// Patches of the outside by body, of interfaces by both bodies; a body's own patches keep their names.
class Patches {
 public:
  explicit Patches(const std::vector<Body>& bodies) : bodies_(bodies) {}

  std::uint32_t patch_of(std::uint32_t body, std::uint32_t own, const std::string& others) {
    const auto& names = bodies_[body].surface.patch_names;
    std::string name = bodies_[body].name + others;
    if (!bodies_[body].surface.patch.empty())
      name += own < names.size() && !names[own].empty() ? "/" + names[own] : fmt::format("/patch_{}", own + 1);
    const auto [at, is_new] = number_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.push_back(name);
    return at->second;
  }
  std::vector<std::string> names() { return std::move(names_); }

 private:
  const std::vector<Body>& bodies_;
  std::map<std::string, std::uint32_t> number_;
  std::vector<std::string> names_;
};

/// Walls that became one, the farthest apart first.
std::string in_words(const cells::Misfits& misfits, const std::vector<Body>& bodies) {
  std::vector<std::pair<double, std::pair<std::uint32_t, std::uint32_t>>> pairs;
  for (const auto& [pair, d] : misfits.all())
    if (d > misfits.floor()) pairs.push_back({-d, pair});
  std::sort(pairs.begin(), pairs.end());
  constexpr std::size_t kMostNamed = 5;
  std::string words;
  for (std::size_t i = 0; i < std::min(kMostNamed, pairs.size()); ++i)
    words +=
        fmt::format("{}\"{}\" and \"{}\" up to {:.3g} apart", i == 0 ? "" : ", ",
                    name_of(bodies, pairs[i].second.first), name_of(bodies, pairs[i].second.second), -pairs[i].first);
  if (pairs.size() > kMostNamed) words += fmt::format(" and {} more pairs", pairs.size() - kMostNamed);
  return words;
}

/// What the bodies' own walls enclose, before and behind.
double moved_volume(const Together& all, const cells::ClosedGaps& closed, std::size_t bodies) {
  std::vector<SurfaceMesh> before(bodies), behind(bodies);
  for (std::size_t t = 0; t < all.triangles.size(); ++t) before[all.body[t]].triangles.push_back(all.triangles[t]);
  for (std::size_t t = 0; t < closed.triangles.size(); ++t)
    behind[all.body[closed.source[t]]].triangles.push_back(closed.triangles[t]);
  double moved = 0;
  for (std::size_t b = 0; b < bodies; ++b) {
    before[b].points = all.points;
    behind[b].points = closed.points;
    moved += std::abs(enclosed_volume(behind[b]) - enclosed_volume(before[b]));
    before[b] = behind[b] = {};
  }
  return moved;
}

bool lexicographic_order(Vec3 a, Vec3 b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// What one body's vertices and edges left on another's wall goes: the wall has its own triangles again.
void dissolve_imprints(Complex& complex, const Together& all, const cells::Misfits& misfits,
                       const RunContext& context) {
  if (misfits.largest() <= misfits.floor()) return;
  std::vector<Vec3> given = all.points;
  std::sort(given.begin(), given.end(), lexicographic_order);
  const auto dissolve_within = [&](double most) {
    std::vector<char> may_go;
    for (const Vec3 p : complex.surface.points)
      may_go.push_back(!std::binary_search(given.begin(), given.end(), p, lexicographic_order));
    return cells::dissolve(complex.surface, may_go, most, context) > 0;
  };
  // Walls that came together have moved by far more; those that lie on flat walls go first.
  constexpr double kOfMisfit = 0.05;
  bool any = false;
  for (const double most : {misfits.floor(), kOfMisfit * misfits.largest()}) any = dissolve_within(most) || any;
  if (!any) return;
  complex.volumes = volumes_of_regions(complex.surface);
}

void note_changes(const cells::ClosedGaps& closed, const std::string& walls, const std::string& stays, double moved,
                  double floor, const Arrangement& arranged, std::vector<std::string>& notes) {
  if (!walls.empty())
    notes.push_back(
        fmt::format("walls of bodies that nearly touch are one, those of {}: {}; that moved "
                    "{}{:.3g} of volume; `tolerance` 0 leaves all as it is",
                    stays, walls,
                    closed.moved == 0 ? ""
                                      : fmt::format("{} by {:.3g} at most, and ",
                                                    counted(closed.moved, "vertex", "vertices"), closed.largest_move),
                    moved));
  else if (closed.moved > 0)
    notes.push_back(fmt::format("{} moved onto earlier bodies within the tolerance of {:.3g}, by {:.3g} at most",
                                counted(closed.moved, "vertex", "vertices"), floor, closed.largest_move));
  if (arranged.new_points > 0)
    notes.push_back(fmt::format("faces divided where bodies meet, at {}", counted(arranged.new_points, "new point")));
}

}  // namespace

namespace cells {

namespace {

/// What is joined, and what counts as one wall.
struct Joining {
  const std::vector<Body>& bodies;
  const ComplexOptions& options;
  const Together& all;
  const Misfits& misfits;
  const RunContext& context;
};

/// The bodies as one complex, and how well their walls have come together.
struct JoinedWay {
  Complex complex;
  std::uint64_t crossings = 0;
  WallShape shape;
  bool is_sound() const { return crossings == 0 && shape.has_no_wedge(); }
};

/// Walls that come together cross at the edges of their contacts: about one pair of triangles in two. Where more pairs
/// do, in parts of the number of triangles, they have come together crumpled, and to arrange that takes minutes for
/// nothing; those that are left as they are may cross more.
constexpr double kEnoughCross = 1, kCrumpled = 2;

struct WayTogether {
  const Misfits* near;  ///< which walls do
  Rims rims;
  std::vector<std::uint32_t> place;  ///< of each body: walls of earlier ones stay
  std::string stays;                 ///< whose walls these are
  double may_cross = kEnoughCross;   ///< it is given up where more pairs do, in parts of the number of triangles
};
const std::string kEarlier = "the earlier body", kCoarser = "the coarser body";

std::vector<std::uint32_t> as_given(const Misfits& misfits) {
  std::vector<std::uint32_t> place(misfits.bodies());
  std::iota(place.begin(), place.end(), 0);
  return place;
}

ClosedGaps closed_by(const WayTogether& way, const Together& all, const RunContext& context) {
  std::vector<std::uint32_t> place;
  for (const std::uint32_t b : all.body) place.push_back(way.place[b]);
  return close_gaps({all.points, all.triangles, place}, way.near->renumbered(way.place), way.rims, context);
}

/// Whether walls of more than so many pairs meet otherwise than by sharing vertices, edges and whole triangles.
bool cross_each_other(const ClosedGaps& closed, double part, const RunContext& context) {
  std::set<Triangle> known;
  std::vector<Triangle> each;
  for (const Triangle& t : closed.triangles) {
    Triangle sorted = t;
    std::sort(sorted.begin(), sorted.end());
    if (known.insert(sorted).second) each.push_back(t);
  }
  const auto most = static_cast<std::size_t>(part * static_cast<double>(each.size()));
  return self_intersections(closed.points, each, most + 1, context).size() > most;
}

/// Nobody overlaps in them any more.
void clear_slivers(const Slivers::Given& slivers, std::vector<Windings>& windings) {
  for (std::size_t c = 0; c < windings.size(); ++c)
    if (slivers.is_sliver[c]) windings[c].clear();
}

/// Walls that are near come together; what lies between others that belong together is given away as slivers.
JoinedWay joined_by(const WayTogether& way, const Joining& joining) {
  using Overlap = ComplexOptions::Overlap;
  const auto& [bodies, options, all, misfits, context] = joining;
  const ClosedGaps closed = closed_by(way, all, context);
  const bool is_divided = closed.triangles.size() > all.triangles.size();
  if ((is_divided || way.may_cross == 0) && cross_each_other(closed, way.may_cross, context))
    throw InputError("walls of bodies that nearly touch crumple where they come together");
  const Arrangement arranged = arrange(closed.points, closed.triangles, context);
  const Cells cells(arranged.points, arranged.triangles, context);

  std::vector<std::uint32_t> body_of;
  for (const std::uint32_t t : closed.source) body_of.push_back(all.body[t]);
  std::vector<Windings> windings = windings_of_bodies(arranged, cells, body_of);
  Labelled labelled{arranged, cells, {}, {}};
  labelled.has_sheets = false;
  for (const Body& b : bodies) labelled.names.push_back(b.name);
  labelled.region = regions_of(windings, options.overlap, labelled.names);
  const std::size_t end_of_common = labelled.names.size();
  if (options.within_first) empty_outside_first(windings, bodies, labelled);
  const Slivers::Given slivers = Slivers(labelled, windings, body_of, way.place, misfits).give_away();
  clear_slivers(slivers, windings);
  const bool earlier = options.overlap == Overlap::kFirst;
  if (options.overlap != Overlap::kNew)
    refuse_covered_bodies(labelled, bodies, windings, earlier, options.within_first ? 1 : 0);
  apply_seeds(labelled, options);
  if (options.cells == ComplexOptions::Cells::kMerge)
    for (std::uint32_t& r : labelled.region)
      if (r != kNone) r = 0;

  Patches patches(bodies);
  Complex complex = complex_of(labelled, [&, &soup = joining.all](std::size_t t, Sides sides) {
    const std::uint32_t face = closed.source[arranged.origins_of(t)[0].triangle];
    std::string others;
    if (sides[0] != kNone) {
      // The other side's region, unless that is the body itself.
      const auto [front, back] = cells.sides_of(t);
      for (const std::uint32_t cell : {front, back})
        if (labelled.region[cell] != soup.body[face]) {
          others = "_" + labelled.names[labelled.region[cell]];
          break;
        }
    }
    return Face{patches.patch_of(soup.body[face], soup.patch[face], others), soup.source[face]};
  });
  dissolve_imprints(complex, all, misfits, context);
  complex.surface.patch_names = patches.names();
  // Said of the regions, from whose names these are made.
  NameCleaning().clean(complex.surface.patch_names);
  std::vector<std::string> notes;
  const double moved = slivers.volume + moved_volume(all, closed, bodies.size());
  note_changes(closed, in_words(misfits, bodies), way.stays, moved, misfits.floor(), arranged, notes);
  if (slivers.count > 0) notes.push_back(fmt::format("{} between bodies closed", counted(slivers.count, "thin gap")));
  note_overlaps(labelled, windings, bodies, earlier ? "first" : "later", notes);
  note_common_regions(labelled, bodies.size(), end_of_common, notes);
  notes.insert(notes.end(), complex.notes.begin(), complex.notes.end());
  complex.notes = std::move(notes);
  const WallShape shape = shape_of_walls(complex.surface);
  return {std::move(complex), arranged.new_points, shape};
}

/// Whether bodies that come together by so little have their volumes, and so did not overlap.
bool keep_their_volumes(const Complex& complex, const std::vector<Body>& bodies, double moved) {
  if (complex.volumes.size() != bodies.size()) return false;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const SurfaceMesh& body = bodies[b].surface;
    if (!(std::abs(complex.volumes[b] - std::abs(enclosed_volume(body))) <= moved * area(body))) return false;
  }
  return true;
}

/// Whether edges became much shorter than all that were given, as where bodies end a little deeper in each other.
bool has_new_short_edges(const JoinedWay& way, const Together& all) {
  constexpr double kMuchShorter = 0.5;
  double given = HUGE_VAL;
  for (const Triangle& t : all.triangles)
    for (int i = 0; i < 3; ++i) given = std::min(given, distance(all.points[t[i]], all.points[t[(i + 1) % 3]]));
  return way.shape.shortest < kMuchShorter * given;
}

/// The sine of the narrowest wedge of bodies by themselves; joined, some have that part of it.
double own_wedge(const Together& all) {
  SurfaceMesh before;
  before.points = all.points, before.triangles = all.triangles;
  return shape_of_walls(before).narrowest;
}
constexpr double kAsNarrow = 0.9;

/// Bodies that fit as they are, but for what is nearer than `within`: with wedges that they have by themselves only, as
/// their last digits change them.
std::optional<JoinedWay> fitting_within(double within, double own, const Joining& joining, double size) {
  const Together& all = joining.all;
  const MisfitLimits limits{within, size};
  const Misfits close({all.points, all.triangles, all.body}, limits, joining.context);
  try {
    JoinedWay way = joined_by({&close, Rims::kBend, as_given(close), kEarlier, 0},
                              {joining.bodies, joining.options, all, close, joining.context});
    const Complex& complex = way.complex;
    if (way.shape.narrowest >= kAsNarrow * own && !has_new_short_edges(way, all) &&
        keep_their_volumes(complex, joining.bodies, within) && !leave_gaps(complex.surface, joining.misfits))
      return way;
  } catch (const InputError&) {
  }
  return std::nullopt;
}

/// Bodies that fit but for the last digits of their coordinates, as cells of a foam do: there, what looks like facets
/// of a curve apart from another is a wedge where three cells meet.
std::optional<JoinedWay> fitting_way(const Joining& joining, double size) {
  const double own = own_wedge(joining.all);
  // Parts of the size: with six digits, or four, of what has ten elements across.
  for (const double last_digits : {1e-4, 1e-3}) {
    const double within = std::min(last_digits * size, joining.options.tolerance.value_or(HUGE_VAL));
    if (std::optional<JoinedWay> way = fitting_within(within, own, joining, size)) return way;
  }
  return std::nullopt;
}

/// Orders of bodies in which the walls of earlier ones may stay: as they are given; the coarsest first; and if that is
/// no great work all others, as the one that is right depends on where facets of each lie.
std::vector<std::pair<std::vector<std::uint32_t>, std::string>> orders_of(const Joining& joining) {
  constexpr std::size_t kMostBodies = 3, kMostTriangles = 20'000;
  const std::vector<std::uint32_t> given = as_given(joining.misfits), coarsest = joining.misfits.coarsest_first();
  std::vector<std::pair<std::vector<std::uint32_t>, std::string>> orders{{given, kEarlier}};
  if (coarsest != given) orders.emplace_back(coarsest, kCoarser);
  if (given.size() > kMostBodies || joining.all.triangles.size() > kMostTriangles) return orders;
  for (std::vector<std::uint32_t> place = given; std::ranges::next_permutation(place).found;) {
    if (place == coarsest) continue;
    std::vector<std::string> names(place.size());
    for (std::uint32_t b = 0; b < place.size(); ++b)
      names[place[b]] = fmt::format("\"{}\"", name_of(joining.bodies, b));
    orders.emplace_back(place, fmt::format("{}", fmt::join(names, " before ")));
  }
  return orders;
}

/// Ways in which bodies may come together, the best of those that were tried, and what their volumes are if none does.
class WaysTogether {
 public:
  explicit WaysTogether(const Joining& joining) : joining_(joining), apart_(joining.misfits.without_contacts()) {}

  /// Walls of fine facets are best brought together whole. Coarse ones that come to them may cross in vain then:
  /// another order is better, or all are left where they are.
  JoinedWay best() {
    for (const auto& [place, stays] : orders_of(joining_))
      for (const Rims rims : {Rims::kBend, Rims::kKeep})
        if (is_good({&joining_.misfits, rims, place, stays})) return std::move(*best_);
    if (const JoinedWay* apart = joined_apart(); apart && is_better(*apart)) return std::move(*unmoved_);
    if (!best_) return joined_by(way_apart(), joining_);
    return std::move(*best_);
  }

 private:
  bool is_good(const WayTogether& way) {
    try {
      JoinedWay joined = joined_by(way, joining_);
      if (!keeps_volumes(joined) || !is_better(joined)) return false;
      best_ = std::move(joined);
    } catch (const InputError&) {
      return false;
    }
    return best_->is_sound() && !has_new_short_edges(*best_, joining_.all);
  }

  bool is_better(const JoinedWay& way) const {
    const auto rank = [](const JoinedWay& w) { return std::pair(w.is_sound(), w.shape.worth()); };
    return !best_ || rank(way) > rank(*best_);
  }

  /// Whether no body has become another one, in a tangle of walls. What others take of it as they lie they do.
  bool keeps_volumes(const JoinedWay& way) {
    const double misfit = joining_.misfits.largest();
    if (keep_their_volumes(way.complex, joining_.bodies, misfit)) return true;
    const JoinedWay* apart = joined_apart();
    if (!apart) return true;
    const std::vector<double>&now = way.complex.volumes, &was = apart->complex.volumes;
    if (now.size() != was.size()) return false;
    for (std::size_t b = 0; b < std::min(now.size(), joining_.bodies.size()); ++b)
      if (std::abs(now[b] - was[b]) > misfit * area(joining_.bodies[b].surface)) return false;
    return true;
  }

  WayTogether way_apart() const { return {&apart_, Rims::kBend, as_given(joining_.misfits), kEarlier, kCrumpled}; }
  /// nullptr: they cannot be.
  const JoinedWay* joined_apart() {
    if (!std::exchange(is_apart_known_, true)) {
      try {
        unmoved_ = joined_by(way_apart(), joining_);
      } catch (const InputError&) {
      }
    }
    return unmoved_ ? &*unmoved_ : nullptr;
  }

  const Joining& joining_;
  const Misfits apart_;
  std::optional<JoinedWay> best_, unmoved_;
  bool is_apart_known_ = false;
};

/// `size`: of elements to come.
JoinedWay best_way(const Joining& joining, double size) {
  const Misfits& misfits = joining.misfits;
  if (misfits.largest() <= misfits.floor())
    return joined_by({&misfits, Rims::kBend, as_given(misfits), kEarlier, kCrumpled}, joining);
  if (std::optional<JoinedWay> fitting = fitting_way(joining, size)) return std::move(*fitting);
  return WaysTogether(joining).best();
}

/// Where walls did not come together well, and of which regions.
std::string place_in_words(const Complex& complex, const Edge& at) {
  std::set<std::string> names;
  const SurfaceMesh& surface = complex.surface;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& c = surface.triangles[t];
    if (std::ranges::find(c, at[0]) == c.end() || std::ranges::find(c, at[1]) == c.end()) continue;
    for (const std::uint32_t r : surface.sides_of(t))
      if (r < surface.region_names.size()) names.insert(fmt::format("\"{}\"", surface.region_names[r]));
  }
  return fmt::format("near {}, beside {}", at_point((surface.points[at[0]] + surface.points[at[1]]) / 2),
                     fmt::join(names, " and "));
}

/// What is left between walls that could not come together whole.
void note_unsound(const JoinedWay& way, std::vector<std::string>& notes) {
  const WallShape& shape = way.shape;
  const double cosine = std::sqrt(1 - shape.narrowest * shape.narrowest);
  const double degrees = elementary::atan2(shape.narrowest, cosine) * 180 / std::numbers::pi;
  notes.push_back(
      fmt::format("walls of bodies that nearly touch could not be made one everywhere: {} are left, the worst {}, and "
                  "poor elements "
                  "there; facets that fit each other, or finer ones of the coarser body, mend that",
                  shape.has_no_wedge() ? fmt::format("edges down to {:.2g}", shape.shortest)
                                       : fmt::format("wedges down to {:.2g} degrees", degrees),
                  place_in_words(way.complex, shape.at)));
}

}  // namespace

namespace {

/// Whether of two bodies that have space in common as they are given, slivers apart, one always lies within the other.
bool lie_in_each_other(const Joining& joining) {
  const auto& [bodies, options, all, misfits, context] = joining;
  const Arrangement arranged = arrange(all.points, all.triangles, context);
  const Cells cells(arranged.points, arranged.triangles, context);
  std::vector<Windings> windings = windings_of_bodies(arranged, cells, all.body);
  Labelled labelled{arranged, cells, {}, {}};
  for (const Body& b : bodies) labelled.names.push_back(b.name);
  labelled.region = regions_of(windings, options.overlap, labelled.names);
  clear_slivers(Slivers(labelled, windings, all.body, as_given(misfits), misfits).give_away(), windings);
  return are_nested(windings);
}

/// `nested_only`: else nullopt, before walls are brought together.
std::optional<Complex> join(const std::vector<Body>& bodies, const ComplexOptions& options,
                            const ElementsToCome& elements, bool nested_only, const RunContext& context) {
  if (bodies.empty()) throw OptionError("there is no body to join");
  if (options.tolerance && !(*options.tolerance >= 0))
    throw OptionError(fmt::format("`tolerance` is {}; it must not be below 0", *options.tolerance));
  Complex before;
  const Together all = put_together(bodies, before, context);
  const MisfitLimits limits = limits_for(options, elements, bodies);
  const Misfits misfits({all.points, all.triangles, all.body}, limits, context);
  const Joining joining{bodies, options, all, misfits, context};
  if (nested_only && !lie_in_each_other(joining)) return std::nullopt;
  JoinedWay best = best_way(joining, limits.size);
  std::vector<std::string>& notes = best.complex.notes;
  const bool is_narrower = best.shape.narrowest < kAsNarrow * own_wedge(all);
  if (misfits.largest() > misfits.floor() && !best.is_sound() && (is_narrower || has_new_short_edges(best, all)))
    note_unsound(best, notes);
  notes.insert(notes.begin(), before.notes.begin(), before.notes.end());
  return std::move(best.complex);
}

}  // namespace

std::optional<Complex> nested_bodies(const std::vector<Body>& bodies, const ComplexOptions& options,
                                     const ElementsToCome& elements, const RunContext& context) {
  return join(bodies, options, elements, true, context);
}

Complex join_bodies(const std::vector<Body>& bodies, const ComplexOptions& options, const ElementsToCome& elements,
                    const RunContext& context) {
  return *join(bodies, options, elements, false, context);
}

}  // namespace cells

Complex join_bodies(const std::vector<Body>& bodies, const ComplexOptions& options, const RunContext& context) {
  return cells::join_bodies(bodies, options, {}, context);
}

}  // namespace octafront
