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
  friend bool operator==(const ImageGrid&, const ImageGrid&) = default;
};

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
  /// Counted from 1 as the refusal lists them: a series of DICOM files, a volume of a file with four dimensions, the
  /// image or a mask of an InVesalius project. 0: the only one, or of a project the image.
  std::uint32_t series = 0;
};

/// Whether read_image() is for it, by name and content: folders are (of DICOM files), files of other kinds are not.
/// False for what does not exist or cannot be opened.
bool is_image(const std::string& file);

/// Reads NIfTI-1 and NIfTI-2 (.nii, .nii.gz, .hdr with .img; also Analyze 7.5), NRRD (.nrrd, .nhdr), MetaImage (.mha,
/// .mhd), INR (.inr, .inr.gz), raw voxels with a JSON file of the same name beside them, InVesalius projects (.inv3),
/// and DICOM: a file, a folder, or a list of files; recognised by content, the name breaks ties. Coordinates are those
/// of the file's own convention, `Image::frame`: NIfTI RAS, DICOM and MetaImage LPS, NRRD what it says. Throws
/// InputError with file, byte offset or line, and the reason; Cancelled. Memory is bounded by a small multiple of the
/// size of the file, or of what its compressed stream really holds, whatever its header claims.
Image read_image(const std::vector<std::string>& files, const ImageChoice& choice = {},
                 const RunContext& context = no_context());
Image read_image(const std::string& file, const ImageChoice& choice = {}, const RunContext& context = no_context());

/// A segmentation: per voxel the number of its region, or kNoRegion.
struct LabelImage {
  static constexpr std::uint16_t kNoRegion = 0xffff;
  struct Label {
    std::int64_t value = 0;  ///< in the image
    std::string name;        ///< of the region
    friend bool operator==(const Label&, const Label&) = default;
  };
  ImageGrid grid;
  std::vector<std::uint16_t> regions;  ///< per voxel, an index into labels
  std::vector<Label> labels;
};

}  // namespace octafront
