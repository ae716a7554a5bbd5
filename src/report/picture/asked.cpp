#include <octafront/error.h>
#include <octafront/picture.h>

#include "base/core/doubles.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront {

namespace {

std::optional<double> number_in(std::string_view text) {
  double value = 0;
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = io::double_from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<Vec3> three_numbers(std::string_view text) {
  Vec3 made;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t end = axis < 2 ? text.find(',') : text.size();
    if (end == std::string_view::npos) return std::nullopt;
    const std::optional<double> value = number_in(text.substr(0, end));
    if (!value) return std::nullopt;
    made[axis] = *value;
    text.remove_prefix(std::min(text.size(), end + 1));
  }
  return made;
}

/// "x" and "-x".
std::optional<Vec3> axis_called(std::string_view text) {
  const bool is_turned = text.starts_with('-');
  if (is_turned || text.starts_with('+')) text.remove_prefix(1);
  if (text.size() != 1 || text[0] < 'x' || text[0] > 'z') return std::nullopt;
  Vec3 axis;
  axis[text[0] - 'x'] = is_turned ? -1 : 1;
  return axis;
}

/// "x=12.5" or "x=30%": what lies beyond along the axis goes.
std::optional<PictureCut> cut_at(Vec3 axis, std::string_view where) {
  PictureCut cut{axis};
  if (where.ends_with('%')) {
    const std::optional<double> percent = number_in(where.substr(0, where.size() - 1));
    if (!percent || !(*percent >= 0 && *percent <= 100)) return std::nullopt;
    cut.share = *percent / 100;
    return cut;
  }
  const std::optional<double> at = number_in(where);
  if (!at) return std::nullopt;
  const double sign = axis.x + axis.y + axis.z;
  cut.through = sign * *at * axis;
  return cut;
}

std::optional<PictureCut> cut_in(std::string_view text) {
  if (const std::size_t equals = text.find('='); equals != std::string_view::npos) {
    const std::optional<Vec3> axis = axis_called(text.substr(0, equals));
    return axis ? cut_at(*axis, text.substr(equals + 1)) : std::nullopt;
  }
  if (const std::optional<Vec3> axis = axis_called(text)) return PictureCut{*axis};
  const std::size_t colon = text.find(':');
  const std::optional<Vec3> normal = three_numbers(text.substr(0, colon));
  if (!normal || !(squared_length(*normal) > 0)) return std::nullopt;
  PictureCut cut{*normal};
  if (colon == std::string_view::npos) return cut;
  cut.through = three_numbers(text.substr(colon + 1));
  return cut.through ? std::optional(cut) : std::nullopt;
}

}  // namespace

const std::vector<std::pair<std::string, PictureOptions::Color>>& picture_colors() {
  using Color = PictureOptions::Color;
  static const std::vector<std::pair<std::string, Color>> names{{"quality", Color::kQuality},
                                                                {"region", Color::kRegion},
                                                                {"size", Color::kSize},
                                                                {"patch", Color::kPatch},
                                                                {"none", Color::kPlain}};
  return names;
}

const std::vector<std::pair<std::string, PictureOptions::Edges>>& picture_edges() {
  using Edges = PictureOptions::Edges;
  static const std::vector<std::pair<std::string, Edges>> names{
      {"elements", Edges::kElements}, {"features", Edges::kFeatures}, {"none", Edges::kOff}};
  return names;
}

PictureCut picture_cut(const std::string& text) {
  if (const std::optional<PictureCut> cut = cut_in(text)) return *cut;
  throw OptionError(
      fmt::format("\"{}\" is no cut: write x, -y, z=12.5, x=30%, a normal NX,NY,NZ, or NX,NY,NZ:X,Y,Z", text));
}

Vec3 picture_view(const std::string& text) {
  constexpr std::array<std::pair<std::string_view, Vec3>, 7> kViews{{{"iso", {1, -1, 1}},
                                                                     {"front", {0, -1, 0}},
                                                                     {"back", {0, 1, 0}},
                                                                     {"left", {-1, 0, 0}},
                                                                     {"right", {1, 0, 0}},
                                                                     {"top", {0, 0, 1}},
                                                                     {"bottom", {0, 0, -1}}}};
  for (const auto& [name, view] : kViews)
    if (text == name) return view;
  const std::optional<Vec3> view = three_numbers(text);
  if (view && squared_length(*view) > 0) return *view;
  throw OptionError(fmt::format(
      "\"{}\" is no view: write iso, front, back, left, right, top, bottom, or where the viewer is, X,Y,Z", text));
}

Vec3 picture_up(const std::string& text) {
  if (const std::optional<Vec3> axis = axis_called(text)) return *axis;
  const std::optional<Vec3> up = three_numbers(text);
  if (up && squared_length(*up) > 0) return *up;
  throw OptionError(fmt::format("\"{}\" is no direction: write x, -y and the like, or X,Y,Z", text));
}

}  // namespace octafront
