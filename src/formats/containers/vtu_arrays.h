#pragma once

#include "formats/containers/atomic_file.h"

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::io {

/// The arrays of a VTK XML file as raw appended data, compressed by zlib in blocks. Values are asked for block by
/// block, so that the memory needed does not grow with the mesh; blocks are compressed in parallel and written in
/// order.
class VtuArrays {
 public:
  /// Fills `to` with the values [first, first + count).
  using Fill = std::function<void(std::uint64_t first, std::uint64_t count, char* to)>;

  explicit VtuArrays(AtomicFile& file) : file_(file) {}

  /// Writes the tag of an array; its values follow in write_data(). `type` is VTK's name, e.g. "Float64".
  void declare(std::string_view type, std::string_view name, int components, std::uint64_t values,
               std::size_t bytes_per_value, Fill fill);

  /// As above, one value at a time.
  template <class T, class ValueAt>
  void declare(std::string_view type, std::string_view name, int components, std::uint64_t values, ValueAt value_at) {
    declare(type, name, components, values, sizeof(T), [value_at](std::uint64_t first, std::uint64_t count, char* to) {
      for (std::uint64_t i = 0; i < count; ++i) {
        const T value = value_at(first + i);
        std::memcpy(to + i * sizeof(T), &value, sizeof(T));
      }
    });
  }

  /// Writes the appended data in the order of declaration, and enters the offsets into the tags.
  void write_data();

 private:
  struct Array {
    std::uint64_t offset_at;  ///< where in the file the offset is to be entered
    std::uint64_t values;
    std::size_t bytes_per_value;
    Fill fill;
  };

  void write_array(const Array& array);

  AtomicFile& file_;
  std::vector<Array> arrays_;
};

}  // namespace octafront::io
