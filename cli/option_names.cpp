#include "option_names.h"

namespace octafront::cli {

namespace {

constexpr std::string_view kFieldCharacters = "abcdefghijklmnopqrstuvwxyzRL_";

}  // namespace

std::string OptionNames::translated(std::string_view text) const {
  std::string out;
  while (!text.empty()) {
    const std::size_t begin = text.find('`');
    out += text.substr(0, begin);
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin + 1);
    const std::size_t end = text.find_first_not_of(kFieldCharacters);
    if (end == 0 || end == std::string_view::npos || text[end] != '`') {
      out += '`';
      continue;
    }
    const auto found = option_of_.find(text.substr(0, end));
    out += found != option_of_.end() ? std::string_view(found->second) : text.substr(0, end);
    text.remove_prefix(end + 1);
  }
  return out;
}

}  // namespace octafront::cli
