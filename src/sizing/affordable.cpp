#include "sizing/affordable.h"

#include <octafront/error.h>

#include "base/geometry/measures.h"
#include "sizing/size_sources.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Rays that look for walls: enough for the first digit of the number.
constexpr int kRaysForGaps = 1024;
/// The angle that the inside fills around a feature curve, taken to be a right one.
constexpr double kInsideAngle = std::numbers::pi / 2;

}  // namespace

Affordable::Affordable(const SurfaceMesh& surface, const SizeOptions& options)
    : surface_(surface), gradation_(options.gradation), least_(options.min_size.value_or(0)) {
  area_.reserve(surface.triangles.size());
  for (const auto& [a, b, c] : surface.triangles) {
    area_.push_back(triangle_area(surface.points[a], surface.points[b], surface.points[c]));
    all_area_ += area_.back();
  }
  if (all_area_ > 0) depth_ = std::abs(enclosed_volume(surface)) / all_area_;
}

void Affordable::curvature(double elements, const SurfaceCurvature& of_faces) const {
  const double turn = 2 * std::numbers::pi / elements;
  require("curvature", elements, tets_on_faces([&](std::size_t f) { return turn / of_faces.largest[f]; }));
}

void Affordable::max_deviation(double distance, const SurfaceCurvature& of_faces) const {
  require("max_deviation", distance,
          tets_on_faces([&](std::size_t f) { return size_of_chord_error(distance, of_faces.largest[f]); }));
}

/// The corners of an equilateral triangle lie h / sqrt(3) from its centre, where it is parallel to the surface.
void Affordable::normal_deviation(double degrees, const SurfaceCurvature& of_faces) const {
  const double turn = degrees * std::numbers::pi / 180;
  require("normal_deviation", degrees,
          tets_on_faces([&](std::size_t f) { return std::numbers::sqrt3 * turn / of_faces.largest[f]; }));
}

void Affordable::feature_elements(double elements, const std::vector<FeatureCurve>& curves) const {
  double tets = 0;
  for (const FeatureCurve& curve : curves) tets += tets_around(curve.length, curve.length / elements);
  require("feature_elements", elements, tets);
}

void Affordable::gap(double elements, const GapFinder& gaps) const {
  const double step = all_area_ / kRaysForGaps;
  double passed = 0, next = 0.5 * step, tets = 0;
  for (std::uint32_t f = 0; f < area_.size(); ++f) {
    passed += area_[f];
    const double places = std::ceil((passed - next) / step);
    if (!(places > 0)) continue;
    next += places * step;
    const auto& [i, j, k] = surface_.triangles[f];
    const Vec3 a = surface_.points[i], b = surface_.points[j], c = surface_.points[k];
    tets += tets_behind(places * step, gaps.measure({centroid(a, b, c), unit_normal(a, b, c), f}) / elements);
  }
  require("gap", elements, tets);
}

double Affordable::tets_by(const std::vector<double>& face) const {
  return tets_on_faces([&](std::size_t f) { return face[f]; });
}

template <class SizeOfFace>
double Affordable::tets_on_faces(SizeOfFace&& size_of_face) const {
  double sum = 0;
  for (std::size_t f = 0; f < area_.size(); ++f) sum += tets_behind(area_[f], size_of_face(f));
  return sum;
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
  if (tets <= static_cast<double>(kMostElements)) return;
  throw OptionError(fmt::format(
      "`{}` of {:.4g} would give about {:.3g} elements, more than the {} that a mesh can hold: ask for less, or set "
      "`min_size`",
      wish, value, tets, kMostElements));
}

}  // namespace octafront
