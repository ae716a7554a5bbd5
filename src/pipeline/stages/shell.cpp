#include "pipeline/stages/shell.h"

#include <octafront/error.h>

#include "base/core/elementary.h"
#include "base/mesh/labels.h"
#include "layers/through.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/stages.h"
#include "sizing/field/expected_tets.h"

#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront {

namespace {

constexpr std::uint32_t kMostShellLayers = 100;
/// Two layers make so many elements of one; more of them by this power of their number.
constexpr double kTimesOfTwo = 2.1, kPowerOfLayers = 2.55;

void require_for_shell(bool holds, const char* sentence) {
  if (!holds) throw OptionError(sentence);
}

}  // namespace

void check_shell_options(const Options& options) {
  const std::uint32_t shell = options.volume.shell;
  if (shell == 0) return;
  if (shell == 1 || shell > kMostShellLayers)
    throw OptionError(fmt::format("`shell` is {}: it counts layers through walls, from 2 to {}; 0: as they come", shell,
                                  kMostShellLayers));
  require_for_shell(options.layers.count == 0, "`shell` and `layers` both make layers at walls: give one of them");
  require_for_shell(!keeps_surface(options),
                    "`shell` divides the rims of walls, so the input's triangles cannot be kept as they are");
  require_for_shell(
      !traits_of(options.method).makes_own_boundary(),
      "`shell` needs elements that reach from one side of a wall to the other, which the octree method does not make");
}

double expected_shell_tets(const Remeshed& made, std::uint32_t layers) {
  if (layers < 2) return 0;
  const double times = kTimesOfTwo * elementary::pow(layers / 2.0, kPowerOfLayers);
  return (times - 1) * expected_tets_through_walls(made.sizes, made.surface);
}

void layer_walls(Filled& filled, Run& run) {
  const std::uint32_t shell = run.options.volume.shell;
  if (shell == 0) return;
  run.stage("layers through walls", [&](const Stage& stage) {
    auto& [mesh, boundary, grown, tets] = filled;
    std::vector<layers::Span> spans = layers::spans_through_walls(mesh, stage.context());
    stage.count("edges through walls", static_cast<double>(spans.size()));
    if (spans.empty()) {
      stage.note(
          fmt::format("no edge reaches through a wall: all walls have two elements through them at least, and "
                      "`shell` {} changes nothing",
                      shell));
      return;
    }
    std::vector<std::uint32_t> parent;
    layers::SplitSpans split = layers::split_spans(mesh, std::move(spans), shell, boundary.surface, boundary.features,
                                                   parent, stage.context());
    boundary.source = of_items(boundary.source, parent);
    const layers::ThinnedOut thinned =
        layers::thin_out(mesh, boundary.surface.points.size(), std::move(split.level), stage.context());
    stage.count("elements through walls", static_cast<double>(split.elements));
    stage.count("elements in their place", static_cast<double>(split.made));
    stage.count("nodes collapsed", static_cast<double>(thinned.collapsed));
    stage.count("nodes moved", static_cast<double>(thinned.moved));
    stage.count("tets", static_cast<double>(mesh.tets.size()));
  });
}

}  // namespace octafront
