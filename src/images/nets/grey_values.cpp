#include "images/nets/grey_values.h"

#include <octafront/error.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

namespace octafront::nets {

BandLimits::BandLimits(const std::vector<GreyBand>& bands) {
  if (bands.empty()) throw InputError("no band of grey values is given");
  if (bands.size() >= LabelImage::kNoRegion) throw InputError(fmt::format("{} bands are too many", bands.size()));
  std::vector<Label> order(bands.size());
  for (std::size_t b = 0; b < bands.size(); ++b) {
    order[b] = static_cast<Label>(b);
    if (!(bands[b].lo < bands[b].hi))
      throw InputError(
          fmt::format("the band \"{}\" from {:g} to {:g} has no values", bands[b].name, bands[b].lo, bands[b].hi));
  }
  std::sort(order.begin(), order.end(), [&](Label a, Label b) { return bands[a].lo < bands[b].lo; });
  label_.push_back(LabelImage::kNoRegion);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const GreyBand& band = bands[order[i]];
    if (i > 0 && band.lo < bands[order[i - 1]].hi)
      throw InputError(fmt::format("the bands \"{}\" and \"{}\" overlap: values from {:g} on are in both",
                                   bands[order[i - 1]].name, band.name, band.lo));
    const bool follows = i > 0 && band.lo == bands[order[i - 1]].hi;
    if (std::isinf(band.lo) || follows) {
      label_.back() = order[i];
    } else {
      limits_.push_back(band.lo);
      label_.push_back(order[i]);
    }
    if (std::isinf(band.hi)) continue;
    limits_.push_back(band.hi);
    label_.push_back(LabelImage::kNoRegion);
  }
}

std::size_t BandLimits::rank(double value) const {
  return static_cast<std::size_t>(std::upper_bound(limits_.begin(), limits_.end(), value) - limits_.begin());
}

double BandLimits::between(std::size_t a, std::size_t b) const {
  return limits_[(a + b - 1) / 2];
}

double GreyValues::at(Corner voxel) const {
  for (int a = 0; a < 3; ++a) voxel[a] = std::clamp(voxel[a], 0, lattice_.size(a) - 1);
  const std::size_t i = lattice_.number(voxel[0], voxel[1], voxel[2]);
  return std::visit([i](const auto& values) { return static_cast<double>(values[i]); }, values_);
}

GreyValues::Sample GreyValues::near(const Corner& c, Vec3 p) const {
  Vec3 share, width;
  for (int a = 0; a < 3; ++a) {
    const double lo = lattice_.middle(a, c[a] - 1);
    width[a] = lattice_.middle(a, c[a]) - lo;
    share[a] = std::clamp((p[a] - lo) / width[a], 0.0, 1.0);
  }
  Sample sample{0, {}};
  for (int o = 0; o < 8; ++o) {
    const std::array<int, 3> upper = {o & 1, o >> 1 & 1, o >> 2 & 1};
    const double value = at({c[0] - 1 + upper[0], c[1] - 1 + upper[1], c[2] - 1 + upper[2]});
    const auto weight = [&](int a) { return upper[a] != 0 ? share[a] : 1 - share[a]; };
    sample.value += value * weight(0) * weight(1) * weight(2);
    for (int a = 0; a < 3; ++a)
      sample.gradient[a] += (upper[a] != 0 ? value : -value) / width[a] * weight((a + 1) % 3) * weight((a + 2) % 3);
  }
  return sample;
}

}  // namespace octafront::nets
