// Points of a table, one in each line; lines between them are polygons that end at an empty line.

#include "formats/containers/scanner.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/core.h>

namespace octafront::io {
namespace {

bool is_number(std::string_view word) {
  double value = 0;
  return parse_number(word, value);
}

}  // namespace

LinesFile read_line_table(const Input& input) {
  LinesFile file;
  file.format = "table of points";
  bool goes_on = false, is_first = true;
  std::string_view rest = input.bytes;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(rest.size(), end + 1));
    if (line.starts_with('#')) continue;
    const std::vector<std::string_view> words = table_words(line);
    const bool are_titles = is_first && std::none_of(words.begin(), words.end(), is_number);
    is_first = is_first && words.empty();
    if (words.empty() || are_titles) {
      goes_on = false;
      continue;
    }
    std::array<double, 3> p{};
    if (words.size() != 3)
      input.fail_at_line(line.data(), fmt::format("{} values, not the three x, y, z", words.size()));
    for (std::size_t i = 0; i < 3; ++i)
      if (!parse_number(words[i], p[i]) || !std::isfinite(p[i]))
        input.fail_at_line(line.data(), fmt::format("{} is no finite number", in_quotes(words[i])));
    const auto v = static_cast<VertexIndex>(file.points.size());
    file.points.push_back({p[0], p[1], p[2]});
    if (goes_on) file.edges.push_back({v - 1, v});
    goes_on = true;
  }
  if (file.points.empty()) input.fail("has no points");
  return file;
}

}  // namespace octafront::io
