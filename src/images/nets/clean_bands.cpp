#include "images/nets/net_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace octafront::nets {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float below(double limit) {
  return std::nextafter(static_cast<float>(limit), -kInfinity);
}

float at_least(double limit) {
  const auto v = static_cast<float>(limit);
  return static_cast<double>(v) < limit ? std::nextafter(v, kInfinity) : v;
}

bool is_in(const GreyBand& band, float v) {
  return band.lo <= static_cast<double>(v) && static_cast<double>(v) < band.hi;
}

float into(const GreyBand& band, float v) {
  return static_cast<double>(v) < band.lo ? at_least(band.lo) : below(band.hi);
}

/// The value nearest to `v` that is in no band.
float out_of(const std::vector<GreyBand>& bands, float v) {
  float best = v;
  double nearest = std::numeric_limits<double>::infinity();
  const auto consider = [&](double limit, float value) {
    const bool is_free = std::none_of(bands.begin(), bands.end(), [&](const GreyBand& b) { return is_in(b, value); });
    const double away = std::abs(limit - static_cast<double>(v));
    if (!is_free || !std::isfinite(limit) || away >= nearest) return;
    nearest = away;
    best = value;
  };
  for (const GreyBand& b : bands) {
    consider(b.lo, below(b.lo));
    consider(b.hi, at_least(b.hi));
  }
  return best;
}

}  // namespace

Image cleaned_bands(const Image& image, const std::vector<GreyBand>& bands, const CleanOptions& clean,
                    const RunContext& context) {
  const LabelImage before = labels_of_bands(image, bands);
  LabelImage after = cleaned(before, clean, context);
  std::vector<float> values =
      std::visit([](const auto& all) { return std::vector<float>(all.begin(), all.end()); }, image.values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (before.regions[i] == after.regions[i]) continue;
    const bool leaves = after.regions[i] == LabelImage::kNoRegion;
    values[i] = leaves ? out_of(bands, values[i])
                       : into(bands[static_cast<std::size_t>(after.labels[after.regions[i]].value)], values[i]);
  }
  return {image.grid, std::move(values), std::move(after.notes), image.format, image.unit, image.frame, {}};
}

}  // namespace octafront::nets
