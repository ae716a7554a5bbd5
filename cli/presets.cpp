#include "presets.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace octafront::cli {

namespace {

/// What a preset is made of.
struct Choices {
  double automatic_factor;  ///< a quarter of the elements, or eight times as many
  ImproveOptions::Level level;
};

Choices choices_of(Preset preset) {
  switch (preset) {
    case Preset::kDraft:
      return {1.6, ImproveOptions::Level::kFast};
    case Preset::kFine:
      return {0.5, ImproveOptions::Level::kBest};
    default:
      return {1, ImproveOptions::Level::kDefault};
  }
}

bool is_given(const Arguments& a, const char* option) {
  return std::any_of(a.given.begin(), a.given.end(), [&](const auto& given) { return given.first == option; });
}

/// Sizes by thickness, mm, as charm of SimNIBS has them: grey matter and scalp by themselves, and all others.
struct Tissue {
  std::int64_t label;
  std::array<std::string_view, 4> names;  ///< that a region may have, in lower case, or begin with
  double least, most, of_thickness;
};
constexpr std::int64_t kScalp = 5;
constexpr std::array kTissues{Tissue{2, {"gm", "grey", "gray", "cortex"}, 1, 2, 1},
                              Tissue{kScalp, {"scalp", "skin", "", ""}, 1, 10, .6}};
constexpr Tissue kOtherTissue{0, {}, 1, 5, 1};
constexpr double kMostOnSkin = 2, kMostInside = 10, kStrays = .5;

const Tissue& tissue_of(const SurfaceMesh& surface, std::size_t region) {
  const std::string name = CLI::detail::to_lower(surface.region_names[region]);
  const bool has_name = !name.starts_with("label ");
  for (const Tissue& tissue : kTissues) {
    const auto begins = [&](std::string_view n) { return !n.empty() && name.starts_with(n); };
    const bool is_label = region < surface.region_labels.size() && surface.region_labels[region] == tissue.label;
    if (has_name ? std::ranges::any_of(tissue.names, begins) : is_label) return tissue;
  }
  return kOtherTissue;
}

}  // namespace

void add_sizes_of_head(const Arguments& a, const Domain& domain, Options& options) {
  if (a.preset != Preset::kHead) return;
  const double voxel = domain.voxel_spacing;
  SizeOptions& sizes = options.size;
  if (!sizes.size && !sizes.elements) sizes.size = std::max(kMostInside, voxel);
  if (!sizes.gap) sizes.gap = .01;  // thickness speaks for layers
  if (!options.surface.max_deviation) options.surface.max_deviation = kStrays * std::max(1.0, voxel);
  for (std::size_t r = 0; r < domain.surface.region_names.size(); ++r) {
    const std::string& name = domain.surface.region_names[r];
    if (std::ranges::any_of(sizes.named, [&](const NamedSize& n) { return n.name == name; })) continue;
    const Tissue& tissue = tissue_of(domain.surface, r);
    const double least = std::max(tissue.least, voxel);
    sizes.named.push_back({name, least, tissue.of_thickness, std::max(tissue.most, least)});
    if (tissue.label == kScalp) sizes.named.push_back({"patches:" + name, std::max(kMostOnSkin, voxel)});
  }
}

Options with_preset(const Arguments& a) {
  Options options = a.options;
  if (!a.preset || *a.preset == Preset::kHead) return options;
  const Choices choices = choices_of(*a.preset);
  if (!is_given(a, "automatic-factor")) options.size.automatic_factor = choices.automatic_factor;
  if (!is_given(a, "improve")) options.improve.level = choices.level;
  return options;
}

}  // namespace octafront::cli
