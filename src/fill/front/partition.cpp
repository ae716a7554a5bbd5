#include "fill/front/partition.h"

#include "base/core/index_range.h"
#include "base/core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace octafront {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// What a face may reach lies within about this many extents of its box around it.
constexpr double kReachPerExtent = 2;
/// A plane may cut the reach of this share of a block's queued faces at most: those would wait for the next phase.
constexpr double kMostCut = 0.3;
/// Lists shorter than this are not worth a task of their own.
constexpr std::size_t kFacesForTask = 8192;
/// A quantile is known up to this part of the extent: where exactly a plane lies does not matter.
constexpr int kBins = 512;

class Divider {
 public:
  Divider(const FrontState& front, const PartitionRule& rule) : rule_(rule), boxes_(front.faces()) {
    queued_ = front.queue.size();
    parallel_for(boxes_.size(), [&](std::size_t f) {
      boxes_[f] = Box3();
      for (const VertexIndex v : front.face(f).corners) boxes_[f].add(front.points[v]);
    });
  }

  bool is_small(const FrontBlock& block) const {
    return block.queued == 0 || (block.queued <= rule_.queued_faces && block.members.size() <= rule_.faces);
  }

  std::vector<FrontBlock> divide(FrontBlock block) const {
    int axis = 0;
    double plane = 0;
    if (is_small(block) || !choose_plane(block, axis, plane)) return {std::move(block)};
    const bool large = block.members.size() > kFacesForTask;
    std::array<FrontBlock, 2> half = split(block, axis, plane);
    block = {};
    std::array<std::vector<FrontBlock>, 2> blocks;
    const auto lower = [&] { blocks[0] = divide(std::move(half[0])); };
    const auto upper = [&] { blocks[1] = divide(std::move(half[1])); };
    if (large)
      parallel_invoke(lower, upper);
    else
      lower(), upper();
    std::move(blocks[1].begin(), blocks[1].end(), std::back_inserter(blocks[0]));
    return std::move(blocks[0]);
  }

 private:
  double middle(std::uint32_t face, int axis) const { return 0.5 * (boxes_[face].lo[axis] + boxes_[face].hi[axis]); }
  bool is_queued(FrontBlock::Member m) const { return m.owned && m.face < queued_; }

  /// The numbers of the block's owned faces of the queue, or of all its faces.
  RawVector<std::uint32_t> faces_of(const FrontBlock& block, bool queued) const {
    return parallel_collect<std::uint32_t, RawVector<std::uint32_t>>(
        block.members.size(), kFacesForTask,
        [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& faces) {
          for (std::size_t i = begin; i < end; ++i)
            if (!queued || is_queued(block.members[i])) faces.push_back(block.members[i].face);
        });
  }

  /// Across the longest extent of the owned part of the queue, or of all faces where these are too many, for which the
  /// plane cuts few enough.
  bool choose_plane(const FrontBlock& block, int& axis, double& plane) const {
    const RawVector<std::uint32_t> queue = faces_of(block, true);
    const bool by_queue = queue.size() > rule_.queued_faces;
    const RawVector<std::uint32_t> faces = by_queue ? queue : faces_of(block, false);
    const Box3 extent = parallel_sum(faces.size(), [&](std::size_t begin, std::size_t end) {
                          Centers centers;
                          for (std::size_t i = begin; i < end; ++i) centers.box.add(boxes_[faces[i]].center());
                          return centers;
                        }).box;
    std::array<int, 3> axes{0, 1, 2};
    const Vec3 e = extent.extent();
    std::sort(axes.begin(), axes.end(), [&](int a, int b) { return e[a] != e[b] ? e[a] > e[b] : a < b; });
    for (const int a : axes) {
      if (!(e[a] > 0)) return false;
      axis = a;
      plane = quantile(faces, a, extent);
      const std::size_t cut = parallel_sum(queue.size(), [&](std::size_t begin, std::size_t end) {
        return static_cast<std::size_t>(std::count_if(
            queue.begin() + static_cast<std::ptrdiff_t>(begin), queue.begin() + static_cast<std::ptrdiff_t>(end),
            [&](std::uint32_t f) {
              const Vec3 size = boxes_[f].extent();
              return std::abs(middle(f, a) - plane) < kReachPerExtent * std::max({size.x, size.y, size.z});
            }));
      });
      if (static_cast<double>(cut) < kMostCut * static_cast<double>(queue.size())) return true;
    }
    return false;
  }

  struct Centers {
    Box3 box;
    Centers& operator+=(const Centers& other) {
      box.add(other.box.lo), box.add(other.box.hi);
      return *this;
    }
  };
  struct Histogram {
    std::array<std::uint32_t, kBins> count{};
    Histogram& operator+=(const Histogram& other) {
      for (int b = 0; b < kBins; ++b) count[b] += other.count[b];
      return *this;
    }
  };

  /// A plane with about the rule's share of the faces below it, and some on both sides.
  double quantile(const RawVector<std::uint32_t>& faces, int axis, const Box3& extent) const {
    const double lo = extent.lo[axis], per_bin = (extent.hi[axis] - lo) / kBins;
    const Histogram histogram = parallel_sum(faces.size(), [&](std::size_t begin, std::size_t end) {
      Histogram h;
      for (std::size_t i = begin; i < end; ++i)
        ++h.count[std::clamp(static_cast<int>((middle(faces[i], axis) - lo) / per_bin), 0, kBins - 1)];
      return h;
    });
    const double wanted = rule_.quantile * static_cast<double>(faces.size());
    int bin = 0;
    for (double below = 0; bin < kBins - 2 && below + histogram.count[bin] < wanted; ++bin)
      below += histogram.count[bin];
    return lo + (bin + 1) * per_bin;
  }

  /// The members of a stretch that reach below the plane, and above.
  struct Halves {
    std::array<std::vector<FrontBlock::Member>, 2> members;
    std::array<std::size_t, 2> queued{};
  };

  Halves halves(const FrontBlock& block, std::size_t begin, std::size_t end, int axis, double plane) const {
    Halves halves;
    for (auto& of_half : halves.members) of_half.reserve((end - begin) * 5 / 8);
    const auto add = [&](int half, std::uint32_t face, bool owned) {
      halves.members[half].push_back({face, owned});
      halves.queued[half] += owned && face < queued_;
    };
    for (std::size_t i = begin; i < end; ++i) {
      const FrontBlock::Member m = block.members[i];
      const bool upper = middle(m.face, axis) >= plane, owned = m.owned;
      if (boxes_[m.face].lo[axis] <= plane) add(0, m.face, owned && !upper);
      if (boxes_[m.face].hi[axis] >= plane) add(1, m.face, owned && upper);
    }
    return halves;
  }

  std::array<FrontBlock, 2> split(const FrontBlock& block, int axis, double plane) const {
    const std::size_t n = block.members.size(), stretches = (n + kFacesForTask - 1) / kFacesForTask;
    std::vector<Halves> parts(stretches);
    parallel_for(stretches, [&](std::size_t s) {
      parts[s] = halves(block, s * kFacesForTask, std::min(n, (s + 1) * kFacesForTask), axis, plane);
    });
    std::array<FrontBlock, 2> half;
    for (int h = 0; h < 2; ++h) {
      half[h].territory = block.territory;
      for (const Halves& part : parts) half[h].queued += part.queued[h];
      std::vector<std::vector<FrontBlock::Member>> members;
      for (Halves& part : parts) members.push_back(std::move(part.members[h]));
      half[h].members = joined<RawVector<FrontBlock::Member>>(members);
    }
    half[0].territory.hi[axis] = plane;
    half[1].territory.lo[axis] = plane;
    return half;
  }

  PartitionRule rule_;
  RawVector<Box3> boxes_;
  std::size_t queued_ = 0;
};

constexpr Box3 kEverywhere{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};

/// A block for the faces of each region; none if a face's region is not known.
std::vector<FrontBlock> blocks_of_regions(const FrontState& front) {
  std::vector<FrontBlock> blocks(front.regions);
  for (FrontBlock& block : blocks) block.territory = kEverywhere;
  for (std::uint32_t f = 0; f < front.faces(); ++f) {
    const std::uint32_t region = front.face(f).region;
    if (region >= front.regions) return {};
    blocks[region].members.push_back({f, true});
    blocks[region].queued += f < front.queue.size();
  }
  return blocks;
}

/// Takes the faces of another region in, in the order of their numbers.
void take_in(FrontBlock& block, const FrontBlock& other) {
  const auto middle = static_cast<std::ptrdiff_t>(block.members.size());
  block.members.insert(block.members.end(), other.members.begin(), other.members.end());
  std::inplace_merge(block.members.begin(), block.members.begin() + middle, block.members.end(),
                     [](FrontBlock::Member a, FrontBlock::Member b) { return a.face < b.face; });
  block.queued += other.queued;
}

/// Regions with few faces together, large ones divided.
std::vector<FrontBlock> partition_regions(const FrontState& front, std::vector<FrontBlock> regions,
                                          const PartitionRule& rule) {
  const Divider divider(front, rule);
  std::vector<FrontBlock> blocks, few;
  for (FrontBlock& region : regions) {
    if (region.queued == 0) {
      blocks.push_back(std::move(region));
    } else if (!divider.is_small(region)) {
      std::vector<FrontBlock> parts = divider.divide(std::move(region));
      std::move(parts.begin(), parts.end(), std::back_inserter(blocks));
    } else if (few.empty() || few.back().queued + region.queued > rule.queued_faces) {
      few.push_back(std::move(region));
    } else {
      take_in(few.back(), region);
    }
  }
  for (FrontBlock& block : few) {
    block.is_of_regions = true;
    blocks.push_back(std::move(block));
  }
  return blocks;
}

}  // namespace

FrontBlock FrontBlock::whole(const FrontState& front) {
  require_in_range(front.faces(), kMostFaces, "faces of the front");
  FrontBlock block;
  block.territory = kEverywhere;
  block.members.resize(front.faces());
  parallel_for(block.members.size(), [&](std::size_t f) { block.members[f] = {static_cast<std::uint32_t>(f), true}; });
  block.queued = front.queue.size();
  return block;
}

std::vector<FrontBlock> partition_front(const FrontState& front, const PartitionRule& rule) {
  require_in_range(front.faces(), FrontBlock::kMostFaces, "faces of the front");
  if (front.regions > 1)
    if (std::vector<FrontBlock> regions = blocks_of_regions(front); !regions.empty())
      return partition_regions(front, std::move(regions), rule);
  return Divider(front, rule).divide(FrontBlock::whole(front));
}

}  // namespace octafront
