#include <octafront/error.h>

#include "base/mesh/index_range.h"
#include "sizing/size_sources.h"

#include <cmath>

#include <fmt/core.h>

namespace octafront {

namespace {

void require(bool holds, const std::string& sentence) {
  if (!holds) throw OptionError(sentence);
}

void require_positive(const char* name, const std::optional<double>& value) {
  require(!value || (std::isfinite(*value) && *value > 0),
          fmt::format("`{}` must be a number above 0, but is {}", name, value.value_or(0)));
}

}  // namespace

void check_size_options(const SizeOptions& o) {
  require_positive("size", o.size);
  require_positive("gap", o.gap);
  require_positive("max_deviation", o.chord_error);
  require_positive("feature_elements", o.feature_elements);
  require_positive("min_size", o.min_size);
  require_positive("max_size", o.max_size);
  require(!o.elements || *o.elements >= 1,
          fmt::format("`elements` must be at least 1, but is {}", o.elements.value_or(0)));
  require(!o.elements || *o.elements <= kMostElements,
          fmt::format("`elements` is {}, but a mesh can hold {} at most", o.elements.value_or(0), kMostElements));
  require(!(o.size && o.elements), "`size` and `elements` contradict each other: give one of them");
  require(!o.curvature || (std::isfinite(*o.curvature) && *o.curvature >= 3),
          fmt::format("`curvature` counts elements per full turn and must be at least 3, but is {}",
                      o.curvature.value_or(0)));
  require(!(o.min_size && o.max_size) || *o.min_size <= *o.max_size,
          fmt::format("`min_size` {} is larger than `max_size` {}", o.min_size.value_or(0), o.max_size.value_or(0)));
  require(!(o.size && o.min_size) || *o.size >= *o.min_size,
          fmt::format("`size` {} is smaller than `min_size` {}", o.size.value_or(0), o.min_size.value_or(0)));
  require(!(o.size && o.max_size) || *o.size <= *o.max_size,
          fmt::format("`size` {} is larger than `max_size` {}", o.size.value_or(0), o.max_size.value_or(0)));
  require(o.automatic_factor >= 0.1 && o.automatic_factor <= 10,
          fmt::format("`automatic_factor` must lie in [0.1, 10], but is {}", o.automatic_factor));
  const bool has_source = o.size || o.elements || o.curvature || o.gap || o.feature_elements || o.facets ||
                          o.min_size || o.max_size || !o.regions.empty() || !o.point_sizes.empty() ||
                          !o.named.empty() || o.callback;
  require(!(o.field && has_source),
          "a size grid is all there is to say about the sizes: no other source or limit of sizes can be given with it");
  for (const NamedSize& n : o.named)
    require(std::isfinite(n.size) && n.size > 0,
            fmt::format("the size of \"{}\" must be a number above 0, but is {}", n.name, n.size));
  for (const PointSize& s : o.point_sizes) {
    require(is_finite(s.p) && std::isfinite(s.size) && s.size > 0,
            fmt::format("the size {} at the point ({}, {}, {}) must be above 0, at a finite place", s.size, s.p.x,
                        s.p.y, s.p.z));
  }
  for (const SizeRegion& r : o.regions) {
    require(is_finite(r.lo) && is_finite(r.hi) && r.lo.x <= r.hi.x && r.lo.y <= r.hi.y && r.lo.z <= r.hi.z,
            fmt::format("the region from ({}, {}, {}) to ({}, {}, {}) is no box", r.lo.x, r.lo.y, r.lo.z, r.hi.x,
                        r.hi.y, r.hi.z));
    require(
        std::isfinite(r.size) && r.size > 0 && std::isfinite(r.radius) && r.radius >= 0,
        fmt::format("the region at ({}, {}, {}) has size {} and radius {}: the size must be above 0, the radius not "
                    "below",
                    r.lo.x, r.lo.y, r.lo.z, r.size, r.radius));
  }
  require(o.gradation >= 0.01 && o.gradation <= 1,
          fmt::format("`gradation` is {}: it must lie between 0.01 (slow growth) and 1 (fast)", o.gradation));
}

}  // namespace octafront
