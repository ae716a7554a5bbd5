#pragma once

// Bodies in a cell: repeated along axes, cut by the cell's faces.

#include <octafront/complex.h>
#include <octafront/domain.h>

#include "periodic/periodic_cell.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace octafront::intake {

/// The name of what bodies leave of a cell that is given as a box.
inline constexpr const char* kMatrixName = "matrix";

/// Whether bodies are to be put into a cell.
bool asks_for_cell(const IntakeOptions& options);

/// The box that the option names, which is not "first". Throws OptionError if that is none.
Box3 box_of_option(const std::string& text);

/// A box as a body.
Body box_body(const std::string& name, const Box3& box);

/// The cell, then the bodies, each with all its copies that reach into the cell. `bodies`: mended. Throws OptionError,
/// InputError for a body that does not reach into it. What goes through the whole cell and on is not repeated that way,
/// which is said.
std::vector<Body> bodies_in_cell(std::vector<Body> bodies, const IntakeOptions& options,
                                 std::vector<std::string>& notes);

/// How surfaces are made of an image that goes on periodically.
struct PeriodicSurfaces {
  std::function<Complex(const Image&)> of;  ///< of the image with voxels added at its ends
  std::uint32_t margin = 0;                 ///< voxels that are added at each end of a period
  Box3 cell = {};                           ///< of the image's periods, no farther from its box than a voxel
};

/// The complex of values that go on periodically along axes of the world: surfaces cut by the cell. Vertices of the
/// surfaces lie alike at copies of a place. Throws InputError for an image whose axes are not those of the world.
Complex complex_of_periodic_values(const Image& image, const PeriodicSurfaces& surfaces,
                                   const std::array<bool, 3>& along, const RunContext& context);

/// The complex of an image that goes on periodically along axes of the world: its cell goes from the middles of the
/// first voxels to those of their next copies, and its faces are part of the net of surfaces. Throws as
/// complex_of_image(), and InputError for an image whose axes are not those of the world.
Complex complex_of_periodic_image(const Image& image, const ImageRegions& regions, const std::array<bool, 3>& along,
                                  const RunContext& context);

}  // namespace octafront::intake
