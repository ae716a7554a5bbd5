#include <octafront/image_surface.h>

#include "base/core/thread_limit.h"
#include "base/core/wording.h"
#include "images/nets/cell_labels.h"
#include "images/nets/conflicts.h"
#include "images/nets/given_surfaces.h"
#include "images/nets/net_steps.h"

#include <cmath>
#include <span>
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

/// A label has a pressure where at least so much of its surface is free to move: few vertices could not make up for
/// all.
constexpr double kMostlyFree = 0.5;

/// Per label: the part of its vertices, as quads count them, that lies on no surface.
std::vector<double> free_parts(const nets::Net& net, const nets::PlacedVertices& placed, std::size_t labels) {
  std::vector<double> all(labels, 0), free(labels, 0);
  for (const nets::Quad& q : net.quads)
    for (const nets::Label l : {q.lower, q.upper})
      if (l != LabelImage::kNoRegion)
        for (const VertexIndex v : q.v) ++all[l], free[l] += placed.is_placed[v] ? 0 : 1;
  for (std::size_t l = 0; l < labels; ++l) free[l] = all[l] > 0 ? free[l] / all[l] : 0;
  return free;
}

/// Volumes follow the placed vertices: `sizes` get what those change of the voxels' volumes. Returns them, without
/// labels that surfaces bound for the most part.
std::vector<double> wanted_volumes(const nets::Net& net, const std::vector<Vec3>& x, const nets::PlacedVertices& placed,
                                   nets::LabelSizes& sizes) {
  if (placed.is_placed.empty()) return sizes.volume;
  const std::size_t labels = sizes.volume.size();
  std::vector<Vec3> steps = net.start;
  const std::vector<double> before = nets::volumes_of(net, steps, labels);
  for (std::size_t v = 0; v < steps.size(); ++v)
    if (placed.is_placed[v]) steps[v] = x[v];
  const std::vector<double> after = nets::volumes_of(net, steps, labels);
  for (std::size_t l = 0; l < labels; ++l) sizes.volume[l] += after[l] - before[l];
  std::vector<double> wanted = sizes.volume;
  const std::vector<double> free = free_parts(net, placed, labels);
  for (std::size_t l = 0; l < labels; ++l)
    if (free[l] < kMostlyFree) wanted[l] = 0;
  return wanted;
}

std::vector<std::string> notes_of_placed(std::span<const nets::GivenSurface> surfaces,
                                         const nets::PlacedVertices& placed, std::span<const Vec3> world) {
  std::vector<std::string> notes;
  const std::vector<nets::Deviation> all = nets::deviations(surfaces, placed, world);
  for (std::size_t s = 0; s < all.size(); ++s) {
    std::string words =
        fmt::format("{} of \"{}\" on {}: {:.2g} off it in the mean, {:.2g} at most",
                    counted(all[s].vertices, "vertex", "vertices"), surfaces[s].name, surfaces[s].from,
                    all[s].vertices > 0 ? all[s].sum / static_cast<double>(all[s].vertices) : 0, all[s].largest);
    if (placed.far[s] > 0) words += fmt::format("; {} more than a voxel off stay", placed.far[s]);
    notes.push_back(std::move(words));
  }
  return notes;
}

}  // namespace

Complex complex_of_labels(const LabelImage& image, const LabelSurfaceOptions& options, const RunContext& context) {
  return nets::complex_on_surfaces(image, options, {}, context);
}

Complex nets::complex_on_surfaces(const LabelImage& image, const LabelSurfaceOptions& options,
                                  std::span<const GivenSurface> surfaces, const RunContext& context) {
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
  nets::PlacedVertices placed;
  if (options.smooth) {
    const nets::VertexCells cells(lattice, net, sizes.voxels);
    nets::fair(stencils, cells, x, context);
    placed = nets::place_on_surfaces(net, lattice, surfaces, x, context);
    if (options.keep_volumes) {
      const std::vector<double> wanted = wanted_volumes(net, x, placed, sizes);
      nets::keep_volumes(net, quads_at, cells, lattice, wanted, x, context, placed.is_placed);
    }
  }
  mates.bring_together(lattice, net, x);
  nets::ResolvedNet resolved = nets::resolve_conflicts(net, quads_at, lattice, x, context, mates);
  std::vector<std::string> notes = notes_of_placed(surfaces, placed, resolved.world);
  labels.cut_out_cell(net);
  Complex complex = nets::assemble(net, lattice, std::move(resolved), x, image.labels, true);
  complex.notes.insert(complex.notes.begin(), notes.begin(), notes.end());
  if (options.keep_volumes) note_lost_volumes(image, sizes, lattice.volume_scale(), complex);
  return complex;
}

}  // namespace octafront
