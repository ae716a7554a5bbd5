#include "sizing/field/affordable.h"

#include <octafront/error.h>
#include <octafront/surface_mesh.h>

#include "base/core/elementary.h"
#include "base/core/index_range.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Places that are looked at: enough for the first digit of the number.
constexpr int kPlaces = 1024;
/// The angle that the inside fills around a feature curve, taken to be a right one.
constexpr double kInsideAngle = std::numbers::pi / 2;

}  // namespace

double size_of_elements(double volume, std::int64_t elements) {
  return elementary::cbrt(kTetsPerCube * volume / static_cast<double>(elements));
}

void require_affordable(const std::string& what, double tets, const char* advice) {
  if (tets <= static_cast<double>(kMostElements)) return;
  throw OptionError(fmt::format("{} would give about {:.3g} elements, more than the {} that a mesh can hold: {}", what,
                                tets, kMostElements, advice));
}

Affordable::Affordable(const SurfaceMesh& surface, const SizeOptions& options)
    : gradation_(options.gradation.value_or(kDefaultGradation)), least_(options.min_size.value_or(0)) {
  area_.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles) {
    area_.push_back(triangle_area(surface.points, t));
    all_area_ += area_.back();
  }
  if (all_area_ > 0) depth_ = std::abs(enclosed_volume(surface)) / all_area_;
}

double Affordable::tets_on_faces(const SizeOfFace& size) const {
  double sum = 0;
  for (std::size_t f = 0; f < area_.size(); ++f) sum += tets_behind(area_[f], size(f));
  return sum;
}

double Affordable::tets_at_places(const SizeOfFace& size) const {
  const double step = all_area_ / kPlaces;
  double passed = 0, next = 0.5 * step, tets = 0;
  for (std::size_t f = 0; f < area_.size(); ++f) {
    passed += area_[f];
    const double places = std::ceil((passed - next) / step);
    if (!(places > 0)) continue;
    next += places * step;
    tets += tets_behind(places * step, size(f));
  }
  return tets;
}

/// Sizes grow from h on the surface: the integral of kTetsPerCube / (h + g d)^3 over the mean depth of the model.
double Affordable::tets_behind(double area, double h) const {
  if (!std::isfinite(h)) return 0;
  const double near = std::max(h, least_), deep = near + gradation_ * depth_;
  return kTetsPerCube * area * (1 / (near * near) - 1 / (deep * deep)) / (2 * gradation_);
}

/// The same around a curve: the integral of angle r kTetsPerCube / (h + g r)^3.
double Affordable::tets_around(double length, double h) const {
  const double near = std::max(h, least_), deep = near + gradation_ * depth_;
  return kTetsPerCube * kInsideAngle * length * depth_ * depth_ / (2 * near * deep * deep);
}

void Affordable::require(const char* wish, double value, double tets) const {
  require_affordable(fmt::format("`{}` of {:.4g}", wish, value), tets, "ask for less, or set `min_size`");
}

}  // namespace octafront
