#include "layers/columns/assemble.h"

#include "base/mesh/edge_table.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace octafront::layers {

namespace {

constexpr const char* kRegionName = "layers";
/// What the rest is called where it has no name.
constexpr const char* kRestName = "volume";

/// An edge between a triangle of the wall, in which it runs from a to b, and a bare one.
struct Rim {
  VertexIndex a, b;
  std::uint32_t bare;
};

std::vector<Rim> rims_of(const SurfaceMesh& wall, const Columns& columns) {
  std::vector<Rim> rims;
  const EdgeTable edges = make_edge_table(wall.points.size(), wall.triangles);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto uses = edges.uses(e);
    if (uses.size() != 2) continue;
    for (int i = 0; i < 2; ++i) {
      const std::uint32_t h = uses[i], bare = uses[1 - i] / 3;
      if (!columns.is_wall[h / 3] || columns.is_wall[bare]) continue;
      const Triangle& t = wall.triangles[h / 3];
      rims.push_back({t[h % 3], t[(h + 1) % 3], bare});
    }
  }
  return rims;
}

/// Numbers of nodes: those of the wall as they are, behind them those of columns, in their order: then the node with
/// the smallest number of a quad is on the column with the smaller number, and divides it.
class NodeNumbers {
 public:
  explicit NodeNumbers(const Columns& columns) : first_(columns.count.size(), 0) {
    end_ = static_cast<VertexIndex>(first_.size());
    for (VertexIndex v = 0; v < first_.size(); ++v) {
      first_[v] = end_;
      end_ += columns.count[v];
    }
  }

  VertexIndex operator()(Node node) const {
    return node.level == 0 ? node.column : first_[node.column] + node.level - 1;
  }
  VertexIndex end() const { return end_; }

 private:
  std::vector<VertexIndex> first_;
  VertexIndex end_;
};

class Assembly {
 public:
  Assembly(const SurfaceMesh& wall, const Columns& columns)
      : wall_(wall), columns_(columns), rims_(rims_of(wall, columns)), number_(columns) {}

  Layered run(TetMesh inner) && {
    place_nodes(inner);
    renumber(inner);
    grow_tets(inner);
    make_boundary();
    name(inner);
    inner.points = std::move(points_);
    const SurfaceMesh& b = boundary_;
    inner.boundary = b.triangles, inner.patch = b.patch, inner.source = b.source;
    inner.wide_faces = std::move(wide_faces_);
    boundary_.points.assign(inner.points.begin(), inner.points.begin() + number_.end());
    return {std::move(inner), std::move(boundary_)};
  }

 private:
  void place_nodes(const TetMesh& inner) {
    points_.resize(number_.end());
    for (VertexIndex v = 0; v < wall_.points.size(); ++v)
      for (std::uint32_t k = 0; k <= columns_.count[v]; ++k) points_[number_({v, k})] = columns_.place(wall_, {v, k});
    const auto own = static_cast<std::ptrdiff_t>(wall_.points.size());
    points_.insert(points_.end(), inner.points.begin() + own, inner.points.end());
  }

  VertexIndex top(VertexIndex v) const { return number_({v, columns_.count[v]}); }

  void renumber(TetMesh& inner) const {
    const auto own = static_cast<VertexIndex>(wall_.points.size());
    for (Tet& tet : inner.tets)
      for (VertexIndex& v : tet) v = v < own ? top(v) : v - own + number_.end();
  }

  void grow_tets(TetMesh& inner) const {
    inner.region.resize(inner.tets.size(), 0);
    const std::uint32_t last = inner.region.empty() ? 0 : *std::ranges::max_element(inner.region);
    for (std::size_t f = 0; f < wall_.triangles.size(); ++f) {
      if (!columns_.is_wall[f]) continue;
      for (std::uint32_t k = 0; k < columns_.asked; ++k) {
        const TetsOfLayer made = tets_of_layer(columns_, wall_.triangles[f], k);
        if (made.count > 1) inner.wide_cells.push_back(wide_cell(static_cast<TetIndex>(inner.tets.size()), f, k));
        for (int i = 0; i < made.count; ++i) {
          const auto& [a, b, c, d] = made.tets[i];
          inner.tets.push_back({number_(a), number_(b), number_(c), number_(d)});
        }
      }
    }
    inner.region.resize(inner.tets.size(), last + 1);
  }

  /// The wedge of a layer over a triangle, or the pyramid where one of the columns has ended.
  WideCell wide_cell(TetIndex first, std::size_t f, std::uint32_t k) const {
    const auto [a, b, c] = wall_.triangles[f];
    const auto at = [&](VertexIndex v, std::uint32_t level) {
      return number_({v, std::min(level, columns_.count[v])});
    };
    // The triangle's normal points away from its layers.
    for (const auto& [end, p, q] : {std::array{a, b, c}, {b, c, a}, {c, a, b}})
      if (columns_.count[end] <= k)
        return {first, 2, {at(q, k), at(q, k + 1), at(p, k + 1), at(p, k), at(end, k), kNone}};
    return {first, 3, {at(a, k), at(c, k), at(b, k), at(a, k + 1), at(c, k + 1), at(b, k + 1)}};
  }

  void make_boundary() {
    for (std::uint32_t f = 0; f < wall_.triangles.size(); ++f) {
      Triangle t = wall_.triangles[f];
      if (!columns_.is_wall[f])
        for (VertexIndex& v : t) v = top(v);
      add(t, f);
    }
    for (const Rim& rim : rims_)
      for (std::uint32_t k = 0; k < columns_.asked; ++k) add_strip(rim, k);
    boundary_.patch_names = wall_.patch_names;
  }

  void add(const Triangle& t, std::uint32_t like) {
    boundary_.triangles.push_back(t);
    boundary_.patch.push_back(wall_.patch_of(like));
    boundary_.source.push_back(wall_.source_of(like));
  }

  /// The side of a layer, which lies where the bare triangle was: that one runs from b to a.
  void add_strip(const Rim& rim, std::uint32_t k) {
    const VertexIndex x = std::min(rim.a, rim.b), y = std::max(rim.a, rim.b);
    const auto first = static_cast<std::uint32_t>(boundary_.triangles.size());
    const auto low = [&](VertexIndex v) { return number_({v, std::min(k, columns_.count[v])}); };
    const auto high = [&](VertexIndex v) { return number_({v, std::min(k + 1, columns_.count[v])}); };
    const auto add_facing = [&](VertexIndex p, VertexIndex q, VertexIndex r) {
      if (p == q || q == r || r == p) return;
      add(x == rim.b ? Triangle{p, q, r} : Triangle{q, p, r}, rim.bare);
    };
    add_facing(low(x), low(y), high(y));
    add_facing(low(x), high(y), high(x));
    if (boundary_.triangles.size() == first + 2)
      wide_faces_.push_back({first, {low(rim.b), low(rim.a), high(rim.a), high(rim.b)}});
  }

  void name(TetMesh& inner) const {
    const std::uint32_t region = inner.region.empty() ? 0 : inner.region.back();
    inner.region_names.resize(region + 1);
    if (region == 1 && inner.region_names.front().empty()) inner.region_names.front() = kRestName;
    inner.region_names.back() = kRegionName;
  }

  const SurfaceMesh& wall_;
  const Columns& columns_;
  std::vector<Rim> rims_;
  NodeNumbers number_;
  std::vector<Vec3> points_;
  SurfaceMesh boundary_;
  std::vector<WideFace> wide_faces_;
};

}  // namespace

SurfaceMesh top_of(const SurfaceMesh& wall, const Columns& columns) {
  SurfaceMesh top = wall;
  for (VertexIndex v = 0; v < top.points.size(); ++v) top.points[v] = columns.top(wall, v);
  return top;
}

Layered with_layers(const SurfaceMesh& wall, const Columns& columns, TetMesh inner) {
  return Assembly(wall, columns).run(std::move(inner));
}

}  // namespace octafront::layers
