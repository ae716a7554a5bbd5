#include "periodic/periodic_map.h"

#include "base/core/elementary.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Points this near to the axis of a rotation, as a part of their distance from its point, lie on it: some roundings.
constexpr double kOnAxis = 1e-12;
constexpr double kPi = 3.14159265358979323846;

/// {cosine, sine} of degrees; exact for quarters of a turn.
std::array<double, 2> turned_by(double degrees) {
  const double quarters = std::round(degrees / 90);
  const double rest = (degrees - 90 * quarters) * (kPi / 180);
  const double c = elementary::cos(rest), s = elementary::sin(rest);
  const int way = static_cast<int>(quarters - 4 * std::floor(quarters / 4));
  return way == 0 ? std::array{c, s} : way == 1 ? std::array{-s, c} : way == 2 ? std::array{-c, -s} : std::array{s, -c};
}

}  // namespace

PeriodicMap PeriodicMap::translation(Vec3 shift) {
  PeriodicMap map;
  map.shift_ = shift;
  return map;
}

PeriodicMap PeriodicMap::rotation(double degrees, Vec3 point, Vec3 direction) {
  PeriodicMap map;
  map.turns_ = true;
  map.degrees_ = degrees, map.point_ = point, map.direction_ = normalized(direction);
  const auto [c, s] = turned_by(degrees);
  const Vec3 d = map.direction_;
  const double rest = 1 - c;
  map.rows_ = {{{c + rest * d.x * d.x, rest * d.x * d.y - s * d.z, rest * d.x * d.z + s * d.y},
                {rest * d.y * d.x + s * d.z, c + rest * d.y * d.y, rest * d.y * d.z - s * d.x},
                {rest * d.z * d.x - s * d.y, rest * d.z * d.y + s * d.x, c + rest * d.z * d.z}}};
  map.shift_ = point - map.turn(point);
  return map;
}

bool PeriodicMap::is_on_axis(Vec3 p) const {
  if (!turns_) return false;
  const Vec3 q = p - point_;
  const double size = std::max({length(q), length(p), length(point_)});
  return length(cross(q, direction_)) <= kOnAxis * size;
}

Vec3 PeriodicMap::apply(Vec3 p) const {
  if (!turns_) return p + shift_;
  return is_on_axis(p) ? p : turn(p) + shift_;
}

Vec3 PeriodicMap::undo(Vec3 p) const {
  if (!turns_) return p - shift_;
  return is_on_axis(p) ? p : turn_back(p - shift_);
}

Vec3 PeriodicMap::onto_axis(Vec3 p, double tolerance) const {
  if (!turns_) return p;
  const Vec3 foot = point_ + direction_ * dot(p - point_, direction_);
  return distance(p, foot) <= tolerance ? foot : p;
}

std::string PeriodicMap::in_words() const {
  if (!turns_) return fmt::format("by ({:.6g}, {:.6g}, {:.6g})", shift_.x, shift_.y, shift_.z);
  return fmt::format("by {:.6g} degrees about the axis through ({:.6g}, {:.6g}, {:.6g}) along ({:.6g}, {:.6g}, {:.6g})",
                     degrees_, point_.x, point_.y, point_.z, direction_.x, direction_.y, direction_.z);
}

}  // namespace octafront
