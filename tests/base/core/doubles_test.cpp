#include "base/core/doubles.h"

#include <bit>
#include <clocale>
#include <cstdint>
#include <random>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace octafront::io {
namespace {

struct Read {
  double value = -7;
  std::ptrdiff_t length = 0;
  std::errc error = {};
  friend bool operator==(const Read&, const Read&) = default;
};

template <class Function>
Read read(const Function& function, const std::string& text) {
  Read r;
  const auto [stop, error] = function(text.data(), text.data() + text.size(), r.value);
  r.length = stop - text.data();
  r.error = error;
  return r;
}

#ifdef __cpp_lib_to_chars
/// On machines whose standard library lacks the one, the other does its work.
TEST(Doubles, AreReadByTheCLibraryAsByTheStandardOne) {
  const auto standard = [](const char* first, const char* last, double& v) { return std::from_chars(first, last, v); };
  for (const char* text : {"0",
                           "-0",
                           "1",
                           "+1",
                           " 1",
                           "1 2",
                           "1,5",
                           "1.5",
                           ".5",
                           "5.",
                           ".",
                           "-",
                           "",
                           "e5",
                           "1e",
                           "1e+",
                           "1e5",
                           "1E-5",
                           "1e400",
                           "-1e400",
                           "1e-400",
                           "4.9e-324",
                           "2e-324",
                           "1e-310",
                           "1.7976931348623157e308",
                           "1.7976931348623159e308",
                           "0x1p3",
                           "12abc",
                           "inf",
                           "-inf",
                           "nan",
                           "--1",
                           "123456789012345678901234567890",
                           "0.1000000000000000055511151231257827"}) {
    SCOPED_TRACE(text);
    const Read a = read(standard, text), b = read(double_by_c_library, text);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.value), std::bit_cast<std::uint64_t>(b.value));
    EXPECT_EQ(a.length, b.length);
    EXPECT_EQ(a.error, b.error);
  }
  std::mt19937_64 random(7);
  for (int i = 0; i < 20000; ++i) {
    const auto value = std::bit_cast<double>(random());
    if (value != value) continue;
    const std::string text = fmt::format("{}", value), long_text = fmt::format("{:.20e}", value);
    EXPECT_EQ(read(standard, text), read(double_by_c_library, text)) << text;
    EXPECT_EQ(read(standard, long_text), read(double_by_c_library, long_text)) << long_text;
  }
}
#endif

TEST(Doubles, HaveAPointInEveryLocale) {
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  for (const char* name : {"de_DE.UTF-8", "C"}) {
    std::setlocale(LC_NUMERIC, name);
    EXPECT_EQ(read(double_by_c_library, "1.5").value, 1.5);
    EXPECT_EQ(read(double_from_chars, "1.5").value, 1.5);
  }
  std::setlocale(LC_NUMERIC, before.c_str());
}

}  // namespace
}  // namespace octafront::io
