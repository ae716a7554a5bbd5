#include "periodic/map_finder.h"

#include <octafront/error.h>

#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "base/places/places.h"
#include "periodic/face_names.h"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/core.h>

namespace octafront::periods {

namespace {

/// Faces that are led onto each other look opposite ways up to this cosine: triangles of curved ones differ.
constexpr double kOpposite = -0.9;

class MapFinder {
 public:
  MapFinder(const SurfaceMesh& surface, const PeriodicCell& cell, double tolerance)
      : surface_(surface), cell_(cell), tolerance_(tolerance), tree_(surface), face_(surface.triangles.size(), kNone) {}

  std::vector<CellFace> run(const std::vector<AskedMap>& asked) {
    for (std::size_t k = 0; k < asked.size(); ++k) {
      const auto low = static_cast<CellFace>(2 * k);
      if (asked[k].low.empty()) {
        find(low);
      } else {
        take(asked[k].low, low), take(asked[k].high, low + 1);
      }
    }
    return std::move(face_);
  }

 private:
  void take(const std::string& name, CellFace face) {
    const SurfacePlaces places(surface_);
    for (const std::uint32_t t : places.at("periodic", place_of("periodic", name)).triangles) put(t, face);
  }

  void put(std::uint32_t t, CellFace face) {
    if (face_[t] != kNone && face_[t] != face) {
      const auto [a, b, c] = corners(t);
      throw InputError(fmt::format(
          "the surface at {} would be {} and {} at once: name the patches that each map leads to each other, with "
          "LOW:HIGH= before it",
          at_point(centroid(a, b, c)), name_of_face(cell_, face_[t]), name_of_face(cell_, face)));
    }
    face_[t] = face;
  }

  std::array<Vec3, 3> corners(std::uint32_t t) const {
    const auto [a, b, c] = surface_.triangles[t];
    return {surface_.points[a], surface_.points[b], surface_.points[c]};
  }

  /// The direction from what is inside to the outside; 0 within the body.
  Vec3 outward(std::uint32_t t) const {
    const auto [a, b, c] = corners(t);
    const auto [front, behind] = surface_.sides[t];
    if ((front == kNone) == (behind == kNone)) return {};
    const Vec3 n = normalized(double_area_normal(a, b, c));
    return front == kNone ? n : -n;
  }

  void find(CellFace low) {
    const PeriodicMap& map = cell_.mapped[low / 2].map;
    Vec3 toward;
    for (std::uint32_t t = 0; t < face_.size(); ++t) {
      const Vec3 n = outward(t);
      if (n == Vec3{}) continue;
      const bool is_low = is_led(
          t, n, [&](Vec3 p) { return map.apply(p); }, [&](Vec3 v) { return map.turn(v); });
      const bool is_high = is_led(
          t, n, [&](Vec3 p) { return map.undo(p); }, [&](Vec3 v) { return map.turn_back(v); });
      if (!is_low && !is_high) continue;
      const auto [a, b, c] = corners(t);
      const Vec3 way = map.apply(centroid(a, b, c)) - centroid(a, b, c);
      if (toward == Vec3{}) toward = is_low ? way : -way;
      // Half a turn leads both faces onto each other: the first one found is low.
      put(t, is_low && (!is_high || dot(way, toward) > 0) ? low : low + 1);
    }
    if (toward != Vec3{}) return;
    throw InputError(fmt::format(
        "`periodic`: the map {} leads no part of the surface onto another one that looks the other way. Faces that "
        "are triangulated in other ways and curved have to be named: LOW:HIGH= before the map",
        map.in_words()));
  }

  /// Whether its corners and its middle come onto the surface, the middle onto what looks the other way.
  template <class Move, class Turn>
  bool is_led(std::uint32_t t, Vec3 outward_of_t, const Move& move, const Turn& turn) const {
    const auto [a, b, c] = corners(t);
    for (const Vec3 p : {a, b, c})
      if (!tree_.is_within(move(p), tolerance_)) return false;
    const Vec3 middle = move(centroid(a, b, c)), way = turn(outward_of_t);
    const Vec3 reach{tolerance_, tolerance_, tolerance_};
    return !tree_.for_each_box_near({middle - reach, middle + reach}, [&](std::uint32_t u, const TriangleCorners& at) {
      if (distance(closest_point_on_triangle(middle, at[0], at[1], at[2]), middle) > tolerance_) return true;
      return !(dot(outward(u), way) < kOpposite);
    });
  }

  const SurfaceMesh& surface_;
  const PeriodicCell& cell_;
  const double tolerance_;
  const TriangleTree tree_;
  std::vector<CellFace> face_;
};

}  // namespace

std::vector<CellFace> mapped_faces(const SurfaceMesh& surface, const PeriodicCell& cell,
                                   const std::vector<AskedMap>& asked, double tolerance) {
  return MapFinder(surface, cell, tolerance).run(asked);
}

}  // namespace octafront::periods
