#pragma once

#include <octafront/no_context.h>
#include <octafront/vec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace octafront {

// Images of voxels: CT, MRI, segmentations. Files become an Image, an Image of whole numbers a LabelImage.

/// Where the voxels of an image lie. Voxel (i, j, k) is number i + ni (j + nj k); its middle is, in index space,
/// (i, j, slice(k)), and in the world axes[0] i + axes[1] j + axes[2] slice(k) + origin. Indices to the world may be
/// any invertible affine map: flips, rotations, the shear of a tilted gantry.
struct ImageGrid {
  std::array<std::uint32_t, 3> size = {0, 0, 0};                   ///< voxels along i, j and k
  std::array<Vec3, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< steps of one voxel, in the unit of the file
  Vec3 origin;                                                     ///< of the middle of voxel (0, 0, 0)
  std::vector<double> slices;  ///< where each k lies, in steps of axes[2], ascending; empty: 0, 1, 2, ...

  std::size_t voxels() const { return std::size_t{size[0]} * size[1] * size[2]; }
  double slice(std::uint32_t k) const { return slices.empty() ? k : slices[k]; }
  Vec3 to_world(Vec3 index) const { return origin + axes[0] * index.x + axes[1] * index.y + axes[2] * index.z; }
  /// The way back: (i, j, slice(k)) and what is between.
  Vec3 to_index(Vec3 world) const {
    const auto& [a, b, c] = axes;
    const Vec3 d = (world - origin) * (1 / dot(a, cross(b, c)));
    return {dot(cross(b, c), d), dot(cross(c, a), d), dot(cross(a, b), d)};
  }
  friend bool operator==(const ImageGrid&, const ImageGrid&) = default;
};

/// "80 x 80 x 60 voxels of 1 x 1 x 2".
std::string in_words(const ImageGrid& grid);

/// A value that voxels have, and its name.
struct LabelName {
  std::int64_t value = 0;
  std::string name;
  friend bool operator==(const LabelName&, const LabelName&) = default;
};

/// An image as a file has it.
struct Image {
  /// One value per voxel, slope and intercept of the file applied where it has any; all finite.
  using Values = std::variant<std::vector<std::uint8_t>, std::vector<std::int16_t>, std::vector<std::uint16_t>,
                              std::vector<std::int32_t>, std::vector<float>>;
  ImageGrid grid;
  Values values;
  std::vector<std::string> notes;     ///< what a reader decided or changed, a sentence each
  std::string format;                 ///< e.g. "NIfTI-1, compressed"
  std::string unit;                   ///< of coordinates: "mm", "m", "um"; empty: the file does not say
  std::string frame;                  ///< where x, y and z of the world point: "RAS", "LPS"; empty: nobody knows
  std::vector<LabelName> names = {};  ///< that the file itself has for its values
};

/// Which image of a file or folder that holds several.
struct ImageChoice {
  /// Counted from 1 as the refusal lists them: a series of DICOM files, a volume of a file with four dimensions. 0:
  /// the only one.
  std::uint32_t series = 0;
};

/// Whether read_image() is for it, by name and content: folders are (of DICOM files), files of other kinds are not.
/// False for what does not exist or cannot be opened.
bool is_image(const std::string& file);

/// Reads NIfTI-1 and NIfTI-2 (.nii, .nii.gz, .hdr with .img; also Analyze 7.5), NRRD (.nrrd, .nhdr), MetaImage (.mha,
/// .mhd), raw voxels with a JSON file of the same name beside them, and DICOM: a file, a folder, or a list of files;
/// recognised by content, the name breaks ties. Coordinates are those of the file's own convention, `Image::frame`:
/// NIfTI RAS, DICOM and MetaImage LPS, NRRD what it says. Throws InputError with file, byte offset or line, and the
/// reason; Cancelled. Memory is bounded by a small multiple of the size of the file, or of what its compressed stream
/// really holds, whatever its header claims.
Image read_image(const std::vector<std::string>& files, const ImageChoice& choice = {},
                 const RunContext& context = no_context());
Image read_image(const std::string& file, const ImageChoice& choice = {}, const RunContext& context = no_context());

/// A box of voxels: `lo` belongs to it, `hi` does not.
struct VoxelBox {
  std::array<std::uint32_t, 3> lo = {0, 0, 0}, hi = {0, 0, 0};
};

/// The part of an image in a box, where it was in the world. Throws OptionError for a box that is empty or reaches out
/// of the image.
Image cropped(const Image& image, const VoxelBox& box);

/// The image in other voxels, along the same axes, between the same faces: about `spacing` (above 0) apart along i, j
/// and k, in the unit of the file, a little more or less so that they fill it; evenly, also where slices were not. Of
/// labels each voxel gets the one that fills most of it; of grey values coarser voxels get the mean, finer ones what is
/// linear between. Throws OptionError for a spacing that makes no voxel or more than can be numbered; Cancelled.
Image resampled(const Image& image, Vec3 spacing, bool labels, const RunContext& context = no_context());

/// A value and how many voxels have it.
struct ValueCount {
  std::int64_t value = 0;
  std::uint64_t voxels = 0;
  friend bool operator==(const ValueCount&, const ValueCount&) = default;
};

/// The values of an image of whole numbers, ascending; nullopt if they are none, or more than 65,534 different ones.
std::optional<std::vector<ValueCount>> count_values(const Image& image);

/// Whether an image is a segmentation rather than grey: its values are whole numbers, and either at most 16 different
/// ones, or neighbours mostly have the same one: of the pairs of voxels that share a face, neither of which has the
/// image's commonest value, at least half are equal. Noise makes neighbours of grey images differ.
bool looks_like_labels(const Image& image);

/// A segmentation: per voxel the number of its region, or kNoRegion.
struct LabelImage {
  static constexpr std::uint16_t kNoRegion = 0xffff;
  struct Label {
    std::int64_t value = 0;  ///< in the image; of several that were merged the least
    std::string name;        ///< of the region
    friend bool operator==(const Label&, const Label&) = default;
  };
  ImageGrid grid;
  std::vector<std::uint16_t> regions;  ///< per voxel, an index into labels
  std::vector<Label> labels;
  std::vector<std::string> notes = {};  ///< what became of values, a sentence each
};

/// Which faces of the image's box each region reaches: bit 0 the first voxels along i, bit 1 the last ones, bits 2 and
/// 3 along j, 4 and 5 along k. Per label.
std::vector<std::uint8_t> faces_reached(const LabelImage& image);

/// Values that become one region.
struct LabelMerge {
  std::string name;
  std::vector<std::int64_t> values;
};

/// How values become regions.
struct LabelOptions {
  std::vector<LabelName> names;                     ///< go before those that the file has
  std::optional<std::vector<std::int64_t>> ignore;  ///< values outside of all regions; without a list: 0
  std::vector<LabelMerge> merge;
};

/// Regions of the values of an image, ascending, by their names, or "label 3" for 3; values of one name are one region.
/// Throws InputError if values are no whole numbers, too many or all ignored; OptionError for a value that is merged
/// twice or both merged and ignored.
LabelImage labels_of(const Image& image, const LabelOptions& options = {});

/// Reads names of values: a table of lines "3 liver", also with colours or other numbers behind (as 3D Slicer's colour
/// tables and FreeSurfer have them) or before a quoted name (ITK-SNAP's label files), with commas, or with a line of
/// titles; or JSON: {"3": "liver"}, {"liver": 3} or [{"value": 3, "name": "liver"}], alone or as "labels" of an object.
/// Names are the file's bytes; labels_of() makes UTF-8 of them, and says so. Throws InputError with the line for what
/// is none of these, or names a value twice.
std::vector<LabelName> read_label_names(const std::string& file, const RunContext& context = no_context());

/// What is cleaned before meshing; nothing unless asked for. Volumes are in the cubed unit of the file.
struct CleanOptions {
  double islands = 0;         ///< pieces of regions below this volume go to what surrounds them
  double holes = 0;           ///< pieces of the outside, not at the image's edge, below this volume are filled
  std::uint32_t closing = 0;  ///< gaps of regions toward the outside close that are up to twice as many voxels wide
  /// Where two regions, or one and the outside, touch in a spot of less than this area (in the squared unit of the
  /// file), or in a strip a voxel or two wide, a region beside it comes between them.
  double contacts = 0;
  /// Islands and holes below this volume as well, but the smallest first, and only while a region neither loses nor
  /// gets more than 1 % so: specks that elements of the size wanted cannot have, as long as they are noise.
  double specks = 0;
  bool any() const { return islands > 0 || holes > 0 || closing > 0 || contacts > 0 || specks > 0; }
};

/// Closes, removes islands, fills holes, removes specks, clears small contacts, in this order; voxels that share a face
/// hang together. Closing takes voxels of the outside only: those that are in reach of a region from all sides (the
/// morphological closing with an octahedron of `closing` voxels), the first region's where several are. Islands and
/// holes go to the region, or the outside, that has most faces with them. The largest piece of each region stays
/// whatever its size: no region is lost. A contact is cleared by the layer of voxels on one of its sides, if that
/// shortens the lines where three regions meet, cuts no region in two there, and all together change none by more than
/// 1 % or a voxel. What was done is in the notes of the result. The same bits on any number of threads.
LabelImage cleaned(const LabelImage& image, const CleanOptions& options, const RunContext& context = no_context());

/// A disc on the skin.
struct Electrode {
  Vec3 at;                        ///< on the body or near it
  double radius = 0, height = 0;  ///< > 0, in the unit of the file
};

/// Adds a region for each electrode, "electrode" or "electrode 2", whose label is above 100 and all others: voxels
/// outside of all regions that lie no farther from them than it is high, within its radius around the line that leads
/// outward where the skin is nearest. What several would have the first one gets. Notes say how many voxels each has,
/// and where it stands if its point is off the skin. Throws OptionError for one that gets no voxel, or whose point is
/// farther from the skin than its radius, its height and five voxels.
LabelImage with_electrodes(LabelImage image, const std::vector<Electrode>& electrodes);

}  // namespace octafront
