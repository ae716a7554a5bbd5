#pragma once

#include "formats/containers/atomic_file.h"
#include "formats/containers/text_writer.h"

#include <cstdint>
#include <cstring>
#include <functional>
#include <string_view>
#include <vector>

namespace octafront::io {

/// The arrays of a VTK XML file as raw appended data, compressed by zlib in blocks, or as text in their tags. Values
/// are asked for block by block, so that the memory needed does not grow with the mesh; blocks are compressed in
/// parallel and written in order.
class VtuArrays {
 public:
  /// Fills `to` with the values [first, first + count).
  using Fill = std::function<void(std::uint64_t first, std::uint64_t count, char* to)>;

  explicit VtuArrays(AtomicFile& file, bool as_text = false) : file_(file), as_text_(as_text) {}

  /// Writes the tag of an array; its values follow in write_data(), or at once as text. `type` is VTK's name, e.g.
  /// "Float64".
  void declare(std::string_view type, std::string_view name, int components, std::uint64_t values,
               std::size_t bytes_per_value, Fill fill);

  /// As above, one value at a time.
  template <class T, class ValueAt>
  void declare(std::string_view type, std::string_view name, int components, std::uint64_t values, ValueAt value_at) {
    if (as_text_) return write_text<T>(type, name, components, values, value_at);
    declare(type, name, components, values, sizeof(T), [value_at](std::uint64_t first, std::uint64_t count, char* to) {
      for (std::uint64_t i = 0; i < count; ++i) {
        const T value = value_at(first + i);
        std::memcpy(to + i * sizeof(T), &value, sizeof(T));
      }
    });
  }

  /// Writes the appended data, if there is any, in the order of declaration, and enters the offsets into the tags.
  void write_data();

 private:
  struct Array {
    std::uint64_t offset_at;  ///< where in the file the offset is to be entered
    std::uint64_t values;
    std::size_t bytes_per_value;
    Fill fill;
  };

  void write_array(const Array& array);
  void open_text(std::string_view type, std::string_view name, int components);

  template <class T, class ValueAt>
  void write_text(std::string_view type, std::string_view name, int components, std::uint64_t values,
                  const ValueAt& value_at) {
    open_text(type, name, components);
    TextWriter out(file_);
    constexpr std::uint64_t kInLine = 24;  // a multiple of three: points stay whole
    for (std::uint64_t i = 0; i < values; ++i) {
      const T value = value_at(i);
      if constexpr (sizeof(T) == 1) out << std::uint32_t{value};
      if constexpr (sizeof(T) > 1) out << value;
      out << (i % kInLine == kInLine - 1 ? '\n' : ' ');
    }
    out << "\n        </DataArray>\n";
  }

  AtomicFile& file_;
  bool as_text_;
  std::vector<Array> arrays_;
};

}  // namespace octafront::io
