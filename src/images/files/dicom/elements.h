#pragma once

#include "formats/containers/input.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::image {

/// Group and element, as in (7FE0,0010).
using Tag = std::uint32_t;
constexpr Tag tag(std::uint32_t group, std::uint32_t element) {
  return group << 16 | element;
}

/// How the elements of a file are written, by its transfer syntax.
struct Syntax {
  std::string uid;   ///< e.g. "1.2.840.10008.1.2.1"
  std::string name;  ///< for messages
  bool is_explicit = true, big_endian = false;
  bool is_rle = false;
  bool is_readable = true;  ///< false: pixels in a way that is not read here
  bool is_jpeg = false;     ///< of the JPEG families, which unpacked() of unpack.h makes readable
};

/// A sequence that an element lies in, and the item of it, counted from 0.
struct Level {
  Tag sequence = 0;
  std::uint32_t item = 0;
};

/// An element of a file.
struct Element {
  Tag id = 0;
  std::string_view value;
  std::vector<std::string_view> fragments = {};  ///< of pixels; the table of offsets is left out
};

/// Whether bytes begin as DICOM files do, with the preamble or without.
bool is_dicom(std::string_view head);

/// Where the data begin of a file that is deflated as a whole; 0: it is not.
std::size_t deflated_data_in(std::string_view bytes);

/// Calls visit(levels, element) for every element of a file that holds a value, in order; sequences are gone through.
/// Returns how they are written. Throws InputError with the byte for a file that is damaged.
Syntax for_each_element(const io::Input& input,
                        const std::function<void(const std::vector<Level>&, const Element&)>& visit);

}  // namespace octafront::image
