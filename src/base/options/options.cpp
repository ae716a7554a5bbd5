#include <octafront/option_table.h>

#include <fmt/core.h>

namespace octafront {

std::string OptionInfo::range() const {
  std::string words;
  if (!choices.empty()) {
    for (const std::string_view choice : choices) words += (words.empty() ? "" : " or ") + std::string(choice);
    return words;
  }
  if (least && most && !is_above && !is_below) return fmt::format("from {} to {}", *least, *most);
  if (least) words = fmt::format("{} {}", is_above ? "above" : "at least", *least);
  if (most) words += fmt::format("{}{} {}", words.empty() ? "" : " and ", is_below ? "below" : "at most", *most);
  return words;
}

}  // namespace octafront
