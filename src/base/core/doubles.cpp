#include "base/core/doubles.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <string>

#include <locale.h>
#ifdef __APPLE__
#include <xlocale.h>
#endif

namespace octafront::io {
namespace {

/// Where strtod() takes more than std::from_chars(): blanks and a plus before, hexadecimal digits.
std::string without_what_only_c_reads(const char* first, const char* last) {
  const char* const end = std::find_if(first, last, [](char c) { return c <= ' ' || c == 'x' || c == 'X'; });
  return first != end && *first == '+' ? std::string() : std::string(first, end);
}

}  // namespace

std::from_chars_result double_by_c_library(const char* first, const char* last, double& value) {
#ifdef _WIN32
  static const _locale_t kPlain = _create_locale(LC_ALL, "C");
  const auto strtod_l = _strtod_l;
#else
  static const locale_t kPlain = newlocale(LC_ALL_MASK, "C", nullptr);
#endif
  const std::string text = without_what_only_c_reads(first, last);
  char* end = nullptr;
  errno = 0;
  const double found = strtod_l(text.c_str(), &end, kPlain);
  const std::ptrdiff_t read = end - text.c_str();
  if (read == 0) return {first, std::errc::invalid_argument};
  // Small numbers that have fewer digits are no error.
  if (errno == ERANGE && (found == 0 || std::isinf(found))) return {first + read, std::errc::result_out_of_range};
  value = found;
  return {first + read, std::errc()};
}

#ifndef __cpp_lib_to_chars
std::from_chars_result double_from_chars(const char* first, const char* last, double& value) {
  return double_by_c_library(first, last, value);
}
#endif

}  // namespace octafront::io
