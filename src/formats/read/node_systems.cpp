#include "formats/read/node_systems.h"

#include "base/core/elementary.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace octafront::io {
namespace {

bool set_axes(NodeSystem& system, Vec3 x, Vec3 y, Vec3 z) {
  if (!(squared_length(x) > 0) || !(squared_length(y) > 0) || !(squared_length(z) > 0)) return false;
  system.axes = {normalized(x), normalized(y), normalized(z)};
  return true;
}

}  // namespace

std::pair<double, double> sine_and_cosine(double degrees) {
  const double turns = degrees / 90;
  constexpr double kMostTurns = 1e9;  // that are counted exactly
  if (turns == std::floor(turns) && std::abs(turns) < kMostTurns) {
    constexpr std::array<double, 4> kSines{0, 1, 0, -1};
    const auto quarter = static_cast<std::size_t>((static_cast<std::int64_t>(turns) % 4 + 4) % 4);
    return {kSines[quarter], kSines[(quarter + 1) % 4]};
  }
  const double angle = degrees * (std::numbers::pi / 180);
  return {elementary::sin(angle), elementary::cos(angle)};
}

Vec3 NodeSystem::global(Vec3 p) const {
  if (kind == Kind::kCylindrical) {
    const auto [s, c] = sine_and_cosine(p.y);
    p = {p.x * c, p.x * s, p.z};
  } else if (kind != Kind::kRectangular) {
    const auto [s, c] = sine_and_cosine(kind == Kind::kPolar ? p.z : p.y);
    const auto [polar_out, polar_up] = sine_and_cosine(p.y);
    const auto [latitude_up, latitude_out] = sine_and_cosine(p.z);
    const double out = kind == Kind::kPolar ? polar_out : latitude_out;
    p = {p.x * out * c, p.x * out * s, p.x * (kind == Kind::kPolar ? polar_up : latitude_up)};
  }
  return origin + axes[0] * p.x + axes[1] * p.y + axes[2] * p.z;
}

bool set_axes_by_xy(NodeSystem& system, Vec3 x, Vec3 near_y) {
  const Vec3 z = cross(x, near_y);
  return set_axes(system, x, cross(z, x), z);
}

bool set_axes_by_zx(NodeSystem& system, Vec3 z, Vec3 near_x) {
  const Vec3 y = cross(z, near_x);
  return set_axes(system, cross(y, z), y, z);
}

}  // namespace octafront::io
