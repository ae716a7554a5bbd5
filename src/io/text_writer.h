#pragma once

#include "io/atomic_file.h"

#include <charconv>
#include <cstdint>
#include <string_view>

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
  TextWriter& operator<<(std::uint64_t value) { return number(value); }
  TextWriter& operator<<(std::uint32_t value) { return number(value); }

 private:
  template <class T>
  TextWriter& number(T value) {
    char digits[32];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
    static_cast<void>(error);  // the longest double has 24 characters
    file_.write(digits, static_cast<std::size_t>(end - digits));
    return *this;
  }

  AtomicFile& file_;
};

}  // namespace octafront::io
