#include <octafront/error.h>
#include <octafront/image_surface.h>

#include "core/thread_limit.h"
#include "core/wording.h"
#include "nets/assemble.h"
#include "nets/fairing.h"
#include "nets/label_sizes.h"
#include "nets/settle.h"
#include "nets/volumes.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront {

namespace {

using nets::Lattice;

void check(const LabelImage& image) {
  const ImageGrid& grid = image.grid;
  constexpr std::uint32_t kLongest = 1u << 30;
  for (const std::uint32_t n : grid.size)
    if (n == 0 || n > kLongest) throw InputError(fmt::format("an image has {} voxels along an axis", n));
  if (image.regions.size() != grid.voxels())
    throw InputError(fmt::format("{} labels are given for {} voxels", image.regions.size(), grid.voxels()));
  if (!grid.slices.empty() && grid.slices.size() != grid.size[2])
    throw InputError(fmt::format("{} places are given for {} slices", grid.slices.size(), grid.size[2]));
  for (std::size_t k = 1; k < grid.slices.size(); ++k)
    if (!(grid.slices[k] > grid.slices[k - 1]))
      throw InputError(fmt::format("slice {} does not lie behind the one before it", k));
  const double volume = dot(cross(grid.axes[0], grid.axes[1]), grid.axes[2]);
  if (!is_finite(grid.origin) || !std::isfinite(volume) || volume == 0)
    throw InputError("the axes of the image do not span space: look at its affine map");
  bool any = false;
  for (const std::uint16_t r : image.regions) {
    if (r == LabelImage::kNoRegion) continue;
    any = true;
    if (r >= image.labels.size())
      throw InputError(fmt::format("a voxel has label {}, but there are only {}", r, image.labels.size()));
  }
  if (!any) throw InputError("no voxel has a label that is to be meshed");
}

std::vector<std::string> names_of(const LabelImage& image) {
  std::vector<std::string> names;
  for (const LabelImage::Label& label : image.labels) names.push_back(label.name);
  return names;
}

// The smallest labels would have to leave their voxels' cells to keep their volume.
constexpr std::uint64_t kFewVoxels = 8;

void note_what_was_done(const nets::Settled& settled, Complex& complex) {
  if (settled.moved_back > 0)
    complex.notes.push_back(
        fmt::format("{} of the surfaces between labels less smooth than others, where they would cross",
                    counted(settled.moved_back, "vertex", "vertices")));
  if (settled.joined > 0)
    complex.notes.push_back(
        fmt::format("labels touch themselves or each other in {} where their surfaces found no room",
                    counted(settled.joined, "point")));
}

}  // namespace

Complex complex_of_labels(const LabelImage& image, const LabelSurfaceOptions& options, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  check(image);
  context.check();
  const Lattice lattice(image.grid, image.regions);
  nets::Net net = nets::make_net(lattice);
  context.check();
  const Groups<> quads_at = nets::quads_at_vertices(net);
  const nets::Stencils stencils(net, quads_at);
  const nets::LabelSizes sizes(lattice, image.labels.size());
  std::vector<Vec3> x = net.start;
  if (options.smooth) {
    const nets::VertexCells cells(lattice, net, sizes.voxels);
    nets::fair(stencils, cells, x, context);
    std::vector<double> wanted = sizes.volume;
    for (std::size_t l = 0; l < wanted.size(); ++l)
      if (sizes.voxels[l] < kFewVoxels) wanted[l] = -1;
    if (options.keep_volumes) nets::keep_volumes(net, quads_at, cells, lattice, wanted, x, context);
  }
  nets::Settled settled = nets::settle(net, quads_at, stencils, lattice, x, context);
  Complex complex = nets::assemble(net, lattice, std::move(settled.world), x, names_of(image));
  note_what_was_done(settled, complex);
  return complex;
}

}  // namespace octafront
