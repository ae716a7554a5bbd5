#include "formats/containers/text_writer.h"

#include <octafront/error.h>

#include <algorithm>
#include <array>

namespace octafront::io {
namespace {

/// The shortest digits that say the same, or as many as fit.
std::string_view digits_within(std::size_t width, double value, std::array<char, 40>& room) {
  char* const end = room.data() + room.size() - 2;  // leaves room for a point
  const auto written = [&](std::to_chars_result result) {
    std::string_view text(room.data(), static_cast<std::size_t>(result.ptr - room.data()));
    if (text.find_first_of(".en") == std::string_view::npos) {
      *result.ptr = '.';
      text = {room.data(), text.size() + 1};
    }
    return text;
  };
  std::string_view text = written(std::to_chars(room.data(), end, value));
  for (int digits = 17; text.size() > width && digits > 0; --digits)
    text = written(std::to_chars(room.data(), end, value, std::chars_format::general, digits));
  return text;
}

constexpr std::string_view kBlanks = "                                ";

}  // namespace

TextWriter& TextWriter::within(std::size_t width, double value) {
  std::array<char, 40> room;
  return *this << digits_within(width, value, room);
}

TextWriter& TextWriter::field(std::size_t width, double value) {
  std::array<char, 40> room;
  const std::string_view text = digits_within(width, value, room);
  return *this << kBlanks.substr(0, width - std::min(width, text.size())) << text;
}

TextWriter& TextWriter::whole_field(std::size_t width, std::uint64_t value) {
  std::array<char, 24> room;
  const auto [end, error] = std::to_chars(room.data(), room.data() + room.size(), value);
  static_cast<void>(error);  // 20 digits at most
  const auto size = static_cast<std::size_t>(end - room.data());
  if (size > width)
    throw OutputError(
        fmt::format("{}: the number {} does not fit into the {} columns that the format has for it; write "
                    "a format without columns, such as .vtu or .msh",
                    file_.name(), value, width));
  return *this << kBlanks.substr(0, width - size) << std::string_view(room.data(), size);
}

}  // namespace octafront::io
