#include "base/core/disjoint_sets.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "soup/mend/caps.h"
#include "soup/mend/mend_steps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace octafront::mend {
namespace {

using tidy::Draft;

/// A part with caps of more than this share of its own area is a sheet. Of a hemisphere it is half, of a tube as long
/// as wide half too, of a terrain nearly all.
constexpr double kMostCapped = 0.9;
/// The same for parts beside others that are closed, but for holes of this share.
constexpr double kMostCappedBeside = 0.3, kNearlyClosed = 0.05;
/// Of the area of the cap that bends least, where the least area is taken instead.
constexpr double kMuchLess = 0.8;

/// Edges with a vertex on a rim.
struct RimEdges {
  std::unordered_set<std::uint64_t> between;                 ///< those with both: caps should not use them again
  std::vector<std::pair<VertexIndex, VertexIndex>> leaving;  ///< from a vertex on a rim to another one, ascending
};
RimEdges edges_at(const EdgeTable& table, const std::vector<Loop>& loops, std::size_t vertices) {
  std::vector<char> on_rim(vertices, 0);
  for (const Loop& loop : loops)
    for (const VertexIndex v : loop.vertices) on_rim[v] = 1;
  RimEdges edges;
  for (const auto& [a, b] : table.edges) {
    if (on_rim[a] && on_rim[b]) edges.between.insert(edge_key(a, b));
    if (on_rim[a]) edges.leaving.emplace_back(a, b);
    if (on_rim[b]) edges.leaving.emplace_back(b, a);
  }
  std::sort(edges.leaving.begin(), edges.leaving.end());
  return edges;
}

/// A hole with what is around it.
class Rim {
 public:
  Rim(const Draft& draft, const Loop& loop, const std::unordered_set<std::uint64_t>& taken)
      : draft_(draft), loop_(loop), taken_(taken) {
    for (const VertexIndex v : loop.vertices) polygon_.push_back(draft.mesh.points[v]);
    for (const std::uint32_t t : loop.triangles) {
      const auto [a, b, c] = draft.mesh.triangles[t];
      beyond_.push_back(unit_normal(draft.mesh.points[a], draft.mesh.points[b], draft.mesh.points[c]));
    }
  }

  Hole closed(Least least) const {
    Hole hole;
    hole.rim_triangle = loop_.triangles.front();
    for (const auto& [i, j, k] : triangulate_polygon(polygon_, beyond_, is_taken(), least)) {
      hole.cap.push_back({loop_.vertices[i], loop_.vertices[j], loop_.vertices[k]});
      hole.area += triangle_area(polygon_[i], polygon_[j], polygon_[k]);
    }
    return hole;
  }

  /// Gives the hole a cap that goes on as the surface around it begins, if that bends at all of the rim. `next_to`:
  /// pairs of vertices on rims and what they share edges with, ascending.
  void make_fair(Hole& hole, const std::vector<std::pair<VertexIndex, VertexIndex>>& next_to) const {
    const auto corner = corners();
    const Cap plain = by_corner(hole.cap, corner);
    if (!bends_around(plain)) return;
    std::vector<Spoke> spokes;
    for (std::uint32_t i = 0; i < loop_.vertices.size(); ++i) {
      const VertexIndex v = loop_.vertices[i];
      const auto from = std::lower_bound(next_to.begin(), next_to.end(), std::pair(v, VertexIndex{0}));
      for (auto at = from; at != next_to.end() && at->first == v; ++at)
        if (!corner.contains(at->second)) spokes.emplace_back(i, draft_.mesh.points[at->second]);
    }
    FairCap fair = faired(polygon_, plain, spokes, is_taken(), kMostInner);
    if (!fair.inner.empty()) take(hole, std::move(fair));
  }

  /// Gives the hole a cap that keeps off the surface, if this one would graze it. `outward`: the cap's normals point
  /// out of what it closes. `around`: points of the surface. Where that base would be thinner than the tolerance the
  /// cap stays.
  void set_off(Hole& hole, bool outward, std::span<const Vec3> around, double tolerance) const {
    Box3 box;
    for (const Vec3 p : polygon_) box.add(p);
    if (kBaseThickness * box.diagonal() < tolerance || !grazes(by_corner(hole.cap, corners()))) return;
    Vec3 twice;
    for (std::size_t i = 0; i + 2 < polygon_.size(); ++i)
      twice += double_area_normal(polygon_[0], polygon_[i + 1], polygon_[i + 2]);
    if (twice == Vec3{}) return;
    FairCap based = cap_with_base(polygon_, normalized(outward ? twice : -twice), around);
    hole.has_base = !based.triangles.empty();
    if (hole.has_base) take(hole, std::move(based));
  }

 private:
  using Corners = std::unordered_map<VertexIndex, std::uint32_t>;
  Corners corners() const {
    Corners corner;
    for (const VertexIndex v : loop_.vertices) corner.emplace(v, static_cast<std::uint32_t>(corner.size()));
    return corner;
  }

  static Cap by_corner(const std::vector<Triangle>& triangles, const Corners& corner) {
    Cap cap;
    for (const Triangle& t : triangles) cap.push_back({corner.at(t[0]), corner.at(t[1]), corner.at(t[2])});
    return cap;
  }

  void take(Hole& hole, FairCap by) const {
    hole.cap.clear();
    for (const auto& t : by.triangles) hole.cap.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
    hole.inner = std::move(by.inner);
  }

  IsTaken is_taken() const {
    return [this](std::uint32_t i, std::uint32_t j) {
      return taken_.contains(edge_key(loop_.vertices[i], loop_.vertices[j]));
    };
  }

  /// Inner points come behind those of the draft.
  VertexIndex vertex(std::uint32_t i) const {
    const auto n = static_cast<std::uint32_t>(polygon_.size());
    return i < n ? loop_.vertices[i] : static_cast<VertexIndex>(draft_.mesh.points.size()) + i - n;
  }

  /// How far the cap turns against what is beyond, edge by edge of the rim: radians, and the edge's length.
  std::vector<std::pair<double, double>> turns(const Cap& cap) const {
    std::vector<std::pair<double, double>> all;
    for (const auto& t : cap)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t i = t[k], j = t[(k + 1) % 3];
        if ((i + 1) % polygon_.size() != j || beyond_[i] == Vec3{}) continue;
        const Vec3 normal = unit_normal(polygon_[t[0]], polygon_[t[1]], polygon_[t[2]]);
        all.emplace_back(angle_at({}, normal, beyond_[i]), distance(polygon_[i], polygon_[j]));
      }
    return all;
  }

  /// Whether the cap turns against what is beyond at most of the rim, and not as far as a lid does.
  bool bends_around(const Cap& cap) const {
    double around = 0, turned = 0, sum = 0;
    for (const auto& [turn, size] : turns(cap)) {
      around += size;
      sum += turn * size;
      if (turn > kLeastTurn) turned += size;
    }
    return turned > kMostOfRim * around && sum < kMostTurn * around;
  }

  /// Whether the cap lies nearly on the surface beside it, at much of the rim.
  bool grazes(const Cap& cap) const {
    double around = 0, grazing = 0;
    for (const auto& [turn, size] : turns(cap)) {
      around += size;
      if (turn > std::numbers::pi - kGrazing) grazing += size;
    }
    return grazing > kMostGrazing * around;
  }

  static constexpr std::size_t kMostInner = 4000;
  /// Radians: where the surface around is flatter than the least, a flat cap is as good; where a cap turns more than
  /// the most, the surface was cut off there.
  static constexpr double kLeastTurn = 0.08, kMostTurn = 1, kMostOfRim = 0.3;
  /// Radians (10 degrees): elements in a wedge like that are bad ones. Of the rim, where a lid may be in such a wedge:
  /// a few teeth of a torn rim lie so under any lid.
  static constexpr double kGrazing = 0.175, kMostGrazing = 0.1;

  const Draft& draft_;
  const Loop& loop_;
  const std::unordered_set<std::uint64_t>& taken_;
  std::vector<Vec3> polygon_, beyond_;
};

/// Of a part that hangs together: its own area, that of its caps, and what both enclose.
struct Part {
  double area = 0, capped = 0, volume = 0;
  bool is_sheet = false;

  bool is_thin(double tolerance) const { return 2 * std::abs(volume) <= tolerance * area; }
};

class PartsOfDraft {
 public:
  PartsOfDraft(const Draft& draft, const EdgeTable& table) : draft_(draft), sets_(draft.mesh.triangles.size()) {
    for (std::size_t e = 0; e < table.size(); ++e)
      for (const HalfEdge h : table.uses(e)) sets_.join(table.uses(e)[0] / 3, h / 3);
    part_.resize(draft.mesh.triangles.size());
    for (std::uint32_t t = 0; t < draft.mesh.triangles.size(); ++t) add(t, draft.mesh.triangles[t], false);
  }

  void add_cap(const Hole& hole) {
    for (const Triangle& t : hole.cap) add(hole.rim_triangle, t, true);
  }

  /// Requires that all caps are known. Returns whether a part is closed, nearly.
  bool judge(double tolerance) {
    bool any_closed = false;
    for (const Part& part : part_)
      any_closed = any_closed || (!part.is_thin(tolerance) && part.capped <= kNearlyClosed * part.area);
    for (Part& part : part_)
      part.is_sheet =
          part.is_thin(tolerance) || part.capped > (any_closed ? kMostCappedBeside : kMostCapped) * part.area;
    return any_closed;
  }

  bool is_one_sheet() {
    const Part& part = part_[0];
    return part.capped > kMostCapped * part.area &&
           std::all_of(part_.begin() + 1, part_.end(), [](const Part& other) { return other.area == 0; });
  }

  /// Whether the shape of its caps may decide what it is.
  bool is_doubtful(std::uint32_t triangle) {
    const Part& part = part_[sets_.find(triangle)];
    return part.capped > kMostCappedBeside * part.area;
  }

  void replace_cap(const Hole& hole, const Hole& by) {
    part_[sets_.find(hole.rim_triangle)].capped -= hole.area;
    for (const Triangle& t : hole.cap) add_volume(hole.rim_triangle, t, -1);
    add_cap(by);
  }

  bool is_inside_out(std::uint32_t triangle) { return part_[sets_.find(triangle)].volume < 0; }
  bool is_sheet(std::uint32_t triangle) { return part_[sets_.find(triangle)].is_sheet; }

 private:
  void add(std::uint32_t of, const Triangle& t, bool is_cap) {
    const std::uint32_t first = sets_.find(of);
    Part& part = part_[first];
    const auto at = [&](VertexIndex v) { return draft_.mesh.points[v]; };
    (is_cap ? part.capped : part.area) += triangle_area(at(t[0]), at(t[1]), at(t[2]));
    add_volume(of, t, 1);
  }

  void add_volume(std::uint32_t of, const Triangle& t, double times) {
    const std::uint32_t first = sets_.find(of);
    const auto at = [&](VertexIndex v) { return draft_.mesh.points[v]; };
    part_[first].volume += times * signed_volume(at(draft_.mesh.triangles[first][0]), at(t[0]), at(t[1]), at(t[2]));
  }

  const Draft& draft_;
  DisjointSets sets_;
  std::vector<Part> part_;  ///< at the first triangle of each
};

void add_inner_points(Draft& draft, std::vector<Hole>& holes) {
  const auto given = static_cast<VertexIndex>(draft.mesh.points.size());
  for (Hole& hole : holes) {
    const auto added = static_cast<VertexIndex>(draft.mesh.points.size()) - given;
    for (Triangle& t : hole.cap)
      for (VertexIndex& v : t)
        if (v >= given) v += added;
    draft.mesh.points.insert(draft.mesh.points.end(), hole.inner.begin(), hole.inner.end());
  }
}

/// Which holes have a lid in common now: it is the outer one's.
std::vector<char> share_lids(const Draft& draft, const std::vector<Loop>& loops, const std::vector<char>& is_sheet,
                             double tolerance, std::vector<Hole>& holes) {
  std::vector<char> may_share, is_shared(holes.size(), 0);
  for (const Hole& hole : holes) may_share.push_back(!is_sheet[hole.rim_triangle]);
  for (SharedLid& lid : shared_lids(draft.mesh.points, loops, may_share, tolerance)) {
    for (const std::uint32_t i : lid.loops) {
      is_shared[i] = 1;
      holes[i].cap.clear();
    }
    holes[lid.loops.front()].cap = std::move(lid.cap);
  }
  return is_shared;
}

}  // namespace

ClosedHoles close_holes(Draft& draft, double tolerance) {
  const EdgeTable& table = draft.edges();
  const std::vector<Loop> loops = find_loops(draft.mesh.triangles, table);
  const RimEdges edges = edges_at(table, loops, draft.mesh.points.size());
  std::vector<Rim> rims;
  for (const Loop& loop : loops) rims.emplace_back(draft, loop, edges.between);
  const auto for_each_rim = [&](auto&& work) {
    parallel_for(
        rims.size(),
        [&](std::size_t i) {
          draft.context.check();
          work(i);
        },
        Split::kSingly);
  };
  std::vector<Hole> all(loops.size());
  for_each_rim([&](std::size_t i) { all[i] = rims[i].closed(Least::kBend); });
  PartsOfDraft parts(draft, table);
  for (const Hole& hole : all) parts.add_cap(hole);
  for (std::size_t i = 0; i < all.size(); ++i) {
    // What bends least may go down into a bowl instead of over it.
    if (!parts.is_doubtful(all[i].rim_triangle)) continue;
    Hole flat = rims[i].closed(Least::kArea);
    if (flat.area > kMuchLess * all[i].area) continue;
    parts.replace_cap(all[i], flat);
    all[i] = std::move(flat);
  }
  ClosedHoles result;
  if (parts.judge(tolerance)) result.is_sheet = triangles_of_fins(draft.mesh.triangles, table, loops);
  result.is_sheet.resize(draft.mesh.triangles.size(), 0);
  for (std::uint32_t t = 0; t < result.is_sheet.size(); ++t)
    if (parts.is_sheet(t)) result.is_sheet[t] = 1;
  result.is_one_sheet = !draft.mesh.triangles.empty() && parts.is_one_sheet();
  const std::vector<char> is_shared = share_lids(draft, loops, result.is_sheet, tolerance, all);
  std::vector<char> is_outward;
  for (const Hole& hole : all) is_outward.push_back(!parts.is_inside_out(hole.rim_triangle));
  for_each_rim([&](std::size_t i) {
    if (result.is_sheet[all[i].rim_triangle] || is_shared[i]) return;
    rims[i].set_off(all[i], is_outward[i], draft.mesh.points, tolerance);
    if (!all[i].has_base) rims[i].make_fair(all[i], edges.leaving);
  });
  std::erase_if(all, [&](const Hole& hole) { return result.is_sheet[hole.rim_triangle]; });
  add_inner_points(draft, all);
  result.holes = std::move(all);
  return result;
}

}  // namespace octafront::mend
