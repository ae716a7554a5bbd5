#pragma once

// What label images are asked, and what becomes of them, step by step.

#include <octafront/image.h>
#include <octafront/run_context.h>

#include <cstdint>
#include <map>
#include <utility>

namespace octafront::image {

/// The morphological closing of each region by an octahedron of `reach` voxels, into the outside only; voxels that
/// several regions close over go to the first one. Returns how many voxels were taken.
std::uint64_t close_gaps(LabelImage& image, std::uint32_t reach, const RunContext& context);

/// What contacts of few voxels became.
struct ClearedContacts {
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::uint64_t> spots;  ///< by the two that touched, the less first
  std::uint64_t voxels = 0;                                                ///< that changed hands
};

/// Where two regions, or one and the outside, touch in a spot smaller than `width` squared or a strip of a voxel or two
/// (`width` is an edge length in the unit of the grid), the layer of voxels on one of its sides goes to a region beside
/// the spot, if so the lines between three regions get shorter. No voxel changes twice, none behind the first layer; no
/// region is lost, or cut in two there.
ClearedContacts clear_small_contacts(LabelImage& image, double width, const RunContext& context);

// How much of a segmentation is only a voxel thick.

struct Thinness {
  std::uint64_t faces = 0;  ///< between voxels of different regions
  std::uint64_t thin = 0;   ///< voxels between two of them along an axis
  double part() const { return faces == 0 ? 0 : static_cast<double>(thin) / static_cast<double>(faces); }
};

/// Faces on the image's box do not count.
Thinness thinness_of(const LabelImage& image);

}  // namespace octafront::image
