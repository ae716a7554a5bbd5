#include <octafront/error.h>
#include <octafront/generate.h>

#include "improve/schedule/schedule.h"
#include "pipeline/stages/layered.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/periodic.h"
#include "pipeline/stages/requirements.h"
#include "pipeline/stages/shell.h"
#include "sizing/sources/check_size_options.h"

#include <cmath>

namespace octafront {

namespace {

void require(bool holds, const char* sentence) {
  if (!holds) throw OptionError(sentence);
}

}  // namespace

void check_options(const Options& options) {
  check_size_options(options.size);
  const SurfaceOptions& surface = options.surface;
  require(surface.angle_of_features() > 0 && surface.angle_of_features() < 180,
          "`feature_angle` is in degrees, between 0 and 180");
  require(!surface.max_deviation || (std::isfinite(*surface.max_deviation) && *surface.max_deviation >= 0),
          "`max_deviation` is a distance in the units of the input, not below 0");
  require(!surface.normal_deviation || (*surface.normal_deviation > 0 && *surface.normal_deviation <= 90),
          "`normal_deviation` is in degrees, above 0 and at most 90");
  require(!(keeps_surface(options) && (surface.max_deviation || surface.normal_deviation)),
          "a surface that is kept does not deviate: `max_deviation` and `normal_deviation` cannot be given with it");
  require(!surface.volume_tolerance || (std::isfinite(*surface.volume_tolerance) && *surface.volume_tolerance > 0),
          "`volume_tolerance` is in percent of a volume, above 0");
  require(
      !surface.volume_tolerance || (!keeps_surface(options) && traits_of(options.method).has_front),
      "`volume_tolerance` makes elements of the surface smaller: it cannot be given where the input's triangles are "
      "kept, nor with a method that makes no surface of its own sizes");
  require(options.volume.ideal_distance >= 0.3 && options.volume.ideal_distance <= 1.5,
          "`ideal_distance` is a multiple of the element size, between 0.3 and 1.5");
  check_layer_options(options);
  check_shell_options(options);
  check_periodic_options(options);
  check_improve_options(options.improve);
  check_requirements(options.require);
  require(options.adapt.halo >= 0 && options.adapt.halo <= 100, "`halo` is a number of layers, from 0 to 100");
  require(options.order == 1 || options.order == 2, "`order` is 1 for linear elements or 2 for those of second order");
  require(!(surface.keep && traits_of(options.method).makes_own_boundary()),
          "the octree method makes a boundary of its own: it cannot keep the input's triangles");
}

}  // namespace octafront
