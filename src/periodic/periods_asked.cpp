#include "periodic/periods_asked.h"

#include <octafront/error.h>

#include "base/core/doubles.h"
#include "periodic/periodic_cell.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include <fmt/core.h>

namespace octafront {

namespace {

/// A turn by less than this many degrees, or by a whole turn but for so much, leads nowhere.
constexpr double kLeastTurn = 1e-3;

class PeriodReader {
 public:
  PeriodReader(std::string_view option, std::string_view text) : option_(option), text_(text) {}

  AskedMap read(std::string_view item) const {
    AskedMap asked{PeriodicMap::translation({}), {}, {}};
    if (const std::size_t equals = item.rfind('='); equals != std::string_view::npos) {
      const std::string_view names = item.substr(0, equals);
      const std::size_t colon = names.find(':');
      if (colon == std::string_view::npos || colon == 0 || colon + 1 == names.size()) refuse();
      asked.low = names.substr(0, colon), asked.high = names.substr(colon + 1);
      item.remove_prefix(equals + 1);
    }
    const std::size_t at = item.find('@');
    asked.map = at == std::string_view::npos ? translation(item) : rotation(item.substr(0, at), item.substr(at + 1));
    return asked;
  }

 private:
  PeriodicMap translation(std::string_view words) const {
    const std::vector<double> shift = numbers(words, ',');
    if (shift.size() != 3 || (shift[0] == 0 && shift[1] == 0 && shift[2] == 0)) refuse();
    return PeriodicMap::translation({shift[0], shift[1], shift[2]});
  }

  PeriodicMap rotation(std::string_view angle, std::string_view axis) const {
    const std::vector<double> parts = numbers(angle, '/');
    const double degrees = parts.size() == 1 ? parts[0] : parts.size() == 2 && parts[1] != 0 ? parts[0] / parts[1] : 0;
    if (!(std::abs(degrees) >= kLeastTurn && std::abs(degrees) <= 360 - kLeastTurn)) refuse();
    Vec3 point, direction;
    if (const auto named =
            axis.size() == 1 ? std::find(kAxisNames.begin(), kAxisNames.end(), axis[0]) : kAxisNames.end();
        named != kAxisNames.end()) {
      direction[static_cast<int>(named - kAxisNames.begin())] = 1;
    } else {
      const std::vector<double> six = numbers(axis, ',');
      if (six.size() != 6) refuse();
      point = {six[0], six[1], six[2]}, direction = {six[3], six[4], six[5]};
    }
    if (!(length(direction) > 0)) refuse();
    return PeriodicMap::rotation(degrees, point, direction);
  }

  std::vector<double> numbers(std::string_view words, char between) const {
    std::vector<double> found;
    for (;;) {
      const std::size_t end = std::min(words.find(between), words.size());
      std::string_view word = words.substr(0, end);
      while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
      while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
      double value = 0;
      const auto [stop, error] = io::double_from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || stop != word.data() + word.size() || !std::isfinite(value)) refuse();
      found.push_back(value);
      if (end == words.size()) return found;
      words.remove_prefix(end + 1);
    }
  }

  [[noreturn]] void refuse() const {
    throw OptionError(fmt::format(
        "`{}` is \"{}\": write axes of a box (xyz), a translation X,Y,Z or a rotation DEGREES@z or "
        "DEGREES@PX,PY,PZ,DX,DY,DZ (a point and a direction of its axis), several with semicolons between, each with "
        "LOW:HIGH= before it where the names of the patches are to say what it leads to what",
        option_, text_));
  }

  std::string_view option_, text_;
};

}  // namespace

AskedPeriods periods_asked(std::string_view option, std::string_view text) {
  AskedPeriods asked;
  if (text.find_first_of(",@=;") == std::string_view::npos) {
    asked.along = axes_named(option, text);
    return asked;
  }
  const PeriodReader reader(option, text);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(';'), text.size());
    std::string_view item = text.substr(0, end);
    while (!item.empty() && item.front() == ' ') item.remove_prefix(1);
    asked.maps.push_back(reader.read(item));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  const bool turns = std::any_of(asked.maps.begin(), asked.maps.end(), [](const AskedMap& m) { return m.map.turns(); });
  if (turns && asked.maps.size() > 1)
    throw OptionError(fmt::format("`{}`: a rotation goes with no other period", option));
  return asked;
}

}  // namespace octafront
