#include <octafront/surface_mesh.h>

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "sizing/field/affordable.h"
#include "sizing/sources/wanted_sizes.h"

#include <algorithm>
#include <cmath>
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

/// A triangle is looked at in so many places that this many are on the whole surface at least, as far as so many on
/// its edges suffice.
constexpr double kLookedAt = 4000;
constexpr int kMostOnEdge = 32;

int parts_of_edge(double area, double whole) {
  return std::clamp(static_cast<int>(std::ceil(std::sqrt(kLookedAt * area / whole))), 1, kMostOnEdge);
}

/// Where so much of the elements is made for so little of the surface, it is said.
constexpr double kBulk = 0.5, kFewPlaces = 0.25;

/// The option that drops what a source asks for, as words that follow.
std::string advice_on(const std::string& source) {
  if (source == "`gap`" || source == "`through`" || source == "`curvature`" || source == "`feature_elements`")
    return fmt::format(": a smaller {}, or `min_size`, saves them", source);
  if (source == kNearbyName) return ": a larger `gradation`, or `min_size`, saves them";
  if (source == "thin round places") return ": `min_size` saves them";
  return "";
}

std::string percent(double part) {
  return part < 0.001 ? "under 0.1" : fmt::format("{:.3g}", 100 * part);
}

}  // namespace

RawVector<SourceShares::Place> SourceShares::places_on(const SurfaceMesh& surface) {
  constexpr std::size_t kFaces = 512;
  const double whole = area(surface);
  const auto add_places = [&](std::uint32_t f, std::vector<Place>& places) {
    const auto& [i, j, k] = surface.triangles[f];
    const Vec3 a = surface.points[i], b = surface.points[j], c = surface.points[k], n = unit_normal(a, b, c);
    const double area = triangle_area(surface.points, surface.triangles[f]);
    const int parts = parts_of_edge(area, whole);
    const auto add = [&](double u, double v) {
      places.push_back({{a + (b - a) * (u / (3 * parts)) + (c - a) * (v / (3 * parts)), n, f}, area / (parts * parts)});
    };
    // The middles of its parts, those that lie as it does and those that are turned.
    for (int u = 0; u < parts; ++u)
      for (int v = 0; u + v < parts; ++v) {
        add(3 * u + 1, 3 * v + 1);
        if (u + v + 1 < parts) add(3 * u + 2, 3 * v + 2);
      }
  };
  return parallel_collect<Place, RawVector<Place>>(surface.triangles.size(), kFaces,
                                                   [&](std::size_t begin, std::size_t end, std::vector<Place>& places) {
                                                     for (std::size_t f = begin; f < end; ++f)
                                                       add_places(static_cast<std::uint32_t>(f), places);
                                                   });
}

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

SourceShares::Asked SourceShares::least_at(const Place& place, const std::vector<double>& face) const {
  Asked least{face[place.on.face], of_face_[place.on.face]};
  // The largest of sizes that are given everywhere is nobody's: who gives them asks for it.
  const bool is_given = names_[least.source] == kNobody && !places_.empty();
  for (const AtPlace& source : places_)
    if (const double size = source.at(place.on); size < least.size || (is_given && names_[least.source] == kNobody))
      least = {size, source.number};
  return least;
}

RawVector<SourceShares::Asked> SourceShares::least_at_all(const RawVector<Place>& places,
                                                          const std::vector<double>& face) const {
  RawVector<Asked> asked(places.size());
  // What is asked in batches is asked for all places at once.
  const bool is_batched = std::ranges::any_of(places_, [](const AtPlace& s) { return s.at.batched != nullptr; });
  if (!is_batched) {
    // Places of one triangle are asked for by one thread: see GapFinder::width().
    const auto is_first = [&](std::size_t i) { return i == 0 || places[i].on.face != places[i - 1].on.face; };
    parallel_ranges(places.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
      while (begin < end && !is_first(begin)) ++begin;
      if (begin == end) return;
      for (std::size_t i = begin; i < end || (i < places.size() && !is_first(i)); ++i)
        asked[i] = least_at(places[i], face);
    });
    return asked;
  }
  for (const Place& place : places) least_at(place, face);
  for (const AtPlace& source : places_)
    if (source.at.batched) source.at.batched->fetch();
  for (std::size_t i = 0; i < places.size(); ++i) asked[i] = least_at(places[i], face);
  return asked;
}

std::vector<SourceShares::Part> SourceShares::part_of_each(const SurfaceMesh& surface, const std::vector<double>& face,
                                                           const SizeField& field, const SizeOptions& options,
                                                           double factor) const {
  const RawVector<Place> places = places_on(surface);
  const RawVector<Asked> asked = least_at_all(places, face);
  std::vector<double> least_of(names_.size(), HUGE_VAL);
  for (const Asked& a : asked) least_of[a.source] = std::min(least_of[a.source], a.size);
  // Smaller sizes nearby that one source alone asks for are its own, where it is asked here, too.
  const auto is_own = [&](const Asked& here, double came_out) {
    for (std::size_t s = 0; s < least_of.size(); ++s)
      if (s != here.source && least_of[s] < here.size) return false;
    return least_of[here.source] <= came_out / kNearby && options.regions.empty();
  };
  const Affordable affordable(surface, options);
  RawVector<std::uint16_t> by(places.size());
  RawVector<double> elements(places.size());
  parallel_for(places.size(), [&](std::size_t i) {
    const double came_out = field.at(places[i].on.p) / factor;
    elements[i] = affordable.tets_behind(places[i].area, came_out);
    // Numbers of elements scale all sizes: then only who asks for the least is known.
    const bool is_lower = !options.elements && came_out < kNearby * asked[i].size && !is_own(asked[i], came_out);
    by[i] = static_cast<std::uint16_t>(is_lower ? names_.size() + is_by_region(options, places[i].on.p, came_out)
                                                : asked[i].source);
  });
  std::vector<Part> part(names_.size() + 2);
  Part whole;
  for (std::size_t i = 0; i < places.size(); ++i) {
    part[by[i]].of_surface += places[i].area, part[by[i]].of_elements += elements[i];
    whole.of_surface += places[i].area, whole.of_elements += elements[i];
  }
  for (Part& p : part) p.of_surface /= whole.of_surface, p.of_elements /= whole.of_elements;
  return part;
}

void SourceShares::tell(const SurfaceMesh& surface, const std::vector<double>& face, const SizeField& field,
                        const SizeOptions& options, const Stage& stage, double factor) const {
  const std::vector<Part> part = part_of_each(surface, face, field, options, factor);
  std::vector<std::string> names = names_;
  names.emplace_back(kNearbyName);
  names.emplace_back("`regions`");
  std::vector<std::pair<Part, std::string>> shares;
  // Who was asked in vain is told too.
  const auto is_asked = [&](std::size_t s) {
    return std::ranges::any_of(places_, [s](const AtPlace& source) { return source.number == s; });
  };
  for (std::size_t s = 0; s < part.size(); ++s)
    if (part[s].of_surface > 0 || is_asked(s)) shares.emplace_back(part[s], names[s]);
  std::stable_sort(shares.begin(), shares.end(),
                   [](const auto& a, const auto& b) { return a.first.of_surface > b.first.of_surface; });
  std::string sentence;
  for (const auto& [share, name] : shares) {
    if (share.of_surface > 0) {
      stage.count(fmt::format("asked by {}, % of the surface", name), 100 * share.of_surface);
      stage.count(fmt::format("made for {}, % of the elements", name), 100 * share.of_elements);
    }
    sentence += fmt::format("{}{} over {} %", sentence.empty() ? "" : ", ", name,
                            share.of_surface > 0 ? percent(share.of_surface) : "0");
  }
  if (given_sources(options) > 1) stage.note("sizes are asked by " + sentence + " of the surface");
  for (const auto& [share, name] : shares)
    if (share.of_elements > kBulk && share.of_surface < kFewPlaces)
      stage.note(fmt::format("{} over {} % of the surface makes about {} % of the elements{}", name,
                             percent(share.of_surface), percent(share.of_elements), advice_on(name)));
}

}  // namespace octafront
