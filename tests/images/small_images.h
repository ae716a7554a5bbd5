#pragma once

// Small images of every kind, as bytes in memory, for tests of the readers and as seeds of the fuzzer.

#include <octafront/image.h>

#include "images/files/image_readers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace octafront::testing {

/// A file and those beside it.
struct SmallImage {
  std::string name, bytes;
  std::map<std::string, std::string> beside = {};
};

/// 5 x 4 x 3 numbers from -20 on, none twice, on a sheared grid.
Image sample_image();
std::vector<std::int16_t> sample_values();

/// The sample in every kind of file that can hold it, its grid as it is.
std::vector<SmallImage> sheared_images();

Image read_small(const SmallImage& file, ImageChoice choice = {});

/// Any NIfTI: what a field may be is said by whoever needs it.
struct Nifti {
  int version = 1;
  bool big_endian = false, is_pair = false;
  std::array<std::int64_t, 8> dim{3, 5, 4, 3, 1, 1, 1, 1};
  std::array<double, 8> pixdim{1, 1, 1, 1, 1, 1, 1, 1};
  int datatype = 4, units = 2, qform_code = 0, sform_code = 0;
  double slope = 0, intercept = 0, offset = 0;  ///< offset 0: behind the header
  std::array<double, 6> quaternion{};
  std::array<std::array<double, 4>, 3> rows{};
  std::string voxels;
  std::string header() const;
  std::string bytes() const { return header() + voxels; }
};

/// A slice of DICOM, as scanners write it.
struct DicomSlice {
  enum class Syntax { kImplicit, kExplicit, kBigEndian, kRle, kJpeg } syntax = Syntax::kExplicit;
  std::string series = "1.2.3", description = "HEAD";
  std::string uid = "1.2.3.4";  ///< of this image
  int series_number = 1, acquisition = 1, instance = 1;
  std::array<std::uint16_t, 2> size{5, 4};  ///< columns, rows
  std::array<double, 3> at{};
  std::array<double, 6> directions{1, 0, 0, 0, 1, 0};
  std::array<double, 2> spacing{1, 1};  ///< between rows, then between columns, as the standard has it
  double thickness = 0;
  double slope = 1, intercept = 0;
  std::uint16_t bits_stored = 16;
  std::vector<std::int16_t> pixels;
  bool with_preamble = true;
  std::string bytes() const;
};

/// Slice k of the sample, whose rows run the other way: slices are put in the order of their normal.
DicomSlice dicom_slice(std::size_t k);

std::string gzip(const std::string& bytes);
std::string zlib(const std::string& bytes);

template <class T>
std::string raw(const std::vector<T>& values, bool big_endian = false) {
  std::string out;
  for (const T v : values) {
    std::string one(reinterpret_cast<const char*>(&v), sizeof(T));
    if (big_endian) one = std::string(one.rbegin(), one.rend());
    out += one;
  }
  return out;
}

/// The message of the InputError that `read` throws; fails the test if it throws none or another one.
std::string input_error(const std::function<void()>& read);

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}
inline bool any_contains(const std::vector<std::string>& notes, const std::string& part) {
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& n) { return contains(n, part); });
}

}  // namespace octafront::testing
