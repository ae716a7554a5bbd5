
#include "pipeline/stages/requirements.h"

#include <octafront/quality.h>
#include <octafront/requirement_error.h>

#include "base/core/parallel.h"
#include "base/core/wording.h"
#include "pipeline/stages/kept_volumes.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Elements below one of these are told of.
constexpr double kPoorBeta = 0.2, kPoorAngle = 10;
constexpr std::size_t kRange = 4096;

std::uint64_t elements_below(const TetMesh& mesh, double degrees) {
  const auto found = parallel_collect<TetIndex>(
      mesh.tets.size(), kRange, [&](std::size_t begin, std::size_t end, std::vector<TetIndex>& below) {
        for (std::size_t t = begin; t < end; ++t) {
          const auto& [a, b, c, d] = mesh.tets[t];
          const auto angles = dihedral_angles(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
          if (*std::ranges::min_element(angles) < degrees) below.push_back(static_cast<TetIndex>(t));
        }
      });
  return found.size();
}

Finding volume_finding(const VolumeChange& change, double percent) {
  Finding found;
  found.code = "require-volume";
  found.region = change.region;
  found.text =
      fmt::format("{} has {:.6g} of its volume of {:.6g} ({:+.3g} %), and `require_volume` is {:g} %",
                  change.region.empty() ? std::string("the mesh") : fmt::format("region \"{}\"", change.region),
                  change.made, change.before, 100 * change.part(), percent);
  found.values = {{"required_percent", percent},
                  {"change_percent", 100 * change.part()},
                  {"input_volume", change.before},
                  {"volume", change.made}};
  return found;
}

Finding angle_finding(const TetMesh& mesh, const QualitySummary& quality, double degrees) {
  const std::uint64_t below = elements_below(mesh, degrees);
  Finding found;
  found.code = "require-angle";
  found.text = fmt::format(
      "{} of {} elements have a dihedral angle below the {:g} degrees of `require_angle`; the "
      "least is {:.3g}, of element {} at {}",
      below, quality.elements, degrees, quality.dihedral_min, quality.dihedral_min_tet,
      at_point(quality.dihedral_min_at));
  found.values = {{"required_degrees", degrees},
                  {"dihedral_min_degrees", quality.dihedral_min},
                  {"elements", static_cast<double>(below)}};
  found.at = quality.dihedral_min_at;
  return found;
}

Finding size_finding(const LongestEdge& longest, double times) {
  Finding found;
  found.code = "require-size";
  found.text = fmt::format("an edge at {} is {:.3g} times as long as the size wanted there, and `require_size` is {:g}",
                           at_point(longest.at), longest.ratio, times);
  found.values = {{"required_ratio", times}, {"longest_ratio", longest.ratio}};
  found.at = longest.at;
  return found;
}

}  // namespace

bool requires_something(const RequireOptions& o) {
  return o.volume || o.angle || o.size;
}

void refuse_sizes_required(const RequireOptions& o, const char* why) {
  if (o.size) throw OptionError(fmt::format("`require_size`: {}", why));
}

std::optional<LongestEdge> longest_edge(const TetMesh& mesh, const SizeField& sizes, const RequireOptions& options) {
  if (!options.size) return std::nullopt;
  std::vector<LongestEdge> of_ranges((mesh.tets.size() + kRange - 1) / kRange);
  parallel_for(of_ranges.size(), [&](std::size_t r) {
    LongestEdge& longest = of_ranges[r];
    for (std::size_t t = r * kRange; t < std::min(mesh.tets.size(), (r + 1) * kRange); ++t)
      for (const auto& [i, j] : kTetEdges) {
        const Vec3 a = mesh.points[mesh.tets[t][i]], b = mesh.points[mesh.tets[t][j]];
        const double ratio = distance(a, b) / sizes.at((a + b) * 0.5);
        if (ratio > longest.ratio) longest = {ratio, (a + b) * 0.5};
      }
  });
  LongestEdge longest;
  for (const LongestEdge& one : of_ranges)
    if (one.ratio > longest.ratio) longest = one;
  return longest;
}

std::optional<LongestEdge> longest_edge(const MetricSummary& fit) {
  return LongestEdge{fit.longest, fit.longest_at};
}

void require_of(const TetMesh& mesh, const std::optional<LongestEdge>& longest, const RequireOptions& options,
                const Report& report) {
  std::vector<Finding> missed;
  if (options.volume)
    for (const VolumeChange& change : volume_changes(report))
      if (!(100 * std::abs(change.part()) <= *options.volume))
        missed.push_back(volume_finding(change, *options.volume));
  if (options.angle && report.quality.dihedral_min < *options.angle)
    missed.push_back(angle_finding(mesh, report.quality, *options.angle));
  if (options.size && longest && longest->ratio > *options.size)
    missed.push_back(size_finding(*longest, *options.size));
  if (missed.empty()) return;
  std::string words = "the mesh is valid, but not what is required:";
  for (const Finding& finding : missed) words += "\n  " + finding.text;
  Report made = report;
  StageReport& stage = made.stages.emplace_back();
  stage.name = "requirements";
  for (Finding& finding : missed) stage.note(std::move(finding));
  throw RequirementError(words, std::move(made));
}

void note_least(const Report& report, const Stage& stage, const PlaceOfElement& place) {
  const QualitySummary& q = report.quality;
  if (q.elements == 0 || (q.beta_min >= kPoorBeta && q.dihedral_min >= kPoorAngle)) return;
  Finding found;
  found.code = "poor-elements";
  found.text = fmt::format(
      "the least beta of the mesh is {:.2g}, of element {} at {}; its least dihedral angle {:.2g} "
      "degrees, of element {} at {}",
      q.beta_min, q.beta_min_tet, at_point(q.beta_min_at), q.dihedral_min, q.dihedral_min_tet,
      at_point(q.dihedral_min_at));
  found.values = {{"beta_min", q.beta_min},
                  {"dihedral_min_degrees", q.dihedral_min},
                  {"elements_below_beta_0.2", static_cast<double>(q.beta_classes[0])}};
  found.at = q.dihedral_min_at;
  if (const std::optional<NarrowPlace> narrow = place ? place(q.dihedral_min_tet) : std::nullopt) {
    found.text += ": " + narrow->words;
    found.values.emplace_back("input_degrees", narrow->degrees);
  }
  stage.note(std::move(found));
}

}  // namespace octafront
