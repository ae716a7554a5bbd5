#pragma once

#include <charconv>

namespace octafront::io {

/// std::from_chars of a double, whatever the locale; libc++ lacks it before its version 20.
#ifdef __cpp_lib_to_chars
inline std::from_chars_result double_from_chars(const char* first, const char* last, double& value) {
  return std::from_chars(first, last, value);
}
#else
std::from_chars_result double_from_chars(const char* first, const char* last, double& value);
#endif

/// The same by the C library: slower, and correctly rounded too where that is. For tests on every machine.
std::from_chars_result double_by_c_library(const char* first, const char* last, double& value);

}  // namespace octafront::io
