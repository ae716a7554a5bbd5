#pragma once

#include <octafront/image_surface.h>

#include "base/geometry/triangle_tree.h"
#include "base/geometry/winding_number.h"
#include "images/nets/lattice.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace octafront::nets {

/// The closed surfaces of one label, ready to be asked, in the world.
struct GivenSurface {
  Label label = 0;
  std::string name;  ///< of the label
  std::string from;  ///< names of the surfaces
  double volume = 0;
  TriangleTree tree;
  WindingNumber winding;
  /// Per label: whether it lies inside for the most part, or is the label itself. Known once voxels follow the surface.
  std::vector<std::uint8_t> within = {};

  /// What has labels that came later outside.
  bool holds(Label l) const { return l < within.size() && within[l] != 0; }
  /// Whichever way the surface faces, and where parts of it overlap.
  bool contains(Vec3 p) const { return std::abs(winding.at(p)) > 0.5; }
};

/// The longest way between neighbours of the grid, which is what a voxel is called where it is a distance.
double voxel_of(const ImageGrid& grid);

/// One for each label that has surfaces, smaller ones first, so that one inside another comes before it. Throws
/// OptionError for a label that the image does not have, InputError for a surface that is not closed.
std::vector<GivenSurface> given_surfaces(const LabelImage& image, const std::vector<SurfaceOfLabel>& given);

/// Near each surface, one after the other, voxels inside of it that have a label outside of `within` get the surface's,
/// and voxels outside of it that have one in `within` that of the nearest voxel that has not, if one is near. Notes say
/// how many. Throws InputError for a surface that is far from its label; Cancelled.
void follow_surfaces(LabelImage& image, std::vector<GivenSurface>& surfaces, const RunContext& context);

/// complex_of_labels() with the vertices between what surfaces hold and what is around that on them.
Complex complex_on_surfaces(const LabelImage& image, const LabelSurfaceOptions& options,
                            std::span<const GivenSurface> surfaces, const RunContext& context);

}  // namespace octafront::nets
