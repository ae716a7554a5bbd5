#include "base/core/renumber.h"
#include "base/geometry/measures.h"
#include "base/geometry/self_intersection.h"
#include "soup/mend/mend_steps.h"

#include <algorithm>
#include <span>
#include <utility>

namespace octafront::mend {
namespace {

/// Parts with less than this of their face's area come from rounding. Some lie outside of what they are cut from,
/// and none is missed.
constexpr double kRoundingOfParts = 1e-10;

/// A face of the input by its parts.
struct FaceParts {
  std::uint32_t in_all = 0, in_skin = 0;  ///< of the arrangement, and of these; those of rounding do not count
  std::uint32_t first = kNone;            ///< of the skin
  bool first_is_reversed = false;         ///< against the face
  bool face_both_ways = false;
  bool is_whole = false;  ///< nothing is missing, so that it can return
};

class WholeFaces {
 public:
  WholeFaces(const Arrangement& arranged, const std::vector<Triangle>& given, Skin& skin)
      : arranged_(arranged), given_(given), skin_(skin), parts_(given.size()), face_of_(skin.triangles.size(), kNone) {}

  void restore(const RunContext& context) {
    count_parts();
    while (leave_those_that_share_parts() || leave_those_with_points_that_stay()) {
    }
    Skin restored = with_faces_put_back();
    if (restored.triangles == skin_.triangles) return;
    // Parts are rounded: what passed beside them might cross the face, and what hung on them be left alone.
    if (is_closed(restored) && self_intersections(restored.points, restored.triangles, 1, context).empty())
      skin_ = std::move(restored);
  }

 private:
  std::span<const Origin> origins(std::uint32_t t) const { return arranged_.origins_of(skin_.wall[t]); }

  void count_parts() {
    for (std::uint32_t t = 0; t < arranged_.triangles.size(); ++t)
      for (const Origin& o : arranged_.origins_of(t))
        if (!is_of_rounding(t, o.triangle)) ++parts_[o.triangle].in_all;
    for (std::uint32_t t = 0; t < skin_.triangles.size(); ++t) {
      const bool is_turned = !is_rotation(skin_.triangles[t], arranged_.triangles[skin_.wall[t]]);
      for (const Origin& o : origins(t)) add_part(o.triangle, t, is_turned != o.reversed);
    }
    for (FaceParts& p : parts_) p.is_whole = !p.face_both_ways && p.in_skin > 0 && p.in_skin == p.in_all;
  }

  void add_part(std::uint32_t face, std::uint32_t t, bool is_reversed) {
    FaceParts& parts = parts_[face];
    if (parts.first == kNone) parts.first = t, parts.first_is_reversed = is_reversed;
    parts.face_both_ways |= is_reversed != parts.first_is_reversed;
    if (!is_of_rounding(skin_.wall[t], face)) ++parts.in_skin;
  }

  double area_of(const Triangle& t) const {
    return triangle_area(arranged_.points[t[0]], arranged_.points[t[1]], arranged_.points[t[2]]);
  }
  bool is_of_rounding(std::uint32_t part, std::uint32_t face) const {
    return area_of(arranged_.triangles[part]) < kRoundingOfParts * area_of(given_[face]);
  }

  /// Whether as many triangles run along each edge one way as the other way.
  static bool is_closed(const Skin& skin) {
    std::vector<std::pair<Edge, int>> runs;
    for (const Triangle& t : skin.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexIndex a = t[k], b = t[(k + 1) % 3];
        runs.push_back({{std::min(a, b), std::max(a, b)}, a < b ? 1 : -1});
      }
    std::ranges::sort(runs);
    int sum = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      sum += runs[i].second;
      if (i + 1 < runs.size() && runs[i + 1].first == runs[i].first) continue;
      if (sum != 0) return false;
    }
    return true;
  }

  static bool is_rotation(const Triangle& a, const Triangle& b) {
    const auto at = std::find(b.begin(), b.end(), a[0]) - b.begin();
    return a[1] == b[(at + 1) % 3];
  }

  bool is_corner(VertexIndex v, std::uint32_t face) const {
    return std::ranges::find(given_[face], v) != given_[face].end();
  }

  /// What lies on each other cannot return side by side. True if there was any.
  bool leave_those_that_share_parts() {
    bool any = false;
    for (std::uint32_t t = 0; t < skin_.triangles.size(); ++t) {
      const auto is_whole = [&](const Origin& o) { return parts_[o.triangle].is_whole; };
      const bool shared = std::ranges::count_if(origins(t), is_whole) > 1;
      face_of_[t] = kNone;
      for (const Origin& o : origins(t)) {
        if (shared) parts_[o.triangle].is_whole = false;
        if (is_whole(o)) face_of_[t] = o.triangle;
      }
      any |= shared;
    }
    return any;
  }

  /// Of faces that share a divided edge, or a corner that was brought to another point, all return or none does. True
  /// if some were left that seemed whole.
  bool leave_those_with_points_that_stay() {
    std::vector<char> stays(arranged_.points.size(), 0);
    for (std::uint32_t t = 0; t < skin_.triangles.size(); ++t)
      for (const VertexIndex v : skin_.triangles[t])
        if (face_of_[t] == kNone || is_corner(v, face_of_[t])) stays[v] = 1;
    bool any = false;
    for (std::uint32_t t = 0; t < skin_.triangles.size(); ++t) {
      const std::uint32_t face = face_of_[t];
      if (face == kNone ||
          std::ranges::none_of(skin_.triangles[t], [&](VertexIndex v) { return stays[v] && !is_corner(v, face); }))
        continue;
      any |= parts_[face].is_whole;
      parts_[face].is_whole = false;
    }
    return any;
  }

  Skin with_faces_put_back() const {
    Skin all{skin_.points, {}, {}, skin_.wall_area, skin_.idle_area};
    for (std::uint32_t t = 0; t < skin_.triangles.size(); ++t) {
      const std::uint32_t face = face_of_[t];
      Triangle triangle = skin_.triangles[t];
      if (face != kNone) {
        if (parts_[face].first != t) continue;
        triangle = given_[face];
        if (parts_[face].first_is_reversed) std::swap(triangle[1], triangle[2]);
      }
      all.triangles.push_back(triangle);
      all.wall.push_back(skin_.wall[t]);
    }
    return all;
  }

  const Arrangement& arranged_;
  const std::vector<Triangle>& given_;
  Skin& skin_;
  std::vector<FaceParts> parts_;        ///< per face
  std::vector<std::uint32_t> face_of_;  ///< per triangle of the skin, the whole face that it is a part of
};

/// Puts faces that were divided, and of which all parts came to be skin, back in the place of their parts: where a fin
/// that is gone crossed them nothing shall be left of it, for its cuts leave needles by which sizes would go. `given`:
/// the triangles that were arranged. Points that only such parts use are used no more. The points of `skin` are those
/// of the arrangement.
void restore_whole_faces(const Arrangement& arranged, const std::vector<Triangle>& given, Skin& skin,
                         const RunContext& context) {
  WholeFaces(arranged, given, skin).restore(context);
}

}  // namespace

Skin skin_of_cells(const Arrangement& arranged, const std::vector<Triangle>& given, const Cells& cells,
                   const Labels& labels, const RunContext& context) {
  Skin skin;
  skin.points = arranged.points;
  for (std::uint32_t t = 0; t < arranged.triangles.size(); ++t) {
    const auto [front, back] = cells.sides_of(t);
    const double size = triangle_area(arranged.points, arranged.triangles[t]);
    skin.wall_area += size;
    if (!labels.inside[front] && !labels.inside[back]) skin.idle_area += size;
    if (labels.inside[front] == labels.inside[back]) continue;
    const auto [a, b, c] = arranged.triangles[t];
    skin.triangles.push_back(labels.inside[back] ? Triangle{a, b, c} : Triangle{a, c, b});
    skin.wall.push_back(t);
  }
  restore_whole_faces(arranged, given, skin, context);
  drop_unused_points(skin.points, skin.triangles);
  return skin;
}

}  // namespace octafront::mend
