#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/option_table.h>

#include "pipeline/stages/layered.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/periodic.h"
#include "pipeline/stages/shell.h"
#include "sizing/sources/make_size_field.h"

namespace octafront {

namespace {

void require(bool holds, const char* sentence) {
  if (!holds) throw OptionError(sentence);
}

}  // namespace

void check_options(const Options& options) {
  check_ranges(options);
  check_size_options(options.size);
  const SurfaceOptions& surface = options.surface;
  require(!(keeps_surface(options) && (surface.max_deviation || surface.normal_deviation)),
          "a surface that is kept does not deviate: `max_deviation` and `normal_deviation` cannot be given with it");
  require(
      !surface.volume_tolerance || (!keeps_surface(options) && traits_of(options.method).has_front),
      "`volume_tolerance` makes elements of the surface smaller: it cannot be given where the input's triangles are "
      "kept, nor with a method that makes no surface of its own sizes");
  check_layer_options(options);
  check_shell_options(options);
  check_periodic_options(options);
  require(!(surface.keep && traits_of(options.method).makes_own_boundary()),
          "the octree method makes a boundary of its own: it cannot keep the input's triangles");
}

}  // namespace octafront
