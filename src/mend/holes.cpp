#include "mend/holes.h"

#include "core/disjoint_sets.h"
#include "core/parallel.h"
#include "geometry/measures.h"
#include "mend/cap.h"
#include "mend/loops.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace octafront::mend {
namespace {

using repair::Draft;

/// A part with caps of more than this share of its own area is a sheet. Of a hemisphere it is half, of a tube as long
/// as wide half too, of a terrain nearly all.
constexpr double kMostCapped = 0.9;
/// The same for parts beside others that are closed, but for holes of this share.
constexpr double kMostCappedBeside = 0.3, kNearlyClosed = 0.05;

std::uint64_t key_of(VertexIndex a, VertexIndex b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// Edges between vertices of rims, which caps should not use again.
std::unordered_set<std::uint64_t> edges_between(const EdgeTable& table, const std::vector<Loop>& loops,
                                                std::size_t vertices) {
  std::vector<char> on_rim(vertices, 0);
  for (const Loop& loop : loops)
    for (const VertexIndex v : loop.vertices) on_rim[v] = 1;
  std::unordered_set<std::uint64_t> taken;
  for (const auto& [a, b] : table.edges)
    if (on_rim[a] && on_rim[b]) taken.insert(key_of(a, b));
  return taken;
}

Hole closed(const Draft& draft, const Loop& loop, const std::unordered_set<std::uint64_t>& taken) {
  std::vector<Vec3> polygon, beyond;
  for (const VertexIndex v : loop.vertices) polygon.push_back(draft.mesh.points[v]);
  for (const std::uint32_t t : loop.triangles) {
    const auto [a, b, c] = draft.mesh.triangles[t];
    beyond.push_back(unit_normal(draft.mesh.points[a], draft.mesh.points[b], draft.mesh.points[c]));
  }
  Hole hole;
  hole.rim_triangle = loop.triangles.front();
  double around = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    around += distance(polygon[i], polygon[(i + 1) % polygon.size()]);
    hole.at += polygon[i] / static_cast<double>(polygon.size());
  }
  const auto is_taken = [&](std::uint32_t i, std::uint32_t j) {
    return taken.contains(key_of(loop.vertices[i], loop.vertices[j]));
  };
  for (const auto& [i, j, k] : triangulate_polygon(polygon, beyond, is_taken)) {
    hole.cap.push_back({loop.vertices[i], loop.vertices[j], loop.vertices[k]});
    hole.area += triangle_area(polygon[i], polygon[j], polygon[k]);
  }
  hole.width = around > 0 ? 2 * hole.area / around : 0;
  return hole;
}

/// Of a part that hangs together: its own area, that of its caps, and what both enclose.
struct Part {
  double area = 0, capped = 0, volume = 0;
  bool is_sheet = false;

  bool is_thin(double tolerance) const { return 2 * std::abs(volume) <= tolerance * area; }
};

class Parts {
 public:
  Parts(const Draft& draft, const EdgeTable& table) : draft_(draft), sets_(draft.mesh.triangles.size()) {
    for (std::size_t e = 0; e < table.size(); ++e)
      for (const HalfEdge h : table.uses(e)) sets_.join(table.uses(e)[0] / 3, h / 3);
    part_.resize(draft.mesh.triangles.size());
    for (std::uint32_t t = 0; t < draft.mesh.triangles.size(); ++t) add(t, draft.mesh.triangles[t], false);
  }

  void add_cap(const Hole& hole) {
    for (const Triangle& t : hole.cap) add(hole.rim_triangle, t, true);
  }

  /// Requires that all caps are known.
  void judge(double tolerance) {
    bool any_closed = false;
    for (const Part& part : part_)
      any_closed = any_closed || (!part.is_thin(tolerance) && part.capped <= kNearlyClosed * part.area);
    for (Part& part : part_)
      part.is_sheet =
          part.is_thin(tolerance) || part.capped > (any_closed ? kMostCappedBeside : kMostCapped) * part.area;
  }

  bool is_one_sheet() {
    const Part& part = part_[0];
    return part.capped > kMostCapped * part.area &&
           std::all_of(part_.begin() + 1, part_.end(), [](const Part& other) { return other.area == 0; });
  }

  bool is_sheet(std::uint32_t triangle) { return part_[sets_.find(triangle)].is_sheet; }

 private:
  void add(std::uint32_t of, const Triangle& t, bool is_cap) {
    const std::uint32_t first = sets_.find(of);
    Part& part = part_[first];
    const auto at = [&](VertexIndex v) { return draft_.mesh.points[v]; };
    (is_cap ? part.capped : part.area) += triangle_area(at(t[0]), at(t[1]), at(t[2]));
    part.volume += signed_volume(at(draft_.mesh.triangles[first][0]), at(t[0]), at(t[1]), at(t[2]));
  }

  const Draft& draft_;
  DisjointSets sets_;
  std::vector<Part> part_;  ///< at the first triangle of each
};

}  // namespace

ClosedHoles close_holes(Draft& draft, double tolerance) {
  const EdgeTable& table = draft.edges();
  const std::vector<Loop> loops = find_loops(draft.mesh.triangles, table);
  const auto taken = edges_between(table, loops, draft.mesh.points.size());
  ClosedHoles result;
  std::vector<Hole>& all = result.holes;
  all.resize(loops.size());
  parallel_for(
      loops.size(),
      [&](std::size_t i) {
        draft.context.check();
        all[i] = closed(draft, loops[i], taken);
      },
      Split::kSingly);
  Parts parts(draft, table);
  for (const Hole& hole : all) parts.add_cap(hole);
  parts.judge(tolerance);
  std::erase_if(all, [&](const Hole& hole) { return parts.is_sheet(hole.rim_triangle); });
  for (std::uint32_t t = 0; t < draft.mesh.triangles.size(); ++t) result.is_sheet.push_back(parts.is_sheet(t));
  result.is_one_sheet = !draft.mesh.triangles.empty() && parts.is_one_sheet();
  return result;
}

}  // namespace octafront::mend
