
#include "images/nets/conflicts.h"

#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "base/geometry/predicates.h"
#include "base/geometry/radial_order.h"
#include "base/geometry/self_intersection.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

namespace octafront::nets {

namespace {

// A vertex stays within half a voxel of its corner. So triangles can only meet if the least corners of their quads are
// at most this many layers apart.
constexpr std::int32_t kReach = 2;

std::vector<std::uint32_t> sorted_once(std::vector<std::uint32_t> numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

Conflicts sorted(Conflicts found) {
  return {sorted_once(std::move(found.invalid)), sorted_once(std::move(found.sharp))};
}

/// A side of a quad, by its vertices, the lower one first.
struct Side {
  VertexIndex from, to;
  std::uint32_t quad;
  int index;  ///< v[index] to the next one
  friend bool operator<(const Side& a, const Side& b) {
    return std::tie(a.from, a.to, a.quad) < std::tie(b.from, b.to, b.quad);
  }
};

/// A triangle at an edge, seen along the edge: the labels before and behind it in the turn.
struct Spoke {
  Vec3 apex;
  Label before, behind;
};

Spoke spoke_of(const Net& net, std::span<const Vec3> world, bool is_mirrored, const Side& side) {
  const Quad& q = net.quads[side.quad];
  const VertexIndex a = q.v[side.index], b = q.v[(side.index + 1) % 4];
  for (const Triangle& t : triangles_of(q))
    for (int i = 0; i < 3; ++i)
      if (t[i] == a && t[(i + 1) % 3] == b) {
        const Vec3 apex = world[t[(i + 2) % 3]];
        // Along the edge the upper side of a triangle comes behind it if its own edge runs that way.
        if ((a == side.from) != is_mirrored) return {apex, q.lower, q.upper};
        return {apex, q.upper, q.lower};
      }
  return {};
}

/// In what is sharper than this no element is good: its own dihedral angle there, or that of its face.
const double kSharpWedge = elementary::cos(20 * std::numbers::pi / 180),
             kSharpCorner = elementary::cos(25 * std::numbers::pi / 180);

/// What is right or wrong around an edge.
enum class Around { kGood, kSharp, kDisorder };

/// From an edge straight to a point beside it.
Vec3 away_from(Vec3 from, Vec3 to, Vec3 p) {
  const Vec3 along = to - from;
  return (p - from) - along * (dot(p - from, along) / squared_length(along));
}

bool is_sharp(Vec3 u, Vec3 v, double cosine) {
  return dot(u, v) > cosine * length(u) * length(v);
}

/// Whether a region has only a sharp wedge between two of the spokes, which are in order.
bool leaves_wedge(const std::vector<Spoke>& spokes, Vec3 from, Vec3 to) {
  for (std::size_t k = 0; k < spokes.size(); ++k) {
    const Spoke &one = spokes[k], &next = spokes[(k + 1) % spokes.size()];
    if (one.behind == LabelImage::kNoRegion) continue;
    const Vec3 u = away_from(from, to, one.apex), v = away_from(from, to, next.apex);
    const bool is_inner = dot(cross(u, v), to - from) >= 0;  // else it is all around but a sharp one
    if (is_inner && is_sharp(u, v, kSharpWedge)) return true;
  }
  return false;
}

Around judge_edge(const Net& net, std::span<const Vec3> world, bool is_mirrored, std::span<const Side> around) {
  const Vec3 from = world[around[0].from], to = world[around[0].to];
  std::vector<Spoke> spokes;
  for (const Side& side : around) spokes.push_back(spoke_of(net, world, is_mirrored, side));
  if (spokes.size() > 2) {
    const RadialOrder order(from, to, spokes[0].apex);
    std::sort(spokes.begin(), spokes.end(), [&](const Spoke& a, const Spoke& b) { return order(a.apex, b.apex); });
    for (std::size_t k = 0; k < spokes.size(); ++k)
      if (spokes[k].behind != spokes[(k + 1) % spokes.size()].before) return Around::kDisorder;
  }
  return leaves_wedge(spokes, from, to) ? Around::kSharp : Around::kGood;
}

}  // namespace

/// A curve at one of its vertices, and a quad that ends there.
struct ConflictSearch::CurveEnd {
  VertexIndex at, to;
  std::uint32_t quad;
  friend bool operator<(const CurveEnd& a, const CurveEnd& b) {
    return std::tie(a.at, a.to, a.quad) < std::tie(b.at, b.to, b.quad);
  }
};

/// Some quads, and for which of their edges all quads are among them.
struct ConflictSearch::Part {
  std::vector<std::uint32_t> quads;
  std::function<bool(VertexIndex)> is_whole_at;
};

ConflictSearch::ConflictSearch(const Net& net, const Lattice& lattice, std::span<const Vec3> x,
                               std::span<const Vec3> world, std::span<const std::uint8_t> may_yield)
    : net_(net),
      shelters_(net, lattice, x),
      world_(world),
      is_mirrored_(lattice.is_mirrored()),
      may_yield_(may_yield) {}

void ConflictSearch::add_sharp(std::uint32_t quad, Conflicts& found) const {
  const auto& v = net_.quads[quad].v;
  if (std::any_of(v.begin(), v.end(), [&](VertexIndex i) { return may_yield_[i] != 0; })) found.sharp.push_back(quad);
}

void ConflictSearch::search(const Part& part, Conflicts& found, const RunContext& context) const {
  find_crossings(part, found, context);
  find_around_edges(part, found);
  find_folds(part, found);
}

/// Those without shelter, and what has a corner in common with these: quads of other corners lie in other cells. Where
/// several vertices share a corner none of their quads has shelter.
std::vector<std::uint32_t> ConflictSearch::quads_that_may_cross(const Part& part) const {
  std::vector<std::uint8_t> is_near(net_.corner.size(), 0);
  for (const std::uint32_t q : part.quads)
    if (!shelters_.holds(q))
      for (const VertexIndex v : net_.quads[q].v) is_near[v] = 1;
  std::vector<std::uint32_t> quads;
  for (const std::uint32_t q : part.quads)
    if (std::ranges::any_of(net_.quads[q].v, [&](VertexIndex v) { return is_near[v] != 0; })) quads.push_back(q);
  return quads;
}

void ConflictSearch::find_crossings(const Part& part, Conflicts& found, const RunContext& context) const {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> quad_of;
  for (const std::uint32_t q : quads_that_may_cross(part))
    for (const Triangle& t : triangles_of(net_.quads[q])) {
      if (collinear(world_[t[0]], world_[t[1]], world_[t[2]])) {
        found.invalid.push_back(q);
        continue;
      }
      triangles.push_back(t);
      quad_of.push_back(q);
    }
  // The search looks at all points it is given; few of the net's are used here.
  std::vector<VertexIndex> used;
  for (const Triangle& t : triangles) used.insert(used.end(), t.begin(), t.end());
  used = sorted_once(std::move(used));
  std::vector<Vec3> points;
  for (const VertexIndex v : used) points.push_back(world_[v]);
  for (Triangle& t : triangles)
    for (VertexIndex& v : t) v = static_cast<VertexIndex>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  for (const auto& [s, t] : self_intersections(points, triangles, kAll, context)) {
    found.invalid.push_back(quad_of[s]);
    found.invalid.push_back(quad_of[t]);
  }
}

void ConflictSearch::find_around_edges(const Part& part, Conflicts& found) const {
  std::vector<Side> sides;
  for (const std::uint32_t q : part.quads)
    for (int i = 0; i < 4; ++i) {
      const VertexIndex a = net_.quads[q].v[i], b = net_.quads[q].v[(i + 1) % 4];
      if (part.is_whole_at(std::min(a, b))) sides.push_back({std::min(a, b), std::max(a, b), q, i});
    }
  std::sort(sides.begin(), sides.end());
  std::vector<CurveEnd> ends;
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].from == sides[i].from && sides[end].to == sides[i].to) ++end;
    const std::span<const Side> around(sides.data() + i, end - i);
    const Around is = judge_edge(net_, world_, is_mirrored_, around);
    for (const Side& side : around) {
      if (is == Around::kDisorder) found.invalid.push_back(side.quad);
      if (is == Around::kSharp) add_sharp(side.quad, found);
    }
    if (around.size() > 2)
      for (const Side& side : around)
        ends.insert(ends.end(), {{side.from, side.to, side.quad}, {side.to, side.from, side.quad}});
  }
  find_sharp_corners(std::move(ends), found);
}

/// Curves that leave a vertex in nearly the same direction.
void ConflictSearch::find_sharp_corners(std::vector<CurveEnd> ends, Conflicts& found) const {
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t k = i + 1; k < ends.size() && ends[k].at == ends[i].at; ++k) {
      if (ends[k].to == ends[i].to) continue;
      const Vec3 u = world_[ends[i].to] - world_[ends[i].at], v = world_[ends[k].to] - world_[ends[k].at];
      if (!is_sharp(u, v, kSharpCorner)) continue;
      add_sharp(ends[i].quad, found);
      add_sharp(ends[k].quad, found);
    }
}

/// Quads folded along their diagonal.
void ConflictSearch::find_folds(const Part& part, Conflicts& found) const {
  for (const std::uint32_t q : part.quads) {
    const auto [one, other] = triangles_of(net_.quads[q]);
    const Vec3 from = world_[one[0]], to = world_[one[2]];
    if (is_sharp(away_from(from, to, world_[one[1]]), away_from(from, to, world_[other[1]]), kSharpWedge))
      add_sharp(q, found);
  }
}

Conflicts ConflictSearch::all(const RunContext& context) const {
  constexpr std::size_t kLayerQuads = 100'000;  // more makes the reach beyond the layer matter less, and takes memory
  const auto layer_of = [&](std::uint32_t q) { return net_.corner[net_.quads[q].v[0]][2]; };
  // Quads are in order of their layers.
  std::vector<std::uint32_t> first{0};
  const auto n = static_cast<std::uint32_t>(net_.quads.size());
  for (std::uint32_t q = 1; q < n; ++q)
    if (q - first.back() >= kLayerQuads && layer_of(q) != layer_of(q - 1)) first.push_back(q);
  std::vector<Conflicts> found(first.size());
  parallel_for(
      first.size(),
      [&](std::size_t i) {
        const std::uint32_t begin = first[i], end = i + 1 < first.size() ? first[i + 1] : n;
        const std::int32_t lo = layer_of(begin), hi = layer_of(end - 1);
        std::uint32_t from = begin, to = end;
        while (from > 0 && layer_of(from - 1) >= lo - kReach) --from;
        while (to < n && layer_of(to) <= hi + kReach) ++to;
        Part part;
        for (std::uint32_t q = from; q < to; ++q) part.quads.push_back(q);
        part.is_whole_at = [&](VertexIndex v) { return net_.corner[v][2] >= lo && net_.corner[v][2] <= hi; };
        search(part, found[i], context);
      },
      Split::kSingly);
  Conflicts all;
  for (const Conflicts& of_layer : found) {
    all.invalid.insert(all.invalid.end(), of_layer.invalid.begin(), of_layer.invalid.end());
    all.sharp.insert(all.sharp.end(), of_layer.sharp.begin(), of_layer.sharp.end());
  }
  return sorted(std::move(all));
}

Conflicts ConflictSearch::near(const std::vector<VertexIndex>& moved, const RunContext& context) const {
  // Blocks of 4 x 4 x 4 corners that hold the least corners of quads that may meet those of moved vertices.
  constexpr int kShift = 2;
  Corner top{0, 0, 0};
  for (const Corner& c : net_.corner)
    for (int a = 0; a < 3; ++a) top[a] = std::max(top[a], c[a]);
  const auto blocks = [&](int a) { return static_cast<std::size_t>(top[a] >> kShift) + 1; };
  const auto block = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
    return static_cast<std::size_t>(x) +
           blocks(0) * (static_cast<std::size_t>(y) + blocks(1) * static_cast<std::size_t>(z));
  };
  std::vector<std::uint8_t> marked(blocks(0) * blocks(1) * blocks(2), 0), is_moved(net_.corner.size(), 0);
  for (const VertexIndex v : moved) {
    is_moved[v] = 1;
    Corner lo, hi;
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::max(0, net_.corner[v][a] - 1 - kReach) >> kShift;
      hi[a] = std::min(top[a], net_.corner[v][a] + kReach) >> kShift;
    }
    for (std::int32_t z = lo[2]; z <= hi[2]; ++z)
      for (std::int32_t y = lo[1]; y <= hi[1]; ++y)
        for (std::int32_t x = lo[0]; x <= hi[0]; ++x) marked[block(x, y, z)] = 1;
  }
  Part part;
  for (std::uint32_t q = 0; q < net_.quads.size(); ++q) {
    const Corner& c = net_.corner[net_.quads[q].v[0]];
    if (marked[block(c[0] >> kShift, c[1] >> kShift, c[2] >> kShift)]) part.quads.push_back(q);
  }
  // Each edge at a moved vertex, or of a quad that has one, lies well within the marked blocks.
  std::vector<std::uint8_t> whole(net_.corner.size(), 0);
  for (const std::uint32_t q : part.quads) {
    const auto& v = net_.quads[q].v;
    if (std::any_of(v.begin(), v.end(), [&](VertexIndex i) { return is_moved[i] != 0; }))
      for (const VertexIndex i : v) whole[i] = 1;
  }
  part.is_whole_at = [&](VertexIndex v) { return whole[v] != 0; };
  Conflicts found;
  search(part, found, context);
  return sorted(std::move(found));
}

}  // namespace octafront::nets
