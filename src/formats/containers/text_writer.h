#pragma once

#include "formats/containers/atomic_file.h"

#include <charconv>
#include <concepts>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace octafront::io {

/// Numbers as text into an AtomicFile: the shortest digits that read back as the same double, whatever the locale.
class TextWriter {
 public:
  explicit TextWriter(AtomicFile& file) : file_(file) {}

  TextWriter& operator<<(std::string_view text) {
    file_.write(text);
    return *this;
  }
  TextWriter& operator<<(char c) {
    file_.write(&c, 1);
    return *this;
  }
  TextWriter& operator<<(double value) { return number(value); }
  template <std::integral Whole>
  TextWriter& operator<<(Whole value) {
    return number(value);
  }
  /// The most digits of a number that fit into so many characters; at least 13 for 20, 9 for 16. With a point or an
  /// exponent, as Fortran wants reals.
  TextWriter& within(std::size_t width, double value);
  /// The same, or a whole number, at the right of a field of that width.
  TextWriter& field(std::size_t width, double value);
  template <std::integral Whole>
  TextWriter& field(std::size_t width, Whole value) {
    return whole_field(width, static_cast<std::uint64_t>(value));
  }
  /// Any other text that fmt can make.
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    text_.clear();
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_.push_back('\n');
    file_.write(text_.data(), text_.size());
  }

 private:
  TextWriter& whole_field(std::size_t width, std::uint64_t value);
  template <class T>
  TextWriter& number(T value) {
    char digits[32];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
    static_cast<void>(error);  // the longest double has 24 characters
    file_.write(digits, static_cast<std::size_t>(end - digits));
    return *this;
  }

  AtomicFile& file_;
  fmt::memory_buffer text_;
};

}  // namespace octafront::io
