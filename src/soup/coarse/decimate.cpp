#include "soup/coarse/decimate.h"

#include "base/core/disjoint_sets.h"
#include "base/core/elementary.h"
#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/geometry/blocks.h"
#include "base/geometry/measures.h"
#include "base/geometry/self_intersection.h"
#include "soup/coarse/decimate_piece.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

namespace octafront {

namespace {

/// Vertices of a block: with few much of it is rim.
constexpr std::size_t kMostOfBlock = 16384;
/// Blocks with other planes, so that what was at a rim is tried once more: all but one of a thousand.
constexpr int kStages = 3;

/// An edge at a vertex, and two of its triangles.
struct EdgeAt {
  VertexIndex end = kNone;
  std::uint32_t triangles = 0;
  std::uint32_t first = kNone, second = kNone;
  std::uint32_t fan = 0;  ///< edges of one have triangles that hang together
};

/// Two triangles at an edge: of one sheet, or on the two sides of a crease.
struct TwoTriangles {
  VertexIndex at;
  std::uint32_t first, second;
  bool is_crease;
};

/// Finds the lines of a complex and the sheets between them, and what each vertex may do.
class Outline {
 public:
  Outline(const SurfaceMesh& surface, double sharp_angle, Piece& piece)
      : surface_(surface),
        piece_(piece),
        cosine_(elementary::cos(sharp_angle * std::numbers::pi / 180)),
        at_(rows_at_vertices(surface.points.size(), surface.triangles)),
        normal_(surface.triangles.size()),
        area_(surface.triangles.size()) {
    parallel_for(normal_.size(), [&](std::size_t t) {
      const auto& [a, b, c] = surface.triangles[t];
      const Vec3 n = double_area_normal(surface.points[a], surface.points[b], surface.points[c]);
      area_[t] = length(n) / 2;
      normal_[t] = normalized(n);
    });
  }

  void draw() {
    constexpr std::size_t kRange = 16384;
    piece_.quadric.resize(surface_.points.size());
    piece_.role.resize(surface_.points.size());
    const auto pairs = parallel_collect<TwoTriangles>(surface_.points.size(), kRange,
                                                      [&](std::size_t begin, std::size_t end, auto& out) {
                                                        std::vector<EdgeAt> edges;
                                                        for (std::size_t v = begin; v < end; ++v)
                                                          look_at(static_cast<VertexIndex>(v), edges, out);
                                                      });
    DisjointSets sets(surface_.triangles.size());
    for (const TwoTriangles& p : pairs)
      if (!p.is_crease) sets.join(p.first, p.second);
    piece_.sheet.resize(surface_.triangles.size());
    for (std::uint32_t t = 0; t < piece_.sheet.size(); ++t) piece_.sheet[t] = sets.find(t);
    // A crease that ends within a sheet is no line between two: who is at it stays.
    for (const TwoTriangles& p : pairs)
      if (p.is_crease && piece_.sheet[p.first] == piece_.sheet[p.second]) piece_.role[p.at] = VertexRole::kFixed;
  }

 private:
  void look_at(VertexIndex v, std::vector<EdgeAt>& edges, std::vector<TwoTriangles>& pairs) {
    list_edges(v, edges);
    Quadric sum;
    const Vec3 p = surface_.points[v] - piece_.origin;
    for (const std::uint32_t t : at_[v])
      if (area_[t] > 0) sum += Quadric::of_plane(normal_[t], p, area_[t] / 3);
    std::size_t lines = 0;
    bool is_one_fan = true;
    for (const EdgeAt& e : edges) {
      is_one_fan = is_one_fan && e.fan == edges[0].fan;
      const bool is_border = e.triangles != 2 || is_between_sheets(e);
      const bool is_crease = !is_border && dot(normal_[e.first], normal_[e.second]) < cosine_;
      if (is_crease || (!is_border && e.end > v)) pairs.push_back({v, e.first, e.second, is_crease});
      if (!is_border && !is_crease) continue;
      ++lines;
      const Vec3 along = surface_.points[e.end] - surface_.points[v];
      if (const double l = length(along); l > 0) sum += Quadric::of_line(along / l, p, l * l / 2);
    }
    piece_.quadric[v] = sum;
    const bool is_fixed = (lines != 0 && lines != 2) || !is_one_fan;
    piece_.role[v] = is_fixed ? VertexRole::kFixed : lines == 0 ? VertexRole::kFree : VertexRole::kOnLine;
  }

  void list_edges(VertexIndex v, std::vector<EdgeAt>& edges) const {
    edges.clear();
    const auto edge_to = [&](VertexIndex w, std::uint32_t t) -> EdgeAt& {
      auto e = std::ranges::find(edges, w, &EdgeAt::end);
      if (e == edges.end()) e = edges.insert(e, {.end = w, .fan = static_cast<std::uint32_t>(edges.size())});
      (e->triangles == 0 ? e->first : e->second) = t;
      ++e->triangles;
      return *e;
    };
    for (const std::uint32_t t : at_[v]) {
      const Triangle& corners = surface_.triangles[t];
      const std::size_t i = corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
      const std::uint32_t a = edge_to(corners[(i + 1) % 3], t).fan, b = edge_to(corners[(i + 2) % 3], t).fan;
      if (a == b) continue;
      for (EdgeAt& e : edges)
        if (e.fan == std::max(a, b)) e.fan = std::min(a, b);
    }
  }

  bool is_between_sheets(const EdgeAt& e) const {
    return surface_.sides_of(e.first) != surface_.sides_of(e.second) ||
           surface_.patch_of(e.first) != surface_.patch_of(e.second);
  }

  const SurfaceMesh& surface_;
  Piece& piece_;
  double cosine_;
  Groups<> at_;  ///< the triangles at a vertex
  std::vector<Vec3> normal_;
  std::vector<double> area_;
};

class Decimation {
 public:
  Decimation(const SurfaceMesh& complex, const DecimationLimits& limits, const RunContext& context)
      : made_(complex), limits_(limits), context_(context), kept_(complex.triangles.size()) {
    for (const Vec3& p : complex.points) box_.add(p);
    std::iota(kept_.begin(), kept_.end(), 0u);
    whole_.origin = (box_.lo + box_.hi) * 0.5;
    whole_.points = complex.points;
    whole_.triangles = complex.triangles;
    whole_.is_wanted.assign(complex.points.size(), 1);
    Outline(complex, limits.sharp_angle, whole_).draw();
  }

  SurfaceMesh run(Crossings crossings) && {
    for (int stage = 0; stage < kStages; ++stage) {
      context_.check();
      change_blocks(stage, crossings);
      leave_out_removed();
    }
    return std::move(*this).result();
  }

 private:
  void change_blocks(int stage, Crossings crossings) {
    const Cells cells = cells_of(whole_.points, cube_of_stage(box_, stage), kMostOfBlock);
    const Groups<> triangles_of(cells.count, [&](const auto& add) {
      for (std::uint32_t t = 0; t < whole_.triangles.size(); ++t) {
        const auto& [a, b, c] = whole_.triangles[t];
        const std::uint32_t i = cells.of[a], j = cells.of[b], k = cells.of[c];
        add(i, t);
        if (j != i) add(j, t);
        if (k != i && k != j) add(k, t);
      }
    });
    PerThread<std::vector<std::uint32_t>> numbering;  // of vertices in the piece; kNone between pieces
    parallel_for(
        cells.count,
        [&](std::size_t cell) {
          change_block(cells, static_cast<std::uint32_t>(cell), triangles_of[cell], crossings,
                       numbering.local([&] { return std::vector<std::uint32_t>(whole_.points.size(), kNone); }));
        },
        Split::kSingly);
  }

  /// Changes only what lies wholly in the cell, and sees all that meets its triangles.
  void change_block(const Cells& cells, std::uint32_t cell, std::span<const std::uint32_t> triangles,
                    Crossings crossings, std::vector<std::uint32_t>& number) {
    std::vector<VertexIndex> vertex;
    Piece piece = piece_of(cells, cell, triangles, vertex, number);
    decimate(piece, limits_, crossings, context_);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      if (cells.holding(whole_.triangles[triangles[i]]) != cell) continue;
      Triangle& t = whole_.triangles[triangles[i]];
      t = piece.triangles[i];
      if (t[0] == kNone) continue;
      for (VertexIndex& v : t) v = vertex[v];
    }
    for (std::size_t i = 0; i < vertex.size(); ++i) {
      if (cells.of[vertex[i]] != cell) continue;
      whole_.quadric[vertex[i]] = piece.quadric[i];
      if (piece.is_at_rim[i]) continue;  // others read where it is
      whole_.points[vertex[i]] = piece.points[i];
      whole_.is_wanted[vertex[i]] = 0;
    }
  }

  Piece piece_of(const Cells& cells, std::uint32_t cell, std::span<const std::uint32_t> triangles,
                 std::vector<VertexIndex>& vertex, std::vector<std::uint32_t>& number) const {
    Piece piece;
    piece.origin = whole_.origin;
    for (const std::uint32_t t : triangles) {
      Triangle own{};
      for (int i = 0; i < 3; ++i) {
        const VertexIndex v = whole_.triangles[t][i];
        if (number[v] == kNone) {
          number[v] = static_cast<std::uint32_t>(vertex.size());
          vertex.push_back(v);
        }
        own[i] = number[v];
      }
      piece.triangles.push_back(own);
      piece.sheet.push_back(whole_.sheet[t]);
    }
    for (const VertexIndex v : vertex) {
      const bool is_inside = cells.of[v] == cell;  // else another block may be changing what is not looked at here
      number[v] = kNone;
      piece.points.push_back(whole_.points[v]);
      piece.quadric.push_back(is_inside ? whole_.quadric[v] : Quadric{});
      piece.role.push_back(whole_.role[v]);
      piece.is_wanted.push_back(is_inside ? whole_.is_wanted[v] : 0);
      piece.is_at_rim.push_back(!is_inside);
    }
    const std::vector<std::uint8_t> is_outside = piece.is_at_rim;
    for (const Triangle& t : piece.triangles)
      if (is_outside[t[0]] || is_outside[t[1]] || is_outside[t[2]])
        for (const VertexIndex v : t) piece.is_at_rim[v] = 1;
    return piece;
  }

  void leave_out_removed() {
    const auto is_left = [&](std::size_t t) { return !whole_.is_removed(static_cast<std::uint32_t>(t)); };
    std::size_t n = 0;
    std::vector<std::uint32_t> number(whole_.points.size(), kNone);
    for (std::size_t t = 0; t < whole_.triangles.size(); ++t) {
      if (!is_left(t)) continue;
      for (const VertexIndex v : whole_.triangles[t]) number[v] = 0;
      whole_.triangles[n] = whole_.triangles[t];
      whole_.sheet[n] = whole_.sheet[t];
      kept_[n++] = kept_[t];
    }
    whole_.triangles.resize(n), whole_.sheet.resize(n), kept_.resize(n);
    std::uint32_t points = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] == kNone) continue;
      number[v] = points;
      whole_.points[points] = whole_.points[v];
      whole_.quadric[points] = whole_.quadric[v];
      whole_.role[points] = whole_.role[v];
      whole_.is_wanted[points++] = whole_.is_wanted[v];
    }
    whole_.points.resize(points), whole_.quadric.resize(points), whole_.role.resize(points);
    whole_.is_wanted.resize(points);
    for (Triangle& t : whole_.triangles)
      for (VertexIndex& v : t) v = number[v];
  }

  SurfaceMesh result() && {
    const auto keep = [&](auto& of_triangles) {
      if (of_triangles.empty()) return;
      for (std::size_t t = 0; t < kept_.size(); ++t) of_triangles[t] = of_triangles[kept_[t]];
      of_triangles.resize(kept_.size());
    };
    if (made_.source.empty()) {
      made_.source = kept_;
    } else {
      keep(made_.source);
    }
    keep(made_.patch), keep(made_.sides);
    made_.points = std::move(whole_.points);
    made_.triangles = std::move(whole_.triangles);
    return std::move(made_);
  }

  SurfaceMesh made_;
  const DecimationLimits& limits_;
  const RunContext& context_;
  Box3 box_;
  Piece whole_;
  std::vector<std::uint32_t> kept_;  ///< the triangle of the complex that each is, changed or not
};

}  // namespace

SurfaceMesh decimated(const SurfaceMesh& complex, const DecimationLimits& limits, const RunContext& context) {
  SurfaceMesh made = Decimation(complex, limits, context).run(Crossings::kUntested);
  if (self_intersections(made.points, made.triangles, 1, context).empty()) return made;
  return Decimation(complex, limits, context).run(Crossings::kTested);
}

}  // namespace octafront
