#include "base/places/shape_place.h"

#include "base/core/doubles.h"

#include <array>
#include <cmath>
#include <string_view>

namespace octafront {
namespace {

using ShapeKind = ShapePlace::Kind;

struct ShapeWords {
  std::string_view one, many;
  ShapeKind kind;
};
constexpr std::array<ShapeWords, 11> kShapeWords{{{"face", "faces", ShapeKind::kFaces},
                                                  {"plane", "planes", ShapeKind::kPlanes},
                                                  {"cylinder", "cylinders", ShapeKind::kCylinders},
                                                  {"cone", "cones", ShapeKind::kCones},
                                                  {"sphere", "spheres", ShapeKind::kSpheres},
                                                  {"torus", "tori", ShapeKind::kTori},
                                                  {"free face", "free faces", ShapeKind::kFreeFaces},
                                                  {"edge", "edges", ShapeKind::kEdges},
                                                  {"line", "lines", ShapeKind::kLines},
                                                  {"circle", "circles", ShapeKind::kCircles},
                                                  {"point", "points", ShapeKind::kPoints}}};

bool take_front(std::string_view& text, std::string_view words) {
  if (!text.starts_with(words)) return false;
  text.remove_prefix(words.size());
  return true;
}

/// " at z min" at the end.
void take_end_of_axis(std::string_view& text, ShapePlace& place) {
  constexpr std::size_t kLength = 9;
  if (text.size() < kLength) return;
  const std::string_view end = text.substr(text.size() - kLength);
  if (!end.starts_with(" at ") || end[4] < 'x' || end[4] > 'z') return;
  if (!end.ends_with(" min") && !end.ends_with(" max")) return;
  place.axis = end[4] - 'x', place.at_max = end.ends_with(" max");
  text.remove_suffix(kLength);
}

/// " of radius 3": false where no length follows.
bool take_radius(std::string_view& text, ShapePlace& place) {
  if (!take_front(text, " of radius ")) return true;
  double radius = 0;
  const auto [stop, error] = io::double_from_chars(text.data(), text.data() + text.size(), radius);
  if (error != std::errc() || !(radius > 0) || !std::isfinite(radius)) return false;
  place.radius = radius;
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return true;
}

/// The kind at the front of a text, a word by itself.
std::optional<ShapeKind> take_kind(std::string_view& text) {
  for (const auto& [one, many, kind] : kShapeWords)
    for (const std::string_view word : {many, one})
      if (text.starts_with(word) && (text.size() == word.size() || text[word.size()] == ' '))
        return text.remove_prefix(word.size()), kind;
  return std::nullopt;
}

bool may_have_radius(ShapeKind kind) {
  return kind == ShapeKind::kCylinders || kind == ShapeKind::kSpheres || kind == ShapeKind::kTori ||
         kind == ShapeKind::kCircles;
}

}  // namespace

std::optional<ShapePlace> shape_place_of(const std::string& text) {
  ShapePlace place;
  std::string_view rest = text;
  if (take_front(rest, "largest "))
    place.which = ShapePlace::Which::kLargest;
  else if (take_front(rest, "smallest "))
    place.which = ShapePlace::Which::kSmallest;
  take_end_of_axis(rest, place);
  const std::optional<ShapeKind> kind = take_kind(rest);
  if (!kind || !take_radius(rest, place)) return std::nullopt;
  place.kind = *kind;
  if (take_front(rest, " of ")) place.of = rest, rest = {};
  if (place.radius && !may_have_radius(*kind)) return std::nullopt;
  if (place.which != ShapePlace::Which::kAll && *kind == ShapeKind::kPoints) return std::nullopt;
  return rest.empty() ? std::optional(place) : std::nullopt;
}

}  // namespace octafront
