#pragma once

#include <octafront/vec.h>

#include "images/files/dicom/elements.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace octafront::image {

/// One image of a file, and where it lies.
struct Slice {
  std::uint32_t file = 0, frame = 0;  ///< file: whatever its owner counts
  std::int64_t acquisition = 0, instance = 0;
  std::array<std::uint32_t, 2> size{};  ///< columns, rows
  bool has_place = false;
  Vec3 at;                           ///< of the middle of the first pixel, mm
  std::array<Vec3, 2> directions{};  ///< of a row, and of a column; of length 1
  std::array<double, 2> spacing{};   ///< of pixels along a row, and along a column
  double thickness = 0;              ///< or the distance of slices, if the file says it; 0: neither
  double slope = 1, intercept = 0;
  std::int64_t segment = 0;  ///< of a segmentation: the number of what the frame shows
};

/// A segment of a segmentation.
struct Segment {
  std::int64_t number = 0;
  std::string name;
};

/// How pixels are stored.
struct PixelFormat {
  std::uint32_t bits_allocated = 0, bits_stored = 0, high_bit = 0;
  bool is_signed = false;
  friend bool operator==(const PixelFormat&, const PixelFormat&) = default;
};

/// What a file says of its images.
struct SliceFile {
  Syntax syntax;
  std::string series, description, modality, sop_class;
  std::int64_t series_number = 0;
  PixelFormat format;
  std::uint32_t samples = 1;
  std::vector<Slice> slices;  ///< one per frame
  std::vector<Segment> segments;
  std::uint32_t most = 1;   ///< of a segmentation of parts of voxels: what a whole voxel has
  std::string_view pixels;  ///< native ones; refers to the bytes of the file
  std::vector<std::string_view> fragments;
  bool has_pixels = false;

  bool is_segmentation() const { return sop_class.starts_with("1.2.840.10008.5.1.4.1.1.66.4"); }
};

/// Throws InputError for damaged files; what is not read here (is_readable, samples, no pixels) is told by
/// refuse_pixels().
SliceFile parse_slices(const io::Input& input);

/// Throws InputError, by name, for files whose pixels cannot be read here.
void refuse_pixels(const io::Input& input, const SliceFile& file);

/// The values of one frame as they are stored, rows after rows, into `out`, which has as many as the frame. Throws
/// InputError if the file has fewer.
void read_pixels(const io::Input& input, const SliceFile& file, const Slice& slice, std::int32_t* out);

}  // namespace octafront::image
