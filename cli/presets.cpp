#include "presets.h"

#include <algorithm>

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

}  // namespace

Options with_preset(const Arguments& a) {
  Options options = a.options;
  if (!a.preset) return options;
  const Choices choices = choices_of(*a.preset);
  const auto is_given = [&](const char* option) {
    return std::any_of(a.given.begin(), a.given.end(), [&](const auto& given) { return given.first == option; });
  };
  if (!is_given("automatic-factor")) options.size.automatic_factor = choices.automatic_factor;
  if (!is_given("improve")) options.improve.level = choices.level;
  return options;
}

}  // namespace octafront::cli
