#include "sizing/sources/shares.h"

#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Sizes that come out below this part of what a source asks for on a triangle follow smaller ones nearby.
constexpr double kNearby = 0.75;
constexpr std::size_t kMostSources = 250;
const char* const kNearbyName = "smaller sizes nearby";

/// How many sources the user named.
int given_sources(const SizeOptions& o) {
  return int(o.size.has_value()) + int(o.elements.has_value()) + int(o.curvature.has_value()) + int(o.gap.has_value()) +
         int(o.feature_elements.has_value()) + int(o.facets) + int(!o.regions.empty()) + int(!o.point_sizes.empty()) +
         int(!o.named.empty()) + int(o.callback != nullptr) + 2 * int(o.through.has_value()) +
         2 * int(!o.near.empty()) + 2 * int(o.mesh != nullptr);
}

/// Whether some region asks for about as little as came out at a place.
bool is_by_region(const SizeOptions& options, Vec3 p, double size) {
  return std::ranges::any_of(options.regions, [&](const SizeRegion& r) {
    const double away = std::max(0.0, distance(max(r.lo, min(p, r.hi)), p) - r.radius);
    return away <= r.size && r.size <= size / kNearby;
  });
}

std::string percent(double part) {
  return part < 0.001 ? "under 0.1" : fmt::format("{:.3g}", 100 * part);
}

}  // namespace

std::uint8_t SourceShares::number_of(const std::string& name) {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found != names_.end()) return static_cast<std::uint8_t>(found - names_.begin());
  if (names_.size() >= kMostSources) return static_cast<std::uint8_t>(names_.size() - 1);
  names_.push_back(name);
  return static_cast<std::uint8_t>(names_.size() - 1);
}

void SourceShares::begin(std::string base, const std::vector<double>& face) {
  of_face_.assign(face.size(), number_of(base));
  last_ = face;
}

void SourceShares::changed(const std::string& by, const std::vector<double>& face) {
  if (face == last_) return;
  const std::uint8_t number = number_of(by);
  for (std::size_t f = 0; f < face.size(); ++f)
    if (face[f] != last_[f]) of_face_[f] = number;
  last_ = face;
}

void SourceShares::add(std::string by, SizeAtPlace at) {
  if (at) places_.push_back({number_of(by), std::move(at)});
}

std::vector<double> SourceShares::part_of_each(const SurfaceMesh& surface, const std::vector<double>& face,
                                               const SizeField& field, const SizeOptions& options,
                                               double factor) const {
  // What is asked in batches is asked for all triangles at once.
  const auto least_at = [&](std::size_t f, const PlaceOnSurface& place) {
    std::pair<double, std::uint8_t> least{face[f], of_face_[f]};
    for (const AtPlace& source : places_)
      if (const double size = source.at(place); size < least.first) least = {size, source.number};
    return least;
  };
  const auto place_of = [&](std::size_t f) {
    const auto& [i, j, k] = surface.triangles[f];
    const Vec3 a = surface.points[i], b = surface.points[j], c = surface.points[k];
    return PlaceOnSurface{centroid(a, b, c), unit_normal(a, b, c), static_cast<std::uint32_t>(f)};
  };
  const auto by_whom = [&](std::size_t f) {
    const PlaceOnSurface place = place_of(f);
    const auto [asked, source] = least_at(f, place);
    const double came_out = field.at(place.p) / factor;
    // Numbers of elements scale all sizes: then only who asks for the least is known.
    const bool is_lower = !options.elements && came_out < kNearby * asked;
    if (!is_lower) return std::size_t{source};
    return names_.size() + is_by_region(options, place.p, came_out);
  };
  std::vector<std::uint16_t> by(face.size());
  const auto ask = [&](std::size_t f) { by[f] = static_cast<std::uint16_t>(by_whom(f)); };
  if (std::ranges::any_of(places_, [](const AtPlace& s) { return s.at.batched != nullptr; })) {
    for (std::size_t f = 0; f < face.size(); ++f) least_at(f, place_of(f));
    for (const AtPlace& source : places_)
      if (source.at.batched) source.at.batched->fetch();
    for (std::size_t f = 0; f < face.size(); ++f) ask(f);
  } else {
    parallel_for(face.size(), ask);
  }
  std::vector<double> part(names_.size() + 2);
  for (std::size_t f = 0; f < face.size(); ++f) {
    const auto& [i, j, k] = surface.triangles[f];
    part[by[f]] += triangle_area(surface.points[i], surface.points[j], surface.points[k]);
  }
  const double whole = area(surface);
  for (double& p : part) p /= whole;
  return part;
}

void SourceShares::tell(const SurfaceMesh& surface, const std::vector<double>& face, const SizeField& field,
                        const SizeOptions& options, const Stage& stage, double factor) const {
  const std::vector<double> part = part_of_each(surface, face, field, options, factor);
  std::vector<std::string> names = names_;
  names.emplace_back(kNearbyName);
  names.emplace_back("`regions`");
  std::vector<std::pair<double, std::string>> shares;
  // Who was asked in vain is told too.
  const auto is_asked = [&](std::size_t s) {
    return std::ranges::any_of(places_, [s](const AtPlace& source) { return source.number == s; });
  };
  for (std::size_t s = 0; s < part.size(); ++s)
    if (part[s] > 0 || is_asked(s)) shares.emplace_back(part[s], names[s]);
  std::stable_sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string sentence;
  for (const auto& [share, name] : shares) {
    if (share > 0) stage.count(fmt::format("asked by {}, % of the surface", name), 100 * share);
    sentence += fmt::format("{}{} over {} %", sentence.empty() ? "" : ", ", name, share > 0 ? percent(share) : "0");
  }
  if (given_sources(options) > 1) stage.note("sizes are asked by " + sentence + " of the surface");
}

}  // namespace octafront
