#include <octafront/image_surface.h>

#include "base/core/thread_limit.h"
#include "base/core/wording.h"
#include "images/nets/assemble.h"
#include "images/nets/cell_labels.h"
#include "images/nets/check_image.h"
#include "images/nets/fairing.h"
#include "images/nets/label_sizes.h"
#include "images/nets/resolve_conflicts.h"
#include "images/nets/volumes.h"

#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace octafront {

namespace {

using nets::Lattice;

// A label whose volume is off by more than this part is named. Those do not reach their voxels' volume whose surfaces
// find no room: voxels of several labels by turns, chains of voxels that touch in points.
constexpr double kWorthANote = 0.1;
constexpr std::size_t kMostNamed = 5;

void note_lost_volumes(const LabelImage& image, const nets::LabelSizes& sizes, double scale, Complex& complex) {
  std::string words;
  std::size_t count = 0, r = 0;
  for (std::size_t l = 0; l < image.labels.size(); ++l) {
    if (sizes.voxels[l] == 0) continue;
    const double voxels = sizes.volume[l] * scale, made = complex.volumes[r++];
    if (std::abs(made / voxels - 1) <= kWorthANote || ++count > kMostNamed) continue;
    words += fmt::format("{}\"{}\" ({}, {:.6g}; made {:.6g})", words.empty() ? "" : ", ", image.labels[l].name,
                         counted(sizes.voxels[l], "voxel"), voxels, made);
  }
  if (count == 0) return;
  if (count > kMostNamed) words += fmt::format(" and {} more", count - kMostNamed);
  complex.notes.push_back(
      fmt::format("the volume of {} differs from that of its voxels by more than {:.0f} %, for want of room: {}",
                  counted(count, "region"), 100 * kWorthANote, words));
}

}  // namespace

Complex complex_of_labels(const LabelImage& image, const LabelSurfaceOptions& options, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  nets::check_grid(image.grid, image.regions.size());
  nets::check_labels(image);
  context.check();
  const nets::CellLabels labels(image.grid, image.regions, image.labels.size(), options.margin);
  const Lattice& lattice = labels.lattice();
  nets::Net net = nets::make_net(lattice);
  context.check();
  const Groups<> quads_at = nets::quads_at_vertices(net);
  const nets::Stencils stencils(net, quads_at);
  const nets::Mates mates(lattice, net);
  nets::LabelSizes sizes(lattice, labels.count());
  labels.forget_margin(sizes);
  std::vector<Vec3> x = net.start;
  if (options.smooth) {
    const nets::VertexCells cells(lattice, net, sizes.voxels);
    nets::fair(stencils, cells, x, context);
    if (options.keep_volumes) nets::keep_volumes(net, quads_at, cells, lattice, sizes.volume, x, context);
  }
  mates.bring_together(lattice, net, x);
  nets::ResolvedNet resolved = nets::resolve_conflicts(net, quads_at, lattice, x, context, mates);
  labels.cut_out_cell(net);
  Complex complex = nets::assemble(net, lattice, std::move(resolved), x, image.labels, true);
  if (options.keep_volumes) note_lost_volumes(image, sizes, lattice.volume_scale(), complex);
  return complex;
}

}  // namespace octafront
