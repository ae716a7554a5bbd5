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
constexpr std::size_t kFacesForTask = 4096;

class Divider {
 public:
  Divider(const FrontState& front, const PartitionRule& rule) : rule_(rule), boxes_(front.faces()) {
    queued_ = front.queue.size();
    parallel_for(boxes_.size(), [&](std::size_t f) {
      for (const VertexIndex v : front.face(f).corners) boxes_[f].add(front.points[v]);
    });
  }

  std::vector<FrontBlock> divide(FrontBlock block) const {
    int axis = 0;
    double plane = 0;
    if (block.queued <= rule_.queued_faces || !choose_plane(block, axis, plane)) return {std::move(block)};
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

  /// Across the longest extent of the owned part of the queue for which the plane cuts few enough.
  bool choose_plane(const FrontBlock& block, int& axis, double& plane) const {
    std::vector<std::uint32_t> own;
    own.reserve(block.queued);
    Box3 extent;
    for (const FrontBlock::Member m : block.members) {
      if (!m.owned || m.face >= queued_) continue;
      own.push_back(m.face);
      extent.add(boxes_[m.face].center());
    }
    std::array<int, 3> axes{0, 1, 2};
    const Vec3 e = extent.extent();
    std::sort(axes.begin(), axes.end(), [&](int a, int b) { return e[a] != e[b] ? e[a] > e[b] : a < b; });
    const auto at = own.begin() + static_cast<std::ptrdiff_t>(rule_.quantile * static_cast<double>(own.size()));
    for (const int a : axes) {
      std::nth_element(own.begin(), at, own.end(),
                       [&](std::uint32_t f, std::uint32_t g) { return middle(f, a) < middle(g, a); });
      axis = a;
      plane = middle(*at, a);
      const auto cut = std::count_if(own.begin(), own.end(), [&](std::uint32_t f) {
        const Vec3 size = boxes_[f].extent();
        return std::abs(middle(f, a) - plane) < kReachPerExtent * std::max({size.x, size.y, size.z});
      });
      if (static_cast<double>(cut) < kMostCut * static_cast<double>(own.size())) return true;
    }
    return false;
  }

  std::array<FrontBlock, 2> split(const FrontBlock& block, int axis, double plane) const {
    std::array<FrontBlock, 2> half;
    for (FrontBlock& h : half) {
      h.territory = block.territory;
      h.members.reserve(block.members.size() * 5 / 8);
    }
    half[0].territory.hi[axis] = plane;
    half[1].territory.lo[axis] = plane;
    for (const FrontBlock::Member m : block.members) {
      const bool upper = middle(m.face, axis) >= plane;
      const bool owned = m.owned;
      if (boxes_[m.face].lo[axis] <= plane) add(half[0], m.face, owned && !upper);
      if (boxes_[m.face].hi[axis] >= plane) add(half[1], m.face, owned && upper);
    }
    return half;
  }

  void add(FrontBlock& block, std::uint32_t face, bool owned) const {
    block.members.push_back({face, owned});
    block.queued += owned && face < queued_;
  }

  PartitionRule rule_;
  std::vector<Box3> boxes_;
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
    if (region.queued > rule.queued_faces) {
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
  for (std::uint32_t f = 0; f < block.members.size(); ++f) block.members[f] = {f, true};
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
