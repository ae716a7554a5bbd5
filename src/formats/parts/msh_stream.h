#pragma once

#include <octafront/tet_mesh.h>

#include "formats/containers/input.h"
#include "formats/containers/scanner.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace octafront::io {

/// What Gmsh's physical groups of dimension 0 to 3 hold.
inline constexpr std::array<NamedSet::Kind, 4> kKindOfDimension{NamedSet::Kind::kNodes, NamedSet::Kind::kEdges,
                                                                NamedSet::Kind::kFaces, NamedSet::Kind::kElements};
inline std::size_t dimension_of(NamedSet::Kind kind) {
  return static_cast<std::size_t>(std::find(kKindOfDimension.begin(), kKindOfDimension.end(), kind) -
                                  kKindOfDimension.begin());
}

/// The values of a Gmsh file, in text or little-endian binary, and its sections "$Name ... $EndName".
class MshStream {
 public:
  explicit MshStream(const Input& input) : input_(input), progress_(input), scan_(input) {}

  /// Names of sections and numbers in headers are text in either case.
  Scanner& text() { return scan_; }
  /// Some counts stand in a line of text also in binary files.
  void skip_line_end();
  void set_binary() { binary_ = true; }
  bool is_binary() const { return binary_; }

  /// Moves behind the line that opens the next section and returns its name without "$"; empty at the end.
  std::string_view next_section();
  /// Checks that the section ends here.
  void end_section(std::string_view name);
  void skip_section(std::string_view name);

  std::int64_t int32(std::string_view what);
  std::uint64_t size(std::string_view what);
  double real(std::string_view what);
  /// Passes over integers or reals.
  void skip_int32(std::uint64_t count);
  void skip_size(std::uint64_t count);
  void skip_real(std::uint64_t count);

  const char* position() const { return scan_.position(); }
  /// At least: one digit and a blank in text.
  std::uint64_t least_bytes(std::uint64_t binary_bytes) const { return binary_ ? binary_bytes : 2; }
  /// Throws unless as many records can be left, each of `reals` doubles, `sizes` 64-bit and `ints` 32-bit integers.
  void check_count(std::uint64_t count, std::uint64_t reals, std::uint64_t sizes, std::uint64_t ints,
                   std::string_view what) const;
  /// Throws InputError with the line, or, in binary, the byte.
  [[noreturn]] void fail(std::string_view message) const;

 private:
  template <class T>
  T get(std::string_view what);
  void skip(std::uint64_t count, std::uint64_t binary_bytes);

  const Input& input_;
  ReadingProgress progress_;
  Scanner scan_;
  bool binary_ = false;
};

}  // namespace octafront::io
