#include "lattice/core.h"

#include "geometry/triangle_tree.h"
#include "lattice/graded_bcc.h"
#include "lattice/lattice_octree.h"
#include "lattice/site_table.h"

#include <algorithm>
#include <numeric>

namespace octafront {

namespace {

// Distance of the core from the surface over the size there: room for one good layer of the front, and no more.
constexpr double kCoreClearance = 0.8;

using Sites = std::array<LatticeSite, 4>;

// Leaves that a ball of the clearance about some triangle can reach; everything else is far from the surface.
class NearLeaves {
 public:
  NearLeaves(const LatticeOctree& lattice, const SurfaceMesh& surface, const SizeField& sizes)
      : lattice_(lattice), near_(lattice.tree.size(), false) {
    for (const Triangle& t : surface.triangles) {
      Box3 box;
      double reach = 0;
      for (const VertexIndex v : t) {
        box.add(surface.points[v]);
        reach = std::max(reach, sizes.at(surface.points[v]));
      }
      // Sizes grow by a part of the distance; within the clearance, twice the size at the triangle is never exceeded.
      mark(box, 2 * kCoreClearance * reach);
    }
  }
  bool contains(Vec3 p) const { return near_[lattice_.tree.find(lattice_.root.cell(p))]; }

 private:
  void mark(Box3 box, double reach) {
    const Vec3 margin{reach, reach, reach};
    box = {box.lo - margin, box.hi + margin};
    const Vec3 extent = box.extent();
    const double largest = std::max({extent.x, extent.y, extent.z});
    int level = 0;
    while (level < kFinestLatticeLevel && lattice_.root.side / (2u << level) >= largest) ++level;
    // At most eight cells of this level meet the box.
    const auto lo = lattice_.root.cell(box.lo).ancestor(level), hi = lattice_.root.cell(box.hi).ancestor(level);
    const auto a = lo.corner(), b = hi.corner();
    const std::uint32_t side = lo.side();
    for (std::uint32_t z = a[2]; z <= b[2]; z += side)
      for (std::uint32_t y = a[1]; y <= b[1]; y += side)
        for (std::uint32_t x = a[0]; x <= b[0]; x += side) mark(OctreeKey::containing(x, y, z, level), box);
  }

  void mark(OctreeKey cell, const Box3& box) {
    const Vec3 lo = lattice_.root.corner_of(cell);
    const double side = lattice_.root.side_of(cell);
    if (!box.overlaps({lo, lo + Vec3{side, side, side}})) return;
    const std::size_t i = lattice_.tree.find(cell);
    if (lattice_.tree.leaf(i).level() <= cell.level()) {
      near_[i] = true;
      return;
    }
    for (int c = 0; c < 8; ++c) mark(cell.child(c), box);
  }

  const LatticeOctree& lattice_;
  std::vector<bool> near_;
};

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// Which sites of a lattice belong to the core: clear of the surface, and inside it.
class DeepSites {
 public:
  DeepSites(const LatticeOctree& lattice, const SurfaceMesh& surface, const TriangleTree& triangles,
            const SizeField& sizes, const RunContext& context)
      : lattice_(lattice),
        triangles_(triangles),
        sizes_(sizes),
        near_(lattice, surface, sizes),
        table_(2 * lattice.tree.size()) {
    find_clear(context);
    keep_inside();
  }

  std::uint32_t index(LatticeSite site) { return table_[site]; }
  bool is_deep(std::uint32_t i) const { return deep_[i]; }
  Vec3 position_of(std::uint32_t i) const { return position(lattice_.root, table_.sites()[i]); }
  std::size_t size() const { return deep_.size(); }

 private:
  // An edge between two sites that keep the clearance does not cross the surface, so what such edges connect lies on
  // one side of it: one inside test a component is enough.
  void find_clear(const RunContext& context) {
    for_each_lattice_tet(lattice_.tree, [&](const Sites& tet) {
      std::array<std::uint32_t, 4> i{};
      for (int k = 0; k < 4; ++k) {
        i[k] = table_[tet[k]];
        if (i[k] == deep_.size()) add(tet[k], context);
      }
      for (int k = 1; k < 4; ++k)
        for (int j = 0; j < k; ++j)
          if (deep_[i[j]] && deep_[i[k]]) unite(i[j], i[k]);
    });
  }

  void add(LatticeSite site, const RunContext& context) {
    if (deep_.size() % 4096 == 0) context.check();
    const Vec3 p = position(lattice_.root, site);
    const double clearance = kCoreClearance * sizes_.at(p);
    const bool clear = !near_.contains(p) || triangles_.nearest(p, clearance * clearance).triangle == kNone;
    deep_.push_back(clear);
    parent_.push_back(static_cast<std::uint32_t>(parent_.size()));
  }

  void unite(std::uint32_t a, std::uint32_t b) {
    a = find_root(parent_, a);
    b = find_root(parent_, b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

  void keep_inside() {
    std::vector<char> inside(deep_.size(), 0);
    for (std::uint32_t i = 0; i < deep_.size(); ++i) {
      if (!deep_[i]) continue;
      const std::uint32_t root = find_root(parent_, i);
      if (root == i) inside[i] = triangles_.contains(position_of(i));
      deep_[i] = inside[root];
    }
  }

  const LatticeOctree& lattice_;
  const TriangleTree& triangles_;
  const SizeField& sizes_;
  NearLeaves near_;
  SiteTable table_;
  std::vector<char> deep_;
  std::vector<std::uint32_t> parent_;
};

// Collects the tets with four deep corners, and the faces between them and the rest.
class CoreBuilder {
 public:
  explicit CoreBuilder(DeepSites& sites) : sites_(sites), vertex_(sites.size(), kNone) {}

  void add(const Sites& tet) {
    Tet corners{};
    int deep = 0, shallow_corner = 0;
    for (int k = 0; k < 4; ++k) {
      corners[k] = sites_.index(tet[k]);
      if (sites_.is_deep(corners[k]))
        ++deep;
      else
        shallow_corner = k;
    }
    if (deep == 4) core_.tets.push_back(corners);
    if (deep == 3) {
      const auto& [i, j, k] = kTetFaces[shallow_corner];
      candidates_.push_back({corners[i], corners[j], corners[k]});
    }
  }

  LatticeCore finish() {
    take_skin();
    for (Tet& tet : core_.tets)
      for (VertexIndex& v : tet) v = vertex(v);
    for (Triangle& t : core_.skin)
      for (VertexIndex& v : t) v = vertex(v);
    return std::move(core_);
  }

 private:
  // A face of three deep corners whose tets both have a shallow one is found twice and bounds nothing.
  void take_skin() {
    const auto key = [&](std::uint32_t i) {
      Triangle t = candidates_[i];
      std::sort(t.begin(), t.end());
      return t;
    };
    std::vector<std::pair<Triangle, std::uint32_t>> order;
    order.reserve(candidates_.size());
    for (std::uint32_t i = 0; i < candidates_.size(); ++i) order.emplace_back(key(i), i);
    std::sort(order.begin(), order.end());
    std::vector<std::uint32_t> single;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool twice = i + 1 < order.size() && order[i].first == order[i + 1].first;
      if (twice)
        ++i;
      else
        single.push_back(order[i].second);
    }
    std::sort(single.begin(), single.end());
    for (const std::uint32_t i : single) core_.skin.push_back(candidates_[i]);
  }

  VertexIndex vertex(std::uint32_t site) {
    VertexIndex& v = vertex_[site];
    if (v == kNone) {
      v = static_cast<VertexIndex>(core_.points.size());
      core_.points.push_back(sites_.position_of(site));
    }
    return v;
  }

  DeepSites& sites_;
  std::vector<VertexIndex> vertex_;
  std::vector<Triangle> candidates_;
  LatticeCore core_;
};

}  // namespace

LatticeCore build_lattice_core(const SurfaceMesh& surface, const SizeField& sizes, const RunContext& context) {
  const TriangleTree triangles(surface.points, surface.triangles);
  const LatticeOctree lattice = build_lattice_octree(surface, triangles, sizes, context);
  DeepSites sites(lattice, surface, triangles, sizes, context);
  CoreBuilder builder(sites);
  for_each_lattice_tet(lattice.tree, [&](const Sites& tet) { builder.add(tet); });
  return builder.finish();
}

}  // namespace octafront
