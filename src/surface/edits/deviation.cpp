#include "surface/edits/deviation.h"

#include "base/core/parallel.h"
#include "base/geometry/doubtful_parts.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace octafront::surface {

namespace {

/// The samples of `all` of which is_far(sample) says so, in their order.
template <class IsFar>
std::vector<Sample> far_ones(const std::vector<Sample>& all, const IsFar& is_far_one) {
  std::vector<std::uint8_t> is_far(all.size());
  parallel_for(all.size(), [&](std::size_t i) { is_far[i] = is_far_one(all[i]); });
  std::vector<Sample> far;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (is_far[i]) far.push_back(all[i]);
  return far;
}

/// For vertices of reach 0 and more, how far from the nearest corner a point of their triangles may lie: a part of the
/// longest edge, the whole of that part in an equilateral triangle.
void note_reach(const SurfaceMesh& surface, std::vector<double>& reach) {
  constexpr double kReach = 0.57736;  // 1 / sqrt(3), a little more
  for (const Triangle& t : surface.triangles) {
    if (reach[t[0]] < 0 && reach[t[1]] < 0 && reach[t[2]] < 0) continue;
    for (int i = 0; i < 3; ++i) {
      const double l = kReach * distance(surface.points[t[i]], surface.points[t[(i + 1) % 3]]);
      for (const VertexIndex v : t)
        if (reach[v] >= 0) reach[v] = std::max(reach[v], l);
    }
  }
}

/// How far parts of the input reach that are divided no further: as far as the limit, but in edges of the triangle
/// beside no farther than the one, over which the distance changes evenly, and no less far than the other.
constexpr double kWidest = 0.3, kFinest = 0.1;

/// Looks at parts of the input for what may be farther than the limit from a surface that was made. A triangle is
/// convex: what has its corners within the limit of one lies within the limit of it.
class PartsOfInput {
 public:
  explicit PartsOfInput(const TriangleTree& made) : made_(made) {}

  void set_limits(double limit, double far) { limit_ = limit, far_ = far; }

  Part operator()(PartCorners part, Vec3 middle, double reach) const {
    // What is nearest to the last part mostly is nearest to this one, or near enough.
    double d = nearest_ != kNone ? distance_to(made_.corners(nearest_), middle) : HUGE_VAL;
    if (is_within(part, d, reach)) return Part::kWithin;
    // Where rounding hides even the last part's triangle behind the bound, that one is as good.
    const std::uint32_t nearest = made_.nearest(middle, bound(d)).triangle;
    if (nearest != kNone && nearest != nearest_) {
      nearest_ = nearest;
      d = distance_to(made_.corners(nearest_), middle);
      if (is_within(part, d, reach)) return Part::kWithin;
    }
    return reach <= finest(made_.corners(nearest_)) || !(d < far_) ? Part::kVisit : Part::kDivide;
  }

 private:
  static double distance_to(const TriangleCorners& t, Vec3 p) {
    return distance(p, closest_point_on_triangle(p, t[0], t[1], t[2]));
  }

  /// Of a part, by the triangle that is nearest, at `d` from its middle.
  bool is_within(PartCorners part, double d, double reach) const {
    if (d + reach < limit_) return true;
    return d < limit_ &&
           std::ranges::all_of(part, [&](Vec3 p) { return distance_to(made_.corners(nearest_), p) < limit_; });
  }

  /// The nearest triangle is no farther than that of the last part, and a little more.
  double bound(double last) const {
    return nearest_ == kNone ? TriangleTree::kFar : 1.001 * last * last + std::numeric_limits<double>::min();
  }

  double finest(const TriangleCorners& t) const {
    const double squared_edge =
        std::max({squared_distance(t[0], t[1]), squared_distance(t[1], t[2]), squared_distance(t[2], t[0])});
    const double edge = std::sqrt(squared_edge);
    return std::clamp(limit_, kFinest * edge, kWidest * edge);
  }

  double limit_ = 0, far_ = 0;
  const TriangleTree& made_;
  mutable std::uint32_t nearest_ = kNone;  ///< to the last part
};

/// Samples of a triangle of the input that may be far.
void add_suspects(const TriangleCorners& corners, std::uint32_t t, const PartsOfInput& look,
                  std::vector<Sample>& found) {
  const std::size_t before = found.size();
  for_each_doubtful_part(corners, look, [&](Vec3 p) {
    found.push_back({p, t, true});
    return true;
  });
  if (found.size() == before) return;
  for (int i = 0; i < 3; ++i) {
    found.push_back({corners[i], t});
    found.push_back({(corners[i] + corners[(i + 1) % 3]) * 0.5, t});
  }
}

/// Of a triangle so much longer than those made there its inside is looked at in any case.
constexpr double kNoSmaller = 2;

double longest_edge(const TriangleCorners& t) {
  return std::sqrt(
      std::max({squared_distance(t[0], t[1]), squared_distance(t[1], t[2]), squared_distance(t[2], t[0])}));
}

/// A triangle of the input so much longer than wide, and so much narrower than the triangles made there, is one of many
/// side by side, as a finely divided cylinder has.
constexpr double kStripLength = 16, kStripWidth = 8;
/// Strips are looked at in places this part of a made triangle's edge apart, together: to look along each of them would
/// take as long as thousands of triangles do.
constexpr double kPlacesOnStrips = 1.0 / 8;

/// Chooses places on strips, spread evenly over their area.
class PlacesOnStrips {
 public:
  explicit PlacesOnStrips(const TriangleTree& made) : made_(made) {}

  /// Whether the triangle is a strip; if so, samples of it.
  bool sample(const TriangleCorners& corners, std::uint32_t t, std::vector<Sample>& found) {
    const double area = triangle_area(corners[0], corners[1], corners[2]), longest = longest_edge(corners);
    if (!(2 * kStripLength * area < longest * longest)) return false;
    const Vec3 middle = centroid(corners[0], corners[1], corners[2]);
    const double edge = longest_edge(made_.corners(made_.nearest(middle).triangle));
    if (!(longest > kNoSmaller * edge && 2 * kStripWidth * area < longest * edge)) return false;
    for (const Vec3 p : corners) found.push_back({p, t});
    const double apart = kPlacesOnStrips * edge;
    for (owed_ += area / (apart * apart); owed_ > 0; --owed_) found.push_back({place(corners, next_++), t, true});
    return true;
  }

 private:
  /// The k-th place of a triangle by the additive recurrence R2 (M. Roberts, The unreasonable effectiveness of
  /// quasirandom sequences, 2018).
  static Vec3 place(const TriangleCorners& t, double k) {
    const double u = std::sqrt(std::fmod(k * 0.7548776662466927, 1.0)), v = std::fmod(k * 0.5698402909980532, 1.0);
    return t[0] * (1 - u) + t[1] * (u * (1 - v)) + t[2] * (u * v);
  }

  const TriangleTree& made_;
  double owed_ = 0, next_ = 1;
};

/// Samples of the input that may be far: of those triangles whose corners are not all well within the limit.
/// `part_of`: a triangle's part of the limit and of `far`.
template <class PartOf>
std::vector<Sample> suspects(double limit, double far, const PartOf& part_of, const SurfaceMesh& input,
                             const std::vector<std::uint32_t>& triangles, const TriangleTree& made, Fine fine) {
  std::vector<double> reach(input.points.size(), -1), limit_at(input.points.size(), limit);
  std::vector<VertexIndex> vertices;
  for (const std::uint32_t t : triangles)
    for (const VertexIndex v : input.triangles[t]) {
      limit_at[v] = std::min(limit_at[v], limit * part_of(t));
      if (reach[v] >= 0) continue;
      reach[v] = 0;
      vertices.push_back(v);
    }
  note_reach(input, reach);
  std::vector<std::uint8_t> is_safe(reach.size(), 0);
  std::vector<double> made_edge(fine == Fine::kCorners ? reach.size() : 0);  // near vertices that are not safe
  parallel_for(vertices.size(), [&](std::size_t i) {
    const VertexIndex v = vertices[i];
    is_safe[v] = reach[v] < limit_at[v] && made.is_within(input.points[v], limit_at[v] - reach[v]);
    if (!is_safe[v] && fine == Fine::kCorners)
      made_edge[v] = longest_edge(made.corners(made.nearest(input.points[v]).triangle));
  });
  constexpr std::size_t kRange = 256;
  const auto collect = [&](std::size_t begin, std::size_t end, std::vector<Sample>& found) {
    PartsOfInput look(made);
    PlacesOnStrips strips(made);
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [a, b, c] = input.triangles[triangles[i]];
      if (is_safe[a] && is_safe[b] && is_safe[c]) continue;
      const TriangleCorners corners{input.points[a], input.points[b], input.points[c]};
      const bool is_fine = fine == Fine::kCorners &&
                           longest_edge(corners) <= kNoSmaller * std::max({made_edge[a], made_edge[b], made_edge[c]});
      if (is_fine || strips.sample(corners, triangles[i], found)) continue;
      look.set_limits(part_of(triangles[i]) * limit, part_of(triangles[i]) * far);
      add_suspects(corners, triangles[i], look, found);
    }
  };
  std::vector<Sample> found = parallel_collect<Sample>(triangles.size(), kRange, collect);
  if (fine == Fine::kParts) return found;
  for (const std::uint32_t t : triangles)
    for (const VertexIndex v : input.triangles[t]) {
      if (!is_safe[v]) found.push_back({input.points[v], t});
      is_safe[v] = 1;  // once
    }
  return found;
}

/// Corners, middles of edges and centroids, a corner or an edge with one of its triangles.
std::vector<Sample> samples_of(const SurfaceMesh& made, const std::vector<std::uint32_t>& triangles) {
  std::vector<Sample> samples;
  std::vector<std::uint8_t> is_taken(made.points.size(), 0);
  for (const std::uint32_t t : triangles) {
    for (const VertexIndex v : made.triangles[t]) {
      if (!is_taken[v]) samples.push_back({made.points[v], t});
      is_taken[v] = 1;
    }
  }
  for (const std::uint32_t t : triangles) {
    const auto [a, b, c] = made.triangles[t];
    samples.push_back({centroid(made.points[a], made.points[b], made.points[c]), t});
    for (const auto& [v, w] : {Edge{a, b}, Edge{b, c}, Edge{c, a}})
      samples.push_back({(made.points[v] + made.points[w]) * 0.5, t});
  }
  return samples;
}

Vec3 normal_of(const SurfaceMesh& surface, std::uint32_t t) {
  const auto [a, b, c] = surface.triangles[t];
  return double_area_normal(surface.points[a], surface.points[b], surface.points[c]);
}

bool faces_along(const TriangleCorners& t, Vec3 normal) {
  return dot(double_area_normal(t[0], t[1], t[2]), normal) > 0;
}

/// The nearest point to p of the triangles that face along `normal`, if it is within kOtherSide times the distance of
/// the nearest point of all: of a thin wall the right side. Otherwise that one, which is at `distance`.
TriangleTree::Nearest nearest_facing(const TriangleTree& tree, Vec3 p, Vec3 normal, double& distance) {
  constexpr double kOtherSide = 3, kALittleMore = 1.001;
  const TriangleTree::Nearest any = tree.nearest(p);
  distance = std::sqrt(any.squared_distance);
  const double reach = kOtherSide * distance;
  TriangleTree::Nearest best{any.point, any.triangle, reach * reach};
  Box3 box = Box3{p, p}.grown(faces_along(tree.corners(any.triangle), normal) ? kALittleMore * distance : reach);
  tree.for_each_box_near(box, [&](std::uint32_t triangle, const TriangleCorners& t) {
    if (!faces_along(t, normal)) return true;
    const Vec3 q = closest_point_on_triangle(p, t[0], t[1], t[2]);
    const double d = squared_distance(p, q);
    if (!(d < best.squared_distance)) return true;
    best = {q, triangle, d};
    box = Box3{p, p}.grown(kALittleMore * std::sqrt(d));
    return true;
  });
  return best;
}

/// A place for each sample.
template <class PlaceOf>
void append(std::vector<FarPlace>& places, const std::vector<Sample>& samples, const PlaceOf& place_of) {
  const std::size_t before = places.size();
  places.resize(before + samples.size());
  parallel_for(samples.size(), [&](std::size_t i) { places[before + i] = place_of(samples[i]); });
}

/// One behind the last of numbers that ascend.
std::uint32_t end_of(const std::vector<std::uint32_t>& number) {
  return number.empty() ? 0 : number.back() + 1;
}

Box3 box_of(const TriangleCorners& t, double margin) {
  const Vec3 m{margin, margin, margin};
  return {min(min(t[0], t[1]), t[2]) - m, max(max(t[0], t[1]), t[2]) + m};
}

}  // namespace

DeviationWatch::DeviationWatch(double limit, double far, const SurfaceMesh& input, const TriangleTree& input_tree,
                               Fine fine, std::span<const double> bound)
    : limit_(limit),
      far_(far),
      fine_(fine),
      input_(input),
      input_tree_(input_tree),
      is_near_change_(input.triangles.size(), 1) {
  std::vector<Triangle> tighter;
  for (std::uint32_t t = 0; t < bound.size(); ++t) {
    part_.push_back(std::min(1.0, bound[t] / far));
    least_part_ = std::min(least_part_, part_[t]);
    if (part_[t] < 1) tighter.push_back(input.triangles[t]);
  }
  if (!tighter.empty()) tighter_.emplace(input.points, tighter);
}

/// Samples that lie farther than the limit of what is nearest, and some that do not.
std::vector<Sample> DeviationWatch::far_of_made(const SurfaceMesh& made,
                                                const std::vector<std::uint32_t>& changed) const {
  return far_ones(samples_of(made, changed), [&](const Sample& s) {
    if (!input_tree_.is_within(s.p, limit_)) return true;
    return tighter_ && tighter_->is_within(s.p, limit_) && !input_tree_.is_within(s.p, least_part_ * limit_);
  });
}

std::vector<FarPlace> DeviationWatch::look(const SurfaceMesh& made, const std::vector<std::uint32_t>& number) {
  const std::vector<std::uint32_t> changed = note_changes(made, number);
  const auto forget = [&](const FarPlace& p) { return is_changed_[p.triangle] != 0; };
  for (const FarPlace& place : of_input_)
    if (forget(place)) is_near_change_[place.on_input.face] = 1;
  std::erase_if(of_input_, [&](const FarPlace& p) { return is_near_change_[p.on_input.face] != 0; });
  std::erase_if(of_made_, forget);

  append(of_made_, far_of_made(made, changed), [&](const Sample& s) {
    double distance = 0;
    const TriangleTree::Nearest nearest = nearest_facing(input_tree_, s.p, normal_of(made, s.triangle), distance);
    return FarPlace{
        s.p, {nearest.point, nearest.triangle}, distance / part_of(nearest.triangle), number[s.triangle], s.within};
  });
  if (tighter_) std::erase_if(of_made_, [&](const FarPlace& p) { return p.distance < limit_; });
  std::vector<std::uint32_t> asked;
  for (std::uint32_t t = 0; t < input_.triangles.size(); ++t)
    if (is_near_change_[t]) asked.push_back(t);
  const TriangleTree made_tree(made);
  const auto part = [&](std::uint32_t t) { return part_of(t); };
  const std::vector<Sample> far =
      far_ones(suspects(limit_, far_, part, input_, asked, made_tree, fine_),
               [&](const Sample& s) { return !made_tree.is_within(s.p, part_of(s.triangle) * limit_); });
  append(of_input_, far, [&](const Sample& s) {
    double distance = 0;
    const std::uint32_t triangle = nearest_facing(made_tree, s.p, normal_of(input_, s.triangle), distance).triangle;
    return FarPlace{s.p, {s.p, s.triangle}, distance / part_of(s.triangle), number[triangle], s.within};
  });
  std::ranges::fill(is_near_change_, 0);
  std::vector<FarPlace> all = of_made_;
  all.insert(all.end(), of_input_.begin(), of_input_.end());
  return all;
}

/// What is not as it was: new triangles of `made`, by their place in it; is_changed_, by number; the input around.
std::vector<std::uint32_t> DeviationWatch::note_changes(const SurfaceMesh& made,
                                                        const std::vector<std::uint32_t>& number) {
  const bool is_first = last_.corners.empty();
  const std::uint32_t numbers = std::max(end_of(last_.number), end_of(number));
  is_changed_.assign(numbers, 1);
  std::vector<std::uint32_t> changed;
  Looked now{number, {}};
  now.corners.reserve(number.size());
  std::size_t k = 0;  // in last_, whose numbers ascend too
  for (std::uint32_t t = 0; t < number.size(); ++t) {
    const auto [a, b, c] = made.triangles[t];
    now.corners.push_back({made.points[a], made.points[b], made.points[c]});
    while (k < last_.number.size() && last_.number[k] < number[t]) ++k;
    const bool was_there = k < last_.number.size() && last_.number[k] == number[t];
    if (was_there && last_.corners[k] == now.corners.back())
      is_changed_[number[t]] = 0;
    else
      changed.push_back(t);
  }
  if (!is_first) {
    std::vector<Vec3> corners;  // of what has gone and what has come
    for (const Looked* look : std::array<const Looked*, 2>{&last_, &now})
      for (std::size_t t = 0; t < look->number.size(); ++t)
        if (is_changed_[look->number[t]])
          corners.insert(corners.end(), look->corners[t].begin(), look->corners[t].end());
    mark_near(corners);
  }
  last_ = std::move(now);
  return changed;
}

/// The input near changed triangles, three corners each. Where these find more than all of the input, the same faces
/// again and again, each face asks instead whether one of them is near.
void DeviationWatch::mark_near(const std::vector<Vec3>& corners) {
  std::vector<Triangle> changed(corners.size() / 3);
  for (VertexIndex t = 0; t < changed.size(); ++t) changed[t] = {3 * t, 3 * t + 1, 3 * t + 2};
  std::size_t found = 0;
  const bool are_few = std::ranges::all_of(changed, [&](const Triangle& t) {
    return input_tree_.for_each_box_near(box_of({corners[t[0]], corners[t[1]], corners[t[2]]}, limit_),
                                         [&](std::uint32_t face, const TriangleCorners&) {
                                           is_near_change_[face] = 1;
                                           return ++found <= input_.triangles.size();
                                         });
  });
  if (are_few) return;
  const TriangleTree tree(corners, changed);
  parallel_for(input_.triangles.size(), [&](std::size_t face) {
    const Box3 box = box_of(input_tree_.corners(static_cast<std::uint32_t>(face)), limit_);
    if (!tree.for_each_box_near(box, [](std::uint32_t, const TriangleCorners&) { return false; }))
      is_near_change_[face] = 1;
  });
}

std::vector<FarPlace> places_under(const std::vector<std::uint32_t>& triangles, const SurfaceMesh& made,
                                   const TriangleTree& input_tree) {
  std::vector<FarPlace> places;
  double distance = 0;
  for (const std::uint32_t t : triangles) {
    const Vec3 a = made.points[made.triangles[t][0]], b = made.points[made.triangles[t][1]],
               c = made.points[made.triangles[t][2]];
    const Vec3 normal = normal_of(made, t);
    for (const Vec3 p : {centroid(a, b, c), (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5}) {
      const TriangleTree::Nearest nearest = nearest_facing(input_tree, p, normal, distance);
      places.push_back({p, {nearest.point, nearest.triangle}, distance, t});
    }
  }
  return places;
}

}  // namespace octafront::surface
