#include "lattice/core.h"

#include "geometry/triangle_tree.h"
#include "lattice/graded_bcc.h"
#include "lattice/lattice_octree.h"
#include "lattice/near_leaves.h"
#include "lattice/site_table.h"
#include "mesh/index_range.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_sort.h>

namespace octafront {

namespace {

/// Distance of the core from the surface over the size there: room for one good layer of the front, and no more.
constexpr double kCoreClearance = 0.8;

using Sites = std::array<LatticeSite, 4>;

/// A site by number. Leaf i has 2 i for its centre and 2 i + 1 for its lower corner; the few other sites (they hang on
/// the side of a larger leaf, or lie on an upper side of the root) are numbered as `kHanging` and up by each chunk.
using SiteNumber = std::uint32_t;
constexpr SiteNumber kHanging = 0x80000000u;
constexpr std::size_t kLeavesPerChunk = 4096;

bool is_hanging(SiteNumber s) {
  return s >= kHanging;
}
bool is_center(SiteNumber s) {
  return !is_hanging(s) && s % 2 == 0;
}

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// What of a lattice is clear of the surface, and inside it.
class ClearSites {
 public:
  ClearSites(const LatticeOctree& lattice, const SurfaceMesh& surface, const TriangleTree& triangles,
             const SizeField& sizes, const RunContext& context)
      : lattice_(lattice),
        triangles_(triangles),
        sizes_(sizes),
        near_(near_leaves(lattice, surface, sizes, kCoreClearance)),
        clear_(2 * lattice.tree.size()) {
    const std::size_t leaves = lattice.tree.size();
    tbb::parallel_for(std::size_t{0}, leaves, [&](std::size_t i) {
      if (i % kLeavesPerChunk == 0) context.check();
      for (const SiteNumber s : {SiteNumber(2 * i), SiteNumber(2 * i + 1)})
        clear_[s] = !near_[i] || keeps_clearance(position_of(s));
    });
    find_inside();
  }

  const LatticeOctree& lattice() const { return lattice_; }
  /// REQUIRES a site that is not hanging.
  bool is_clear(SiteNumber s) const { return clear_[s] != 0; }
  bool keeps_clearance(Vec3 p) const {
    const double clearance = kCoreClearance * sizes_.at(p);
    return triangles_.nearest(p, clearance * clearance).triangle == kNone;
  }
  bool is_near(std::size_t leaf) const { return near_[leaf] != 0; }
  /// REQUIRES that the centre of the leaf is clear.
  bool center_is_inside(std::size_t leaf) const { return inside_[leaf] != 0; }
  bool contains(Vec3 p) const { return triangles_.contains(p); }
  /// No site of the leaf can be part of the core.
  bool is_far_outside(std::size_t leaf) const { return !near_[leaf] && !inside_[leaf]; }
  Vec3 position_of(SiteNumber s) const {
    const OctreeKey leaf = lattice_.tree.leaf(s / 2);
    return s % 2 == 0 ? lattice_.root.center_of(leaf) : lattice_.root.corner_of(leaf);
  }

 private:
  /// An edge between two clear sites does not cross the surface, so what such edges connect lies on one side of it: one
  /// inside test a component is enough. The centres of leaves of one size that share a face are connected.
  void find_inside() {
    const Octree& tree = lattice_.tree;
    std::vector<std::array<std::uint32_t, 3>> upper(tree.size());
    tbb::parallel_for(std::size_t{0}, tree.size(), [&](std::size_t i) {
      for (int axis = 0; axis < 3; ++axis) {
        upper[i][axis] = kNone;
        if (!clear_[2 * i]) continue;
        const OctreeKey beyond = tree.leaf(i).neighbour(axis == 0, axis == 1, axis == 2);
        if (!beyond.is_valid()) continue;
        const std::size_t j = tree.find(beyond);
        if (tree.leaf(j) == beyond && clear_[2 * j]) upper[i][axis] = static_cast<std::uint32_t>(j);
      }
    });
    std::vector<std::uint32_t> parent(tree.size());
    std::iota(parent.begin(), parent.end(), 0u);
    for (std::uint32_t i = 0; i < tree.size(); ++i)
      for (const std::uint32_t j : upper[i])
        if (j != kNone) {
          const std::uint32_t a = find_root(parent, i), b = find_root(parent, j);
          parent[std::max(a, b)] = std::min(a, b);
        }
    inside_.resize(tree.size());
    for (std::uint32_t i = 0; i < tree.size(); ++i) {
      const std::uint32_t root = find_root(parent, i);
      inside_[i] = root == i ? clear_[2 * i] && contains(position_of(2 * i)) : inside_[root];
    }
  }

  const LatticeOctree& lattice_;
  const TriangleTree& triangles_;
  const SizeField& sizes_;
  std::vector<std::uint8_t> near_, clear_;
  std::vector<std::uint8_t> inside_;  ///< per leaf, of its centre
};

/// The tetrahedra of a stretch of leaves that belong to the core, and the faces between them and the rest.
class CoreChunk {
 public:
  CoreChunk() = default;

  void collect(const ClearSites& sites, std::size_t first, std::size_t last) {
    Collector(*this, sites).run(first, last);
  }

  std::vector<Tet> tets;             ///< of site numbers
  std::vector<Triangle> candidates;  ///< for the skin: faces of a tetrahedron that lacks its fourth corner
  std::vector<LatticeSite> hanging;  ///< per kHanging + i

 private:
  class Collector {
   public:
    Collector(CoreChunk& chunk, const ClearSites& sites) : chunk_(chunk), sites_(sites), table_(64) {
      recent_.fill({~LatticeSite{0}, 0});
    }

    void run(std::size_t first, std::size_t last) {
      const Octree& tree = sites_.lattice().tree;
      for (std::size_t i = first; i < last; ++i)
        if (!sites_.is_far_outside(i)) for_each_lattice_tet_of(tree, i, [&](const Sites& tet) { add(tet); });
      chunk_.hanging = table_.sites();
    }

   private:
    SiteNumber number(LatticeSite site) {
      auto& [known, n] = recent_[site * 0x9e3779b97f4a7c15ull >> 55];
      if (known != site) known = site, n = look_up(site);
      return n;
    }

    SiteNumber look_up(LatticeSite site) {
      const auto [x, y, z] = unpack_site(site);
      constexpr std::uint32_t kSide = OctreeKey::kSide;
      if (x < kSide && y < kSide && z < kSide) {
        const Octree& tree = sites_.lattice().tree;
        const std::size_t i = tree.find(OctreeKey::containing(x, y, z));
        const std::array<std::uint32_t, 3> at{x, y, z};
        auto corner = tree.leaf(i).corner();
        if (corner == at) return static_cast<SiteNumber>(2 * i + 1);
        for (std::uint32_t& c : corner) c += tree.leaf(i).side() / 2;
        if (corner == at) return static_cast<SiteNumber>(2 * i);
      }
      const std::uint32_t i = table_[site];
      if (i == hanging_is_clear_.size())
        hanging_is_clear_.push_back(sites_.keeps_clearance(position(sites_.lattice().root, site)));
      return kHanging + i;
    }

    bool is_clear(SiteNumber s) const { return is_hanging(s) ? hanging_is_clear_[s - kHanging] : sites_.is_clear(s); }

    /// Of the clear sites of a tetrahedron, which lie on one side of the surface.
    bool is_inside(const std::array<SiteNumber, 4>& corners, const Sites& tet, int shallow) const {
      for (const SiteNumber s : corners)
        if (is_center(s) && is_clear(s)) return sites_.center_is_inside(s / 2);
      return sites_.contains(position(sites_.lattice().root, tet[shallow == 0 ? 1 : 0]));
    }

    void add(const Sites& tet) {
      std::array<SiteNumber, 4> corners{};
      int clear = 0, shallow = -1;
      for (int k = 0; k < 4; ++k) {
        corners[k] = number(tet[k]);
        if (is_clear(corners[k]))
          ++clear;
        else
          shallow = k;
      }
      if (clear < 3 || !is_inside(corners, tet, shallow)) return;
      if (clear == 4) {
        chunk_.tets.push_back(corners);
      } else {
        const auto& [i, j, k] = kTetFaces[shallow];
        chunk_.candidates.push_back({corners[i], corners[j], corners[k]});
      }
    }

    CoreChunk& chunk_;
    const ClearSites& sites_;
    SiteTable table_;  ///< of the hanging sites
    std::vector<char> hanging_is_clear_;
    std::array<std::pair<LatticeSite, SiteNumber>, 512> recent_;
  };
};

/// Joins the chunks in their order: vertices are numbered by leaf, those that hang come last.
class CoreBuilder {
 public:
  CoreBuilder(const ClearSites& sites, std::vector<CoreChunk>& chunks)
      : sites_(sites), chunks_(chunks), vertex_(2 * sites.lattice().tree.size(), kNone) {}

  LatticeCore build() {
    number_vertices();
    take_tets();
    take_skin();
    return std::move(core_);
  }

 private:
  /// Sites of the core's tetrahedra; the skin has no others.
  void number_vertices() {
    std::vector<std::vector<char>> hanging_is_used(chunks_.size());
    tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) {
      hanging_is_used[c].resize(chunks_[c].hanging.size());
      for (const Tet& t : chunks_[c].tets)
        for (const SiteNumber s : t)
          if (is_hanging(s))
            hanging_is_used[c][s - kHanging] = 1;
          else
            std::atomic_ref(vertex_[s]).store(0, std::memory_order_relaxed);
    });
    VertexIndex next = 0;
    for (VertexIndex& v : vertex_)
      if (v != kNone) v = next++;
    first_hanging_ = next;
    for (std::size_t c = 0; c < chunks_.size(); ++c)
      for (std::size_t i = 0; i < chunks_[c].hanging.size(); ++i)
        if (hanging_is_used[c][i]) hanging_.push_back(chunks_[c].hanging[i]);
    std::sort(hanging_.begin(), hanging_.end());
    hanging_.erase(std::unique(hanging_.begin(), hanging_.end()), hanging_.end());
    core_.points.resize(first_hanging_ + hanging_.size());
    tbb::parallel_for(std::size_t{0}, vertex_.size(), [&](std::size_t s) {
      if (vertex_[s] != kNone) core_.points[vertex_[s]] = sites_.position_of(static_cast<SiteNumber>(s));
    });
    for (std::size_t i = 0; i < hanging_.size(); ++i)
      core_.points[first_hanging_ + i] = position(sites_.lattice().root, hanging_[i]);
  }

  /// kNone if no tetrahedron of the core has this corner.
  VertexIndex vertex(const CoreChunk& chunk, SiteNumber s) const {
    if (!is_hanging(s)) return vertex_[s];
    const LatticeSite site = chunk.hanging[s - kHanging];
    const auto at = std::lower_bound(hanging_.begin(), hanging_.end(), site);
    if (at == hanging_.end() || *at != site) return kNone;
    return first_hanging_ + static_cast<VertexIndex>(at - hanging_.begin());
  }

  void take_tets() {
    std::vector<std::size_t> first(chunks_.size() + 1, 0);
    for (std::size_t c = 0; c < chunks_.size(); ++c) first[c + 1] = first[c] + chunks_[c].tets.size();
    require_in_range(first.back(), kMostTets, "tetrahedra");
    core_.tets.resize(first.back());
    tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t c) {
      Tet* out = core_.tets.data() + first[c];
      for (const Tet& t : chunks_[c].tets)
        *out++ = {vertex(chunks_[c], t[0]), vertex(chunks_[c], t[1]), vertex(chunks_[c], t[2]),
                  vertex(chunks_[c], t[3])};
      chunks_[c].tets = {};
    });
  }

  /// A face of three clear corners whose tets both lack the fourth is found twice and bounds nothing.
  void take_skin() {
    std::vector<Triangle> faces;
    for (const CoreChunk& chunk : chunks_)
      for (const Triangle& t : chunk.candidates) {
        const Triangle face{vertex(chunk, t[0]), vertex(chunk, t[1]), vertex(chunk, t[2])};
        if (face[0] != kNone && face[1] != kNone && face[2] != kNone) faces.push_back(face);
      }
    std::vector<std::pair<Triangle, std::uint32_t>> order(faces.size());
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
      order[i] = {faces[i], i};
      std::sort(order[i].first.begin(), order[i].first.end());
    }
    tbb::parallel_sort(order.begin(), order.end());
    std::vector<char> single(faces.size(), 1);
    for (std::size_t i = 1; i < order.size(); ++i)
      if (order[i].first == order[i - 1].first) single[order[i].second] = single[order[i - 1].second] = 0;
    for (std::size_t i = 0; i < faces.size(); ++i)
      if (single[i]) core_.skin.push_back(faces[i]);
  }

  const ClearSites& sites_;
  std::vector<CoreChunk>& chunks_;
  std::vector<VertexIndex> vertex_;  ///< per site that does not hang
  std::vector<LatticeSite> hanging_;
  VertexIndex first_hanging_ = 0;
  LatticeCore core_;
};

}  // namespace

LatticeCore build_lattice_core(const SurfaceMesh& surface, const SizeField& sizes, const RunContext& context) {
  const TriangleTree triangles(surface.points, surface.triangles);
  const LatticeOctree lattice = build_lattice_octree(surface, triangles, sizes, context);
  require_in_range(lattice.tree.size(), kHanging / 2, "leaves of the lattice");
  const ClearSites sites(lattice, surface, triangles, sizes, context);
  const std::size_t leaves = lattice.tree.size();
  std::vector<CoreChunk> chunks((leaves + kLeavesPerChunk - 1) / kLeavesPerChunk);
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    context.check();
    chunks[c].collect(sites, c * kLeavesPerChunk, std::min((c + 1) * kLeavesPerChunk, leaves));
  });
  return CoreBuilder(sites, chunks).build();
}

}  // namespace octafront
