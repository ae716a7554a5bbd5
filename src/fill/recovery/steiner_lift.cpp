#include "fill/recovery/steiner_lift.h"

#include <octafront/quality.h>

#include <algorithm>

namespace octafront::recovery {

namespace {

// Rounds over the points that found no place: others have gone meanwhile, and more directions are tried.
constexpr int kRounds = 4;
// Candidates that are compared before the best is taken.
constexpr int kEnoughCandidates = 12;
// Places are tried ever nearer to the surface, each height so many times the last, from as many times the star's size.
constexpr double kNextHeight = 0.7;
// The places in sight of the whole star get fewer as a point is nearer to it, their elements flatter: once one was
// found, this many heights more are looked at.
constexpr int kHeightsAfterFirst = 8;
// Nearer than this, in parts of the coordinates and the star, rounding leaves the point where it is.
constexpr double kLowest = 1e-17;
// Directions at each height: to the middle of the star, inward, and between the two by chance, in every round more.
constexpr int kDirections = 4, kMoreEachRound = 2;
// How far chance leads away from there, by turns: wide for stars that are hardly open, narrow for the good ones.
constexpr double kWide = 1.5, kNarrow = 0.5;
// Cavities larger than this bring distant elements in for nothing.
constexpr std::size_t kMaxCavityOfLift = 400;

}  // namespace

double SteinerLift::random_unit() {
  random_ ^= random_ << 13;
  random_ ^= random_ >> 7;
  random_ ^= random_ << 17;
  return static_cast<double>(random_ >> 11) * 0x1p-53;
}

// At a pinched edge a point has several stars that meet in faces nowhere: one copy for each.
void SteinerLift::split_umbrellas() {
  const VertexIndex end = points_.size();
  std::vector<std::vector<TetIndex>> tets_of(end - first_steiner_);
  for (TetIndex t = 0; t < mesh_.slots(); ++t) {
    if (!mesh_.alive(t)) continue;
    for (const VertexIndex v : mesh_.tets[t]) {
      if (v >= first_steiner_) tets_of[v - first_steiner_].push_back(t);
    }
  }
  for (VertexIndex s = first_steiner_; s < end; ++s) {
    std::vector<TetIndex>& rest = tets_of[s - first_steiner_];
    while (!rest.empty()) {
      std::vector<TetIndex> component = mesh_.star_from(s, rest.front());
      std::ranges::sort(component);
      std::erase_if(rest, [&](TetIndex t) { return std::ranges::binary_search(component, t); });
      VertexIndex name = s;
      if (!rest.empty()) {
        name = points_.add_copy(s);
        mesh_.tet_at.push_back(kNone);
      }
      for (const TetIndex t : component) std::ranges::replace(mesh_.tets[t], s, name);
      mesh_.tet_at[name] = component.front();
    }
  }
}

VertexIndex SteinerLift::off_plane(std::uint32_t parent) const {
  const Triangle& t = triangles_[parent];
  VertexIndex o = frame_;
  while (o < frame_ + 3 && points_.orient(t[0], t[1], t[2], o) == 0) ++o;
  return o;
}

std::vector<SteinerLift::Fan> SteinerLift::fans_around(VertexIndex s) {
  struct Spoke {
    VertexIndex from, to;
    std::uint32_t parent;
  };
  std::vector<Spoke> spokes;
  star_ = mesh_.star(s);
  for (const TetIndex t : star_) {
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      if (!is_outside(mesh_.across[h]) || mesh_.apex(h) == s) continue;
      Triangle f = mesh_.face(h);
      while (f[0] != s) std::rotate(f.begin(), f.begin() + 1, f.end());
      spokes.push_back({f[1], f[2], mesh_.across[h] - kFirstOutside});
    }
  }
  if (spokes.empty()) throw std::logic_error("there is no boundary around a point of it");
  // In turn, starting where the parent changes.
  std::size_t first = 0;
  for (std::size_t i = 0; i < spokes.size(); ++i) {
    for (const Spoke& before : spokes) {
      if (before.to == spokes[i].from && before.parent != spokes[i].parent) first = i;
    }
  }
  std::vector<Fan> fans;
  VertexIndex at = spokes[first].from;
  std::vector<std::uint8_t> is_used(spokes.size(), 0);
  for (std::size_t n = 0; n < spokes.size(); ++n) {
    // Around the rim of a sheet two spokes begin at a vertex, one on each side: those of one side follow each other.
    auto next = spokes.end();
    for (auto spoke = spokes.begin(); spoke != spokes.end(); ++spoke) {
      if (spoke->from != at || is_used[static_cast<std::size_t>(spoke - spokes.begin())]) continue;
      const bool goes_on = !fans.empty() && spoke->parent == fans.back().parent;
      if (next == spokes.end() || goes_on) next = spoke;
    }
    if (next == spokes.end()) throw std::logic_error("the boundary around a point is no disc");
    is_used[static_cast<std::size_t>(next - spokes.begin())] = 1;
    if (fans.empty() || fans.back().parent != next->parent) fans.push_back({next->parent, {at}, false});
    fans.back().chain.push_back(next->to);
    at = next->to;
  }
  if (fans.size() == 1) {
    fans[0].closed = true;
    fans[0].chain.pop_back();
  }
  return fans;
}

bool SteinerLift::is_ear(const std::vector<VertexIndex>& polygon, std::size_t i, VertexIndex o, int up) const {
  const std::size_t n = polygon.size();
  const VertexIndex a = polygon[(i + n - 1) % n], b = polygon[i], c = polygon[(i + 1) % n];
  const auto turn = [&](VertexIndex u, VertexIndex v, VertexIndex w) { return points_.orient(u, v, w, o) * up; };
  if (turn(a, b, c) <= 0) return false;
  return std::ranges::none_of(polygon, [&](VertexIndex v) {
    return v != a && v != b && v != c && turn(a, b, v) >= 0 && turn(b, c, v) >= 0 && turn(c, a, v) >= 0;
  });
}

// The polygon that the fan covers, divided without its centre.
bool SteinerLift::triangulate(const Fan& fan, std::vector<TetComplex::BoundaryFace>& faces) const {
  const Triangle& plane = triangles_[fan.parent];
  const VertexIndex o = off_plane(fan.parent);
  const int up = points_.orient(plane[0], plane[1], plane[2], o);
  std::vector<VertexIndex> polygon = fan.chain;
  while (polygon.size() >= 3) {
    const std::size_t n = polygon.size();
    std::size_t best = n;
    double best_quality = -1;
    for (std::size_t i = 0; i < n; ++i) {
      if (!is_ear(polygon, i, o, up)) continue;
      const double q =
          radius_ratio(points_.at(polygon[(i + n - 1) % n]), points_.at(polygon[i]), points_.at(polygon[(i + 1) % n]));
      if (best == n || q > best_quality) {
        best = i;
        best_quality = q;
      }
    }
    if (best == n) return false;
    faces.push_back(
        {{polygon[(best + n - 1) % n], polygon[best], polygon[(best + 1) % n]}, kFirstOutside + fan.parent});
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return true;
}

// The worst element if s moves onto `target`; negative if one would not be positive or is worse than `at_least`.
double SteinerLift::collapse_quality(VertexIndex s, VertexIndex target, double at_least) const {
  double worst = 1;
  for (const TetIndex t : star_) {
    if (mesh_.has(t, target)) continue;
    Tet c = mesh_.tets[t];
    std::ranges::replace(c, s, target);
    worst = std::min(worst, radius_ratio(points_.at(c[0]), points_.at(c[1]), points_.at(c[2]), points_.at(c[3])));
    if (worst <= at_least && at_least > 0) return -1;
    if (points_.orient(c[0], c[1], c[2], c[3]) <= 0) return -1;
  }
  return std::max(worst, 0.0);
}

void SteinerLift::collapse_onto(VertexIndex s, VertexIndex target) {
  std::vector<Tet> fresh;
  std::vector<TetComplex::BoundaryFace> boundary;
  for (const TetIndex t : star_) {
    if (!mesh_.has(t, target)) {
      fresh.push_back(mesh_.tets[t]);
      std::ranges::replace(fresh.back(), s, target);
    }
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      Triangle f = mesh_.face(h);
      if (!is_outside(mesh_.across[h]) || mesh_.apex(h) == s || std::ranges::count(f, target) > 0) continue;
      std::ranges::replace(f, s, target);
      boundary.push_back({f, mesh_.across[h]});
    }
  }
  mesh_.replace(star_, fresh, s, boundary);
  mesh_.tet_at[s] = kNone;
}

// Onto a neighbour that lies on all input triangles on which s lies.
bool SteinerLift::collapse(VertexIndex s) {
  const std::vector<Fan> fans = fans_around(s);
  std::vector<VertexIndex> targets = fans[0].chain;
  if (fans.size() == 2) targets = {fans[0].chain.front(), fans[0].chain.back()};
  VertexIndex best = kNone;
  double best_quality = -1;
  for (const VertexIndex target : targets) {
    const double q = collapse_quality(s, target, best_quality);
    if (q < 0 || (best != kNone && q <= best_quality)) continue;
    best = target;
    best_quality = q;
  }
  if (best == kNone) return false;
  collapse_onto(s, best);
  return true;
}

// A lifted point goes where a neighbour can take its place and the worst element around it gets no worse.
bool SteinerLift::merge_inside(VertexIndex v) {
  star_ = mesh_.star(v);
  double worst = 1;
  std::vector<VertexIndex> neighbours;
  for (const TetIndex t : star_) {
    const Tet& c = mesh_.tets[t];
    worst = std::min(worst, radius_ratio(points_.at(c[0]), points_.at(c[1]), points_.at(c[2]), points_.at(c[3])));
    for (const VertexIndex u : c) {
      if (u != v && std::ranges::find(neighbours, u) == neighbours.end()) neighbours.push_back(u);
    }
  }
  VertexIndex best = kNone;
  for (const VertexIndex u : neighbours) {
    const double q = collapse_quality(v, u, worst);
    if (q < worst) continue;
    best = u;
    worst = q;
  }
  if (best == kNone) return false;
  collapse_onto(v, best);
  return true;
}

// The tets around s, and behind every face that x does not see strictly the next one. False if a boundary face hides x.
bool SteinerLift::grow_cavity(VertexIndex s, Vec3 x, std::size_t limit) {
  cavity_ = star_;
  const std::uint32_t inside = mesh_.new_mark();
  for (const TetIndex t : cavity_) mesh_.marks[t] = inside;
  for (std::size_t k = 0; k < cavity_.size(); ++k) {
    const TetIndex t = cavity_[k];
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      const HalfFace o = mesh_.across[h];
      if (!is_outside(o) && mesh_.marks[o / 4] == inside) continue;
      const Triangle f = mesh_.face(h);
      if (is_outside(o) && (f[0] == s || f[1] == s || f[2] == s)) continue;
      if (points_.orient(f[0], f[1], f[2], x) < 0) continue;
      if (is_outside(o) || cavity_.size() >= limit) return false;
      mesh_.marks[o / 4] = inside;
      cavity_.push_back(o / 4);
    }
  }
  rim_.clear();
  for (const TetIndex t : cavity_) {
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      const HalfFace o = mesh_.across[h];
      if (!is_outside(o) && mesh_.marks[o / 4] == inside) continue;
      const Triangle f = mesh_.face(h);
      if (!is_outside(o) || (f[0] != s && f[1] != s && f[2] != s)) rim_.push_back(f);
    }
  }
  return true;
}

double SteinerLift::cavity_quality(Vec3 x, const std::vector<TetComplex::BoundaryFace>& boundary) const {
  double worst = 1;
  const auto look = [&](const Triangle& f) {
    worst = std::min(worst, radius_ratio(points_.at(f[0]), points_.at(f[2]), points_.at(f[1]), x));
  };
  for (const Triangle& f : rim_) look(f);
  for (const TetComplex::BoundaryFace& f : boundary) look(f.corners);
  return worst;
}

bool SteinerLift::place(VertexIndex s, Vec3 x, const std::vector<TetComplex::BoundaryFace>& boundary) {
  if (!grow_cavity(s, x, kMaxCavityOfLift)) return false;
  std::vector<Tet> fresh;
  const auto cone = [&](const Triangle& f) { fresh.push_back({f[0], f[2], f[1], s}); };
  for (const Triangle& f : rim_) cone(f);
  for (const TetComplex::BoundaryFace& f : boundary) cone(f.corners);
  mesh_.replace(cavity_, fresh, s, boundary);
  points_.move(s, x);
  return true;
}

// The plane of no fan hides x.
bool SteinerLift::sees_fans(Vec3 x, const std::vector<Fan>& fans) const {
  return std::ranges::all_of(fans, [&](const Fan& fan) {
    const Triangle& t = triangles_[fan.parent];
    return points_.orient(t[0], t[1], t[2], x) < 0;
  });
}

SteinerLift::Outlook SteinerLift::outlook(VertexIndex s, const std::vector<Fan>& fans) const {
  Outlook out;
  for (const Fan& fan : fans) {
    const Triangle& t = triangles_[fan.parent];
    const Vec3 a = points_.at(t[0]);
    out.inward -= normalized(cross(points_.at(t[1]) - a, points_.at(t[2]) - a));
  }
  out.inward = normalized(out.inward);
  const Vec3 at = points_.at(s);
  std::size_t n = 0;
  for (const TetIndex t : star_) {
    for (const VertexIndex v : mesh_.tets[t]) {
      if (v == s) continue;
      out.middle += points_.at(v) - at;
      out.size = std::max(out.size, distance(points_.at(v), at));
      ++n;
    }
  }
  out.middle = out.middle / static_cast<double>(n);
  return out;
}

Vec3 SteinerLift::direction(const Outlook& outlook, int k) {
  const auto& [inward, middle, size] = outlook;
  if (k == 0) return normalized(middle * (1 / size));
  if (k == 1) return normalized(inward);
  const Vec3 chance{random_unit() - 0.5, random_unit() - 0.5, random_unit() - 0.5};
  return normalized(inward + middle * (2 / size) + chance * (k % 2 ? kWide : kNarrow));
}

std::optional<Vec3> SteinerLift::best_place(VertexIndex s, const std::vector<Fan>& fans,
                                            const std::vector<TetComplex::BoundaryFace>& boundary, int round) {
  const Vec3 at = points_.at(s);
  const Outlook around = outlook(s, fans);
  const double lowest = kLowest * (length(at) + around.size);
  std::optional<Vec3> best;
  double best_quality = -1;
  int found = 0;
  int heights_after_first = 0;
  for (double h = kNextHeight; h * around.size > lowest && found < kEnoughCandidates; h *= kNextHeight) {
    if (found > 0 && ++heights_after_first > kHeightsAfterFirst) break;
    for (int k = 0; k < kDirections + kMoreEachRound * round; ++k) {
      const Vec3 x = at + direction(around, k) * (h * around.size);
      if (!sees_fans(x, fans) || !grow_cavity(s, x, kMaxCavityOfLift)) continue;
      ++found;
      const double q = cavity_quality(x, boundary);
      if (q <= best_quality) continue;
      best_quality = q;
      best = x;
    }
  }
  return best;
}

bool SteinerLift::lift(VertexIndex s, int round) {
  const std::vector<Fan> fans = fans_around(s);
  std::vector<TetComplex::BoundaryFace> boundary;
  for (const Fan& fan : fans) {
    if (!triangulate(fan, boundary)) return false;
  }
  const std::optional<Vec3> x = best_place(s, fans, boundary, round);
  return x && place(s, *x, boundary);
}

std::vector<VertexIndex> SteinerLift::run() {
  if (points_.size() == first_steiner_) return {};
  split_umbrellas();
  std::vector<VertexIndex> open;
  for (VertexIndex s = first_steiner_; s < points_.size(); ++s) {
    if (mesh_.tet_at[s] != kNone) open.push_back(s);
  }
  for (bool changed = true; changed;) {
    context_.check();
    const std::size_t before = open.size();
    std::erase_if(open, [&](VertexIndex s) { return collapse(s); });
    changed = open.size() < before;
    counts_.collapsed += before - open.size();
  }
  // Points inside facets first: the others then see fewer of them.
  std::stable_partition(open.begin(), open.end(), [&](VertexIndex s) { return fans_around(s).size() == 1; });
  for (int round = 0; round < kRounds && !open.empty(); ++round) {
    const std::size_t before = open.size();
    std::erase_if(open, [&](VertexIndex s) {
      context_.check();
      return lift(s, round);
    });
    counts_.lifted += before - open.size();
    if (round == 0) counts_.deferred = open.size();
  }
  if (!open.empty()) return open;
  for (VertexIndex v = first_steiner_; v < points_.size(); ++v) {
    if (v % 64 == 0) context_.check();
    const TetIndex t = mesh_.tet_at[v];
    // Points that a cavity swallowed point to a tet that is gone.
    if (t != kNone && mesh_.alive(t) && mesh_.has(t, v)) counts_.removed += merge_inside(v);
  }
  return {};
}

}  // namespace octafront::recovery
