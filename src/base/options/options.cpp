#include <octafront/error.h>
#include <octafront/option_table.h>
#include <octafront/options.h>

#include "base/core/doubles.h"

#include <cmath>
#include <system_error>

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

double viscosity_of(const std::string& fluid) {
  if (fluid == "air") return 1.5e-5;
  if (fluid == "water") return 1e-6;
  double nu = 0;
  const char* const end = fluid.data() + fluid.size();
  const auto [at, error] = io::double_from_chars(fluid.data(), end, nu);
  if (error != std::errc() || at != end || !std::isfinite(nu) || nu <= 0)
    throw OptionError(fmt::format("`fluid` is \"{}\": write air, water, or a kinematic viscosity in m2/s", fluid));
  return nu;
}

}  // namespace octafront
