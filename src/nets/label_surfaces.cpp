#include <octafront/image_surface.h>

#include "core/thread_limit.h"
#include "nets/assemble.h"
#include "nets/check_image.h"
#include "nets/fairing.h"
#include "nets/label_sizes.h"
#include "nets/settle.h"
#include "nets/volumes.h"

namespace octafront {

namespace {

using nets::Lattice;

// The smallest labels would have to leave their voxels' cells to keep their volume.
constexpr std::uint64_t kFewVoxels = 8;

}  // namespace

Complex complex_of_labels(const LabelImage& image, const LabelSurfaceOptions& options, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  nets::check_grid(image.grid, image.regions.size());
  nets::check_labels(image);
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
  nets::Settled settled = nets::settle(net, quads_at, lattice, x, context);
  return nets::assemble(net, lattice, std::move(settled), x, nets::names_of(image));
}

}  // namespace octafront
