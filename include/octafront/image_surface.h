#pragma once

#include <octafront/complex.h>
#include <octafront/image.h>
#include <octafront/no_context.h>
#include <octafront/surface_mesh.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

// From images to the complex that their labels or grey values bound: one net of surfaces for all regions, which share
// their faces.

/// An image that goes on periodically, as one of a cell and so many layers around it at both ends of each axis; 0: it
/// does not go on along that axis. The cell goes from the middle of a layer of voxels to that of its next copy; so of n
/// layers there are n + 1 in it, the first and the last of which are halves of one, and so are those beside them in the
/// margin. `origin` of its grid is in the middle of the first voxel of the cell. What is made of it is the cell, flat
/// at its ends, with vertices that are the same at opposite ones.
using PeriodicMargin = std::array<std::uint32_t, 3>;

/// How the surfaces of labels are made from the steps between voxels.
struct LabelSurfaceOptions {
  /// Off: the faces of the voxels, as they are.
  bool smooth = true;
  /// Regions have the volume of their voxels after smoothing too, up to what their voxels' surroundings allow.
  bool keep_volumes = true;
  PeriodicMargin margin = {0, 0, 0};
};

/// The surfaces between the labels of an image and around them, as a clean complex in world coordinates.
///
/// Each vertex stays within half a voxel of a corner of voxels, so nothing is farther from the voxels' faces than half
/// their diagonal, and every label stays, one of a single voxel too. What touches the image's box is flat there.
/// Voxels of one label that touch in an edge hang together there if they are the fewer around it; else, and where that
/// would make surfaces cross, regions touch themselves or each other in edges and points.
///
/// The complex has the labels that occur, in the order of `image.labels`, with their names, and their volumes as made.
/// Notes say what stayed unsmoothed. The same bits on any number of threads.
///
/// After S. F. Frisken Gibson, "Constrained Elastic Surface Nets" (1998): dual vertices held in their cells; the
/// smoothing is another one.
///
/// Throws InputError if the image has no label, or sizes do not fit together; Cancelled.
Complex complex_of_labels(const LabelImage& image, const LabelSurfaceOptions& options = {},
                          const RunContext& context = no_context());

/// A material by its grey values: lo <= value < hi; infinite ends are allowed.
struct GreyBand {
  double lo = 0, hi = 0;
  std::string name;
};

/// The surfaces between bands of grey values, as a clean complex: they lie between voxels, where values that are linear
/// between the middles of voxels pass from band to band, and are flat on the image's box. Bands must not overlap;
/// values in none of them are outside. Where voxels side by side skip a band, the surface lies where the middle one of
/// the limits between them is passed. Nothing else moves the surfaces: volumes are what the values say.
///
/// Throws InputError for bands that overlap or are empty, or if no value lies in one; Cancelled.
Complex complex_of_bands(const Image& image, const std::vector<GreyBand>& bands,
                         const RunContext& context = no_context());
Complex complex_of_bands(const Image& image, const std::vector<GreyBand>& bands, const PeriodicMargin& margin,
                         const RunContext& context = no_context());

/// The voxels of bands as labels: label b for bands[b], whose `value` is b. Throws InputError as complex_of_bands.
LabelImage labels_of_bands(const Image& image, const std::vector<GreyBand>& bands);

/// A closed surface that bounds a label more truly than voxels do, such as FreeSurfer's of the cortex.
struct SurfaceOfLabel {
  std::string label;      ///< its name, or its number
  SurfaceMesh surface;    ///< closed, in the coordinates of the image
  std::string name = {};  ///< for messages and notes: that of the file
};

/// What of an image becomes regions.
struct ImageRegions {
  /// kAuto: grey if bands are given, labels if anything about labels is, else what looks_like_labels() says.
  enum class Kind { kAuto, kLabels, kGrey };
  Kind kind = Kind::kAuto;
  LabelOptions labels;
  std::vector<GreyBand> bands;  ///< one without a name is "body", several "band 1" and so on
  CleanOptions clean;
  std::vector<Electrode> electrodes = {};  ///< of labels: set on when they are clean
  /// Of labels: within two voxels of these surfaces they say which voxels a label has, and vertices between it and what
  /// is around it lie on them. A label that lies within another's surface for the most part counts as part of that; so
  /// surfaces may lie within each other. Several of one label are parts of it.
  std::vector<SurfaceOfLabel> surfaces = {};
  bool closed_at_box = true;  ///< off: regions that reach the edge of the image are refused
  PeriodicMargin margin = {0, 0, 0};
};

/// kLabels or kGrey.
ImageRegions::Kind kind_of(const Image& image, const ImageRegions& regions);

/// From an image to its complex: complex_of_labels() or complex_of_bands(), after cleaning. Notes say what became of
/// labels, what was cleaned, what surfaces changed, and which regions end at the edge of the image. Throws InputError,
/// also for a grey image without bands, and for a surface that is open or far from its label; OptionError for options
/// of the other kind, and a surface of a label that there is not; Cancelled.
Complex complex_of_image(const Image& image, const ImageRegions& regions = {},
                         const RunContext& context = no_context());

/// The smallest distance of neighbouring voxels along i, j or k.
double smallest_spacing(const ImageGrid& grid);

}  // namespace octafront
