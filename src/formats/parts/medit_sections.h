#pragma once

// The binary files of MEDIT, meshes and solutions: sections by codes, each with the place of the next one.

#include "formats/containers/input.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <fmt/core.h>

namespace octafront::io {

class MeditSections {
 public:
  explicit MeditSections(const Input& input) : input_(input), progress_(input), at_(input.bytes.data()) {}

  /// Calls visit(code) at the beginning of each section but Dimension, which must be 3, until one returns false. Throws
  /// InputError.
  template <class Visit>
  void for_each(const Visit& visit) {
    constexpr std::int32_t kDimension = 3, kEnd = 54;
    constexpr std::int32_t kOne = 1, kSwappedOne = 1 << 24;
    const auto mark = get<std::int32_t>();
    if (mark != kOne && mark != kSwappedOne) fail("does not begin with the mark of binary MEDIT");
    is_swapped_ = mark == kSwappedOne;
    version_ = get<std::int32_t>();
    if (version_ < 1 || version_ > 4)
      fail(fmt::format("version {} of binary MEDIT is not read here (1 to 4 are)", version_));
    for (auto code = get<std::int32_t>(); code != kEnd; code = get<std::int32_t>()) {
      const std::uint64_t next = version_ < 3 ? get<std::uint32_t>() : get<std::uint64_t>();
      const char* const begin = at_;
      if (code != kDimension) {
        if (!visit(code)) return;
      } else if (get<std::int32_t>() != 3) {
        fail("it is of another dimension than 3");
      }
      // Sections only follow each other, so that reading ends.
      if (next <= static_cast<std::uint64_t>(begin - input_.bytes.data()) || next > input_.bytes.size())
        fail(fmt::format("the next section is said to begin at byte {}; the file is truncated or damaged", next));
      at_ = input_.bytes.data() + next;
    }
  }

  template <class T>
  T get() {
    progress_.reach(at_);
    if (bytes_left() < sizeof(T)) fail("the file ends here; it is truncated: copy or export it again");
    T value;
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at_, sizeof(T));
    if (is_swapped_) std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&value, bytes.data(), sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  /// Single or double precision, by the version.
  double real() { return version_ == 1 ? get<float>() : get<double>(); }
  int version() const { return version_; }
  const char* position() const { return at_; }
  std::size_t bytes_left() const { return static_cast<std::size_t>(input_.bytes.data() + input_.bytes.size() - at_); }
  [[noreturn]] void fail(std::string_view message) const { input_.fail_at_byte(at_, message); }

 private:
  const Input& input_;
  ReadingProgress progress_;
  const char* at_;
  int version_ = 0;
  bool is_swapped_ = false;  ///< the file is of a machine of the other byte order
};

}  // namespace octafront::io
