#include "soup/cells/bodies.h"

#include <octafront/complex.h>
#include <octafront/repair.h>

#include "base/core/utf8.h"
#include "base/core/wording.h"
#include "soup/cells/close_gaps.h"
#include "soup/cells/labelled.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <queue>
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

/// Why a body cannot be used, with its name.
RepairedSurface repaired_body(const Body& body, const RunContext& context) {
  try {
    RepairedSurface repaired = repair_surface(body.surface, context);
    const SurfaceDefects defects = find_defects(repaired, context);
    if (!defects.clean()) throw InputError(defects.describe());
    return repaired;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", body.name, error.what()));
  }
}

Together put_together(const std::vector<Body>& bodies, Complex& complex, const RunContext& context) {
  Together all;
  std::uint32_t faces = 0;
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    const RepairedSurface repaired = repaired_body(bodies[b], context);
    for (const std::string& note : repaired.notes) complex.notes.push_back(fmt::format("{}: {}", bodies[b].name, note));
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

/// Cells of no body that are thinner than the tolerance go to the body that they share most of their walls with.
std::uint64_t fill_gaps(Labelled& labelled, double tolerance) {
  const std::vector<double> volumes = labelled.cells.volumes();
  std::vector<std::map<std::uint32_t, double>> shared(labelled.cells.count());
  std::vector<double> area(labelled.cells.count(), 0);
  for (std::size_t t = 0; t < labelled.arranged.triangles.size(); ++t) {
    const auto [front, back] = labelled.cells.sides_of(t);
    const auto [a, b, c] = labelled.arranged.triangles[t];
    const auto& p = labelled.arranged.points;
    const double size = length(cross(p[b] - p[a], p[c] - p[a])) / 2;
    const auto add = [&](std::uint32_t cell, std::uint32_t other) {
      area[cell] += size;
      if (labelled.region[other] != kNone) shared[cell][labelled.region[other]] += size;
    };
    add(front, back);
    add(back, front);
  }
  std::uint64_t filled = 0;
  for (std::uint32_t c = 1; c < labelled.cells.count(); ++c) {
    const bool thin = 2 * volumes[c] < tolerance * area[c];
    if (labelled.region[c] != kNone || !thin || shared[c].empty()) continue;
    labelled.region[c] = std::max_element(shared[c].begin(), shared[c].end(), [](const auto& x, const auto& y) {
                           return x.second < y.second;
                         })->first;
    ++filled;
  }
  return filled;
}

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
    words += fmt::format("{}\"{}\" takes {:.4g} from \"{}\"", i == 0 ? "" : ", ", bodies[pair.first].name, -volume,
                         bodies[pair.second].name);
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
    words += fmt::format("{}\"{}\" {:.4g}", r == bodies ? "" : ", ", labelled.names[r], volume);
  }
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

double tolerance_of_bodies(const ComplexOptions& options, const std::vector<Vec3>& points) {
  // Single precision keeps seven digits.
  constexpr double kOfDiagonal = 1e-6;
  Box3 box;
  for (const Vec3 p : points) box.add(p);
  return options.tolerance.value_or(kOfDiagonal * box.diagonal());
}

void note_changes(const cells::ClosedGaps& closed, double tolerance, const Arrangement& arranged,
                  std::vector<std::string>& notes) {
  if (closed.moved > 0)
    notes.push_back(fmt::format("{} moved onto earlier bodies within the tolerance of {:.3g}, by {:.3g} at most",
                                counted(closed.moved, "vertex", "vertices"), tolerance, closed.largest_move));
  if (arranged.new_points > 0)
    notes.push_back(fmt::format("faces divided where bodies meet, at {}", counted(arranged.new_points, "new point")));
}

}  // namespace

namespace cells {

Joined joined_bodies(const std::vector<Body>& bodies, const ComplexOptions& options, const RunContext& context) {
  using Overlap = ComplexOptions::Overlap;
  if (bodies.empty()) throw OptionError("there is no body to join");
  if (options.tolerance && !(*options.tolerance >= 0))
    throw OptionError(fmt::format("`tolerance` is {}; it must not be below 0", *options.tolerance));
  Complex before;
  Together all = put_together(bodies, before, context);
  const double tolerance = tolerance_of_bodies(options, all.points);
  ClosedGaps closed = close_gaps({all.points, all.triangles, all.body}, tolerance, context);
  const Arrangement arranged = arrange(closed.points, closed.triangles, context);
  const Cells cells(arranged.points, arranged.triangles, context);

  std::vector<std::uint32_t> body_of;
  for (const std::uint32_t t : closed.source) body_of.push_back(all.body[t]);
  const std::vector<Windings> windings = windings_of_bodies(arranged, cells, body_of);
  Labelled labelled{arranged, cells, {}, {}};
  for (const Body& b : bodies) labelled.names.push_back(b.name);
  labelled.region = regions_of(windings, options.overlap, labelled.names);
  const std::size_t end_of_common = labelled.names.size();
  if (options.within_first) empty_outside_first(windings, bodies, labelled);
  const std::uint64_t filled = fill_gaps(labelled, tolerance);
  const bool earlier = options.overlap == Overlap::kFirst;
  if (options.overlap != Overlap::kNew)
    refuse_covered_bodies(labelled, bodies, windings, earlier, options.within_first ? 1 : 0);
  apply_seeds(labelled, options);
  if (options.cells == ComplexOptions::Cells::kMerge)
    for (std::uint32_t& r : labelled.region)
      if (r != kNone) r = 0;

  Patches patches(bodies);
  Complex complex = complex_of(labelled, [&](std::size_t t, Sides sides) {
    const std::uint32_t face = closed.source[arranged.origins_of(t)[0].triangle];
    std::vector<std::uint32_t> around;
    for (const Origin& o : arranged.origins_of(t)) around.push_back(body_of[o.triangle]);
    std::string others;
    if (sides[0] != kNone) {
      // The other side's region, unless that is the body itself.
      const auto [front, back] = cells.sides_of(t);
      for (const std::uint32_t cell : {front, back})
        if (labelled.region[cell] != all.body[face]) {
          others = "_" + labelled.names[labelled.region[cell]];
          break;
        }
    }
    return Face{patches.patch_of(all.body[face], all.patch[face], others), all.source[face]};
  });
  complex.surface.patch_names = patches.names();
  // Said of the regions, from whose names these are made.
  NameCleaning().clean(complex.surface.patch_names);
  std::vector<std::string> notes = std::move(before.notes);
  note_changes(closed, tolerance, arranged, notes);
  if (filled > 0) notes.push_back(fmt::format("{} between bodies closed", counted(filled, "thin gap")));
  note_overlaps(labelled, windings, bodies, earlier ? "first" : "later", notes);
  note_common_regions(labelled, bodies.size(), end_of_common, notes);
  notes.insert(notes.end(), complex.notes.begin(), complex.notes.end());
  complex.notes = std::move(notes);
  return {std::move(complex), are_nested(windings)};
}

}  // namespace cells

Complex join_bodies(const std::vector<Body>& bodies, const ComplexOptions& options, const RunContext& context) {
  return cells::joined_bodies(bodies, options, context).complex;
}

}  // namespace octafront
