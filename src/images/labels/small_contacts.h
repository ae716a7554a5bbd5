#pragma once

#include <octafront/image.h>
#include <octafront/run_context.h>

#include <cstdint>
#include <map>
#include <utility>

namespace octafront::image {

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

}  // namespace octafront::image
