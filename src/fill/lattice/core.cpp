#include "fill/lattice/core.h"

#include <octafront/surface_mesh.h>

#include "base/core/buckets.h"
#include "base/core/index_range.h"
#include "base/core/parallel_arrays.h"
#include "base/core/shared_value.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/complex.h"
#include "base/mesh/face_table.h"
#include "base/shared/marks.h"
#include "base/shared/packing.h"
#include "base/shared/shares.h"
#include "fill/lattice/clear_sites.h"
#include "fill/lattice/graded_bcc.h"
#include "fill/lattice/lattice_octree.h"
#include "fill/lattice/site_table.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace octafront {

namespace {

using Sites = std::array<LatticeSite, 4>;

constexpr std::size_t kLeavesPerChunk = 4096;
/// Of a chunk without leaves of other sizes, and more: arrays of a megabyte and more go back to the system once they
/// are freed, and room that is not used costs nothing.
constexpr std::size_t kRoomOfChunk = 17 * kLeavesPerChunk;
/// Chunks that are joined at a time, .8 million tetrahedra: so many are there twice.
constexpr std::size_t kChunksAtOnce = 16;
/// What the front makes comes behind the core, in the same array where there is room: as address space it costs
/// nothing. At a million elements a quarter is the front's, and ever less where there are more.
constexpr double kRoomForFront = 1.5;
constexpr std::size_t kFacesAtOnce = 8192;

/// The tetrahedra of a stretch of leaves that belong to the core, and the faces between them and the rest.
class CoreChunk {
 public:
  CoreChunk() = default;

  void collect(const ClearSites& sites, std::size_t first, std::size_t last) {
    Collector(*this, sites).run(first, last);
  }

  std::vector<Tet> tets;             ///< of site numbers
  std::vector<Triangle> candidates;  ///< for the skin: clear faces of tetrahedra that do not belong to the core
  std::vector<LatticeSite> hanging;  ///< per kHanging + i

 private:
  class Collector {
   public:
    Collector(CoreChunk& chunk, const ClearSites& sites) : chunk_(chunk), sites_(sites), table_(64) {
      recent_.fill({~LatticeSite{0}, 0});
    }

    void run(std::size_t first, std::size_t last) {
      const Octree& tree = sites_.lattice().tree;
      chunk_.tets.reserve(kRoomOfChunk);
      for (std::size_t i = first; i < last; ++i)
        if (!sites_.is_far_outside(i)) for_each_lattice_tet_of(tree, i, [&](const Sites& tet) { add(tet); });
      chunk_.hanging = table_.sites();
    }

   private:
    SiteNumber number(LatticeSite site) {
      auto& [known, n] = recent_[FlatKeys<LatticeSite>::hash(site) >> (64 - kRecentBits)];
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
      if (i == hanging_distance_.size()) hanging_distance_.push_back(sites_.distance_of(site));
      return kHanging + i;
    }

    float distance(SiteNumber s) const { return is_hanging(s) ? hanging_distance_[s - kHanging] : sites_.distance(s); }

    bool is_outside(SiteNumber s) const {
      return is_center(s) && sites_.distance(s) > 0 && !sites_.center_is_inside(s / 2);
    }
    template <class Corners>
    bool has_corner_outside(const Corners& corners) const {
      return std::any_of(corners.begin(), corners.end(), [&](SiteNumber s) { return is_outside(s); });
    }

    /// A tetrahedron lies in the leaves whose centres are corners of it.
    bool is_far(const std::array<SiteNumber, 4>& corners) const {
      return std::all_of(corners.begin(), corners.end(),
                         [&](SiteNumber s) { return !is_center(s) || sites_.is_far(s / 2); });
    }

    /// Of a tetrahedron with four clear corners: if it does not touch the surface, one corner speaks for all of it.
    /// Between leaves of different sizes the front makes better elements than the lattice has.
    bool is_core(const std::array<SiteNumber, 4>& corners, const Sites& tet, float least_distance) const {
      if (!is_regular(tet) || has_corner_outside(corners)) return false;
      if (is_far(corners)) return true;
      std::array<Vec3, 4> at;
      for (int k = 0; k < 4; ++k) at[k] = position(sites_.lattice().root, tet[k]);
      return sites_.is_clear(at, least_distance);
    }

    void add(const Sites& tet) {
      std::array<SiteNumber, 4> corners{};
      int clear = 0, shallow = -1;
      float least = std::numeric_limits<float>::max();
      for (int k = 0; k < 4; ++k) {
        corners[k] = number(tet[k]);
        const float d = distance(corners[k]);
        if (d == 0) {
          shallow = k;
        } else {
          ++clear;
          least = std::min(least, d);
        }
      }
      if (clear < 3) return;
      if (clear == 4 && is_core(corners, tet, least)) return chunk_.tets.push_back(corners);
      for (int face = 0; face < 4; ++face) {
        const auto& [i, j, k] = kTetFaces[face];
        const Triangle sites{corners[i], corners[j], corners[k]};
        if ((clear == 4 || face == shallow) && !has_corner_outside(sites)) chunk_.candidates.push_back(sites);
      }
    }

    CoreChunk& chunk_;
    const ClearSites& sites_;
    SiteTable table_;  ///< of the hanging sites
    std::vector<float> hanging_distance_;
    static constexpr int kRecentBits = 11;
    std::array<std::pair<LatticeSite, SiteNumber>, 1 << kRecentBits> recent_;
  };
};

/// Joins the chunks in their order: vertices are numbered by leaf, those that hang come last. Of the chunks of other
/// ranks only their vertices and faces are asked for.
class CoreBuilder {
 public:
  CoreBuilder(const ClearSites& sites, std::span<CoreChunk> chunks, const Comm& comm)
      : sites_(sites), chunks_(chunks), comm_(comm) {}

  LatticeCore build() {
    number_vertices();
    take_tets();
    take_skin();
    return std::move(core_);
  }

 private:
  /// Sites of the core's tetrahedra; the skin has no others.
  void number_vertices() {
    std::vector<std::uint8_t> is_used(2 * sites_.lattice().tree.size(), 0);
    std::vector<std::vector<char>> hanging_is_used(chunks_.size());
    parallel_for(chunks_.size(), [&](std::size_t c) {
      hanging_is_used[c].resize(chunks_[c].hanging.size());
      for (const Tet& t : chunks_[c].tets)
        for (const SiteNumber s : t)
          if (is_hanging(s))
            hanging_is_used[c][s - kHanging] = 1;
          else
            SharedValue(is_used[s]).store(1);
    });
    join_marks(comm_, is_used, "sites of the lattice");
    vertex_ = parallel_filled(is_used.size(), kNone);
    first_hanging_ = static_cast<VertexIndex>(parallel_number(
        is_used.size(), [&](std::size_t s) { return is_used[s] != 0; },
        [&](std::size_t s, std::size_t number) { vertex_[s] = static_cast<VertexIndex>(number); }));
    for (std::size_t c = 0; c < chunks_.size(); ++c)
      for (std::size_t i = 0; i < chunks_[c].hanging.size(); ++i)
        if (hanging_is_used[c][i]) hanging_.push_back(chunks_[c].hanging[i]);
    hanging_ = gathered_lists(comm_, std::move(hanging_), "sites of the lattice");
    std::sort(hanging_.begin(), hanging_.end());
    hanging_.erase(std::unique(hanging_.begin(), hanging_.end()), hanging_.end());
    parallel_resize(core_.points, first_hanging_ + hanging_.size());
    parallel_for(vertex_.size(), [&](std::size_t s) {
      if (vertex_[s] != kNone) core_.points[vertex_[s]] = sites_.position_of(static_cast<SiteNumber>(s));
    });
    parallel_for(hanging_.size(), [&](std::size_t i) {
      core_.points[first_hanging_ + i] = position(sites_.lattice().root, hanging_[i]);
    });
  }

  /// kNone if no tetrahedron of the core has this corner.
  VertexIndex vertex(const CoreChunk& chunk, SiteNumber s) const {
    if (!is_hanging(s)) return vertex_[s];
    const LatticeSite site = chunk.hanging[s - kHanging];
    const auto at = std::lower_bound(hanging_.begin(), hanging_.end(), site);
    if (at == hanging_.end() || *at != site) return kNone;
    return first_hanging_ + static_cast<VertexIndex>(at - hanging_.begin());
  }

  /// Some chunks at a time, which are freed then: not all are there twice.
  void take_tets() {
    std::size_t all = 0;
    for (const CoreChunk& chunk : chunks_) all += chunk.tets.size();
    require_in_range(all, kMostTets, "tetrahedra");
    core_.tets.reserve(static_cast<std::size_t>(kRoomForFront * static_cast<double>(all)));
    for (std::size_t first = 0; first < chunks_.size(); first += kChunksAtOnce)
      take_tets_of(first, std::min(first + kChunksAtOnce, chunks_.size()));
  }

  void take_tets_of(std::size_t first, std::size_t last) {
    std::vector<std::size_t> to;
    std::size_t end = core_.tets.size();
    for (std::size_t c = first; c < last; ++c) to.push_back(std::exchange(end, end + chunks_[c].tets.size()));
    parallel_resize(core_.tets, end);
    parallel_for(
        last - first,
        [&](std::size_t i) {
          CoreChunk& chunk = chunks_[first + i];
          Tet* out = core_.tets.data() + to[i];
          for (const Tet& t : chunk.tets)
            *out++ = {vertex(chunk, t[0]), vertex(chunk, t[1]), vertex(chunk, t[2]), vertex(chunk, t[3])};
          chunk.tets = std::vector<Tet>();
        },
        Split::kSingly);
  }

  /// A clear face between two tetrahedra that do not belong to the core is found twice and bounds nothing.
  void take_skin() {
    const RawVector<Triangle> faces = gathered_lists(comm_, candidates(), "skin of the lattice");
    std::vector<std::uint8_t> single(faces.size(), 0);
    const RangeBuckets ranges(core_.points.size());
    const Buckets<> of_range(faces.size(), ranges.count(), [&](std::size_t i, const auto& add) {
      add(ranges.of(face_key(faces[i])[0]), static_cast<std::uint32_t>(i));
    });
    parallel_for(ranges.count(), [&](std::size_t r) {
      FaceTable(static_cast<VertexIndex>(ranges.begin(r)), ranges.end(r) - ranges.begin(r), [&](const auto& add) {
        for (const std::uint32_t i : of_range[r]) add(faces[i], i);
      }).for_each_group([&](const Triangle&, std::span<const FaceTable::Entry> on_face) {
        if (on_face.size() == 1) single[on_face[0].face] = 1;
      });
    });
    core_.skin = parallel_collect<Triangle>(faces.size(), kFacesAtOnce,
                                            [&](std::size_t begin, std::size_t end, std::vector<Triangle>& skin) {
                                              for (std::size_t i = begin; i < end; ++i)
                                                if (single[i]) skin.push_back(faces[i]);
                                            });
  }

  /// Those of all chunks of which the core has the corners.
  RawVector<Triangle> candidates() const {
    return parallel_collect<Triangle, RawVector<Triangle>>(
        chunks_.size(), 1, [&](std::size_t begin, std::size_t end, std::vector<Triangle>& faces) {
          for (std::size_t c = begin; c < end; ++c)
            for (const Triangle& t : chunks_[c].candidates) {
              const Triangle face{vertex(chunks_[c], t[0]), vertex(chunks_[c], t[1]), vertex(chunks_[c], t[2])};
              if (face[0] != kNone && face[1] != kNone && face[2] != kNone) faces.push_back(face);
            }
        });
  }

  const ClearSites& sites_;
  const std::span<CoreChunk> chunks_;
  const Comm& comm_;
  RawVector<VertexIndex> vertex_;  ///< per site that does not hang
  std::vector<LatticeSite> hanging_;
  VertexIndex first_hanging_ = 0;
  LatticeCore core_;
};

}  // namespace

LatticeCore build_lattice_core(const SurfaceMesh& surface, const SizeField& sizes, const RunContext& context) {
  const TriangleTree triangles(surface.points, surface.triangles);
  // A lattice that touches no triangle lies in one region; whether in any, what bounds them all tells.
  std::optional<TriangleTree> hull;
  if (!surface.sides.empty()) hull.emplace(hull_of(surface));
  const LatticeOctree lattice = build_lattice_octree(surface, hull ? *hull : triangles, sizes, context);
  require_in_range(lattice.tree.size(), kHanging / 2, "leaves of the lattice");
  const ClearSites sites(lattice, triangles, hull ? *hull : triangles, context);
  const std::size_t leaves = lattice.tree.size();
  std::vector<CoreChunk> chunks((leaves + kLeavesPerChunk - 1) / kLeavesPerChunk);
  const Comm comm(context.ranks);
  const Shares shares(std::vector<std::uint64_t>(chunks.size(), 1), comm.size());
  do_share(comm, shares, "lattice", [&](std::size_t c) {
    context.check();
    chunks[c].collect(sites, c * kLeavesPerChunk, std::min((c + 1) * kLeavesPerChunk, leaves));
  });
  const std::size_t begin = shares.begin(comm.rank());
  return CoreBuilder(sites, std::span(chunks).subspan(begin, shares.end(comm.rank()) - begin), comm).build();
}

}  // namespace octafront
