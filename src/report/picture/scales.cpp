
#include "report/picture/scales.h"

#include "base/core/elementary.h"
#include "base/core/parallel.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront {

namespace {

template <class Mesh>
SizeRange range_of_sizes(const Mesh& mesh, std::size_t n) {
  SizeRange range{HUGE_VAL, 0};
  for (std::size_t i = 0; i < n; ++i) {
    const double size = mean_edge(mesh, i);
    if (size > 0 && std::isfinite(size)) range = {std::min(range.least, size), std::max(range.most, size)};
  }
  return range.most > 0 ? range : SizeRange{};
}

template <std::size_t N>
std::vector<Rgb> as_list(const std::array<Rgb, N>& stops) {
  return {stops.begin(), stops.end()};
}

}  // namespace

double SizeRange::share(double size) const {
  if (!(size > least)) return 0;
  // Of about one size all are one colour, the middle one.
  constexpr double kOneSize = 1.0001;
  if (most <= kOneSize * least) return 0.5;
  return elementary::log(size / least) / elementary::log(most / least);
}

double mean_edge(const TetMesh& mesh, std::size_t tet) {
  double sum = 0;
  for (const auto& [i, j] : kTetEdges) sum += distance(mesh.points[mesh.tets[tet][i]], mesh.points[mesh.tets[tet][j]]);
  return sum / 6;
}

double mean_edge(const SurfaceMesh& surface, std::size_t triangle) {
  const Triangle& v = surface.triangles[triangle];
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += distance(surface.points[v[i]], surface.points[v[(i + 1) % 3]]);
  return sum / 3;
}

SizeRange size_range(const TetMesh& mesh) {
  return range_of_sizes(mesh, mesh.tets.size());
}

SizeRange size_range(const SurfaceMesh& surface) {
  return range_of_sizes(surface, surface.triangles.size());
}

std::vector<std::uint64_t> counts_in_parts(std::span<const double> values) {
  constexpr std::size_t kParts = 40;
  std::vector<std::uint64_t> counts(kParts, 0);
  for (const double value : values)
    ++counts[value > 0 ? std::min(kParts - 1, static_cast<std::size_t>(std::min(value, 1.0) * kParts)) : 0];
  return counts;
}

void quality_legend(Legend& legend, std::vector<std::uint64_t> counts) {
  legend.title = "quality β";
  legend.bar = as_list(kPoorToGood);
  for (int tenth = 0; tenth <= 10; tenth += 2)
    legend.ticks.emplace_back(0.1 * tenth, fmt::format("{:.1f}", 0.1 * tenth));
  legend.counts = std::move(counts);
}

void size_legend(Legend& legend, const SizeRange& sizes, const std::string& unit) {
  legend.title = unit.empty() ? "edge length" : fmt::format("edge length, {}", unit);
  legend.bar = as_list(kSmallToLarge);
  constexpr int kTicks = 4;
  for (int k = 0; k <= kTicks; ++k) {
    const double share = static_cast<double>(k) / kTicks;
    legend.ticks.emplace_back(share,
                              fmt::format("{:.3g}", sizes.least * elementary::pow(sizes.most / sizes.least, share)));
  }
}

void list_marks(Legend& legend, std::span<const std::string> marks) {
  for (std::uint32_t k = 0; k < marks.size(); ++k) legend.swatches.emplace_back(marks[k], colour_of_mark(k));
}

void list_parts(Scene& scene, PictureOptions::Color color) {
  std::vector<char> is_there(scene.part_names.size(), 0);
  for (const SceneFace& face : scene.faces)
    if (face.part != kNone && face.part < is_there.size()) is_there[face.part] = 1;
  scene.legend.title = color == PictureOptions::Color::kRegion ? "regions" : "patches";
  for (std::uint32_t p = 0; p < is_there.size(); ++p)
    if (is_there[p]) scene.legend.swatches.emplace_back(scene.part_names[p], colour_of_part(p));
}

std::string in_groups(std::uint64_t number) {
  const std::string plain = fmt::format("{}", number);
  std::string digits;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (i > 0 && (plain.size() - i) % 3 == 0) digits += ',';
    digits += plain[i];
  }
  return digits;
}

}  // namespace octafront
