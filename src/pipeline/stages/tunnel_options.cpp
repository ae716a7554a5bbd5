#include <octafront/domain.h>
#include <octafront/options.h>
#include <octafront/units.h>

#include "pipeline/stages/true_shape.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>

namespace octafront {

namespace {

/// Edges on a body in a wind tunnel that nobody gave a size, in its lengths, and far away in those of the tunnel.
constexpr double kOnBody = 1.0 / 40, kFar = 1.0 / 12;
constexpr double kGradation = 0.2, kStrayOfSize = 0.1;

double longest_side(const Box3& box) {
  const Vec3 extent = box.hi - box.lo;
  return std::max({extent.x, extent.y, extent.z});
}

/// Names of the body's patches that lie in the flow; each once.
std::set<std::string> names_of_body(const Domain& domain) {
  std::set<std::string> names;
  for (const std::uint32_t p : domain.surface.patch)
    if (p < domain.body_patches && !domain.surface.patch_names[p].empty()) names.insert(domain.surface.patch_names[p]);
  return names;
}

void take_body_sizes(const Domain& domain, Options& options) {
  SizeOptions& sizes = options.size;
  if (sizes.elements || sizes.field || sizes.mesh || sizes.callback || !sizes.point_sizes.empty()) return;
  const double h = sizes.size.value_or(kOnBody * domain.body_length);
  for (const std::string& name : names_of_body(domain)) sizes.named.push_back({name, h});
  sizes.size = std::max(h, kFar * longest_side(bounding_box(domain.surface.points)));
  // The far size may not decide how far the body strays, and which of its details give way.
  if (!options.surface.max_deviation) options.surface.max_deviation = kStrayOfSize * h;
  sizes.interior = SizeOptions::Interior::kGraded;
  if (!sizes.gradation) sizes.gradation = kGradation;
}

/// The Reynolds number of a flow that is given by its speed.
void take_reynolds(const Domain& domain, LayersOptions& layers) {
  const LengthUnit* unit = unit_named(domain.unit);
  const double metres = unit != nullptr ? unit->metres : 1;
  if (!layers.reference_length)
    layers.reference_length =
        domain.body_length > 0 ? domain.body_length : longest_side(bounding_box(domain.surface.points));
  layers.reynolds = *layers.speed * *layers.reference_length * metres / viscosity_of(layers.fluid);
}

}  // namespace

Options options_for_flow(const Domain& domain, Options options) {
  if (domain.body_patches > 0) {
    take_body_sizes(domain, options);
    if (options.layers.count > 0 && options.layers.on.empty())
      for (const std::string& name : names_of_body(domain))
        options.layers.on += (options.layers.on.empty() ? "" : ",") + name;
  }
  if (options.layers.yplus && options.layers.speed) take_reynolds(domain, options.layers);
  return options;
}

}  // namespace octafront
