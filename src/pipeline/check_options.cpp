#include <octafront/error.h>
#include <octafront/generate.h>

#include <fmt/format.h>

namespace octafront {

namespace {

void require(bool holds, const std::string& sentence) {
  if (!holds) throw OptionError(sentence);
}

void check_size(const SizeOptions& o) {
  const auto positive = [](const char* name, const std::optional<double>& value) {
    require(!value || (std::isfinite(*value) && *value > 0), fmt::format("{} must be a number above 0", name));
  };
  positive("size", o.size);
  positive("gap", o.gap);
  positive("min-size", o.min_size);
  positive("max-size", o.max_size);
  require(!o.elements || *o.elements > 0, "elements must be above 0");
  require(!(o.size && o.elements), "size and elements contradict each other: give one of them");
  require(!o.curvature || (std::isfinite(*o.curvature) && *o.curvature >= 3),
          "curvature counts elements per full turn and must be at least 3");
  require(!(o.min_size && o.max_size) || *o.min_size <= *o.max_size,
          fmt::format("min-size {} is larger than max-size {}", o.min_size.value_or(0), o.max_size.value_or(0)));
  require(!(o.size && o.min_size) || *o.size >= *o.min_size,
          fmt::format("size {} is smaller than min-size {}", o.size.value_or(0), o.min_size.value_or(0)));
  require(o.gradation >= 0.01 && o.gradation <= 1,
          fmt::format("grading {} is out of range: it lies between 0.01 (slow) and 1 (fast)", o.gradation));
}

}  // namespace

void check_options(const Options& options) {
  check_size(options.size);
  require(options.surface.feature_angle > 0 && options.surface.feature_angle < 180,
          "feature-angle is in degrees, between 0 and 180");
  require(!options.surface.max_deviation || *options.surface.max_deviation > 0,
          "max-deviation is a distance in the units of the input, above 0");
  require(options.volume.ideal_distance >= 0.4 && options.volume.ideal_distance <= 1.5,
          "ideal-distance is a multiple of the element size, between 0.4 and 1.5");
  require(options.improve.relaxation > 0 && options.improve.relaxation <= 1,
          "relaxation must be above 0 and at most 1");
  require(options.improve.sweeps >= 0, "sweeps must not be negative");
}

}  // namespace octafront
