#pragma once

#include "base/core/validate.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace octafront {

/// The alternating digital tree: points of D-dimensional space in a binary tree, each level of which halves its box
/// along the next axis. Points come and go; range queries cost O(log n) and what they find. Boxes of 3-space are points
/// of 6-space. (J. Bonet and J. Peraire, "An Alternating Digital Tree (ADT) Algorithm for 3D Geometric Searching and
/// Intersection Problems", 1991.)
template <int D>
class AlternatingTree {
 public:
  using Key = std::array<double, D>;

  /// Points outside [lo, hi] are found as well, only slower.
  AlternatingTree(const Key& lo, const Key& hi) : domain_{lo, hi} {}

  /// REQUIRES: `item` is not in the tree. Items are small integers: memory is as large as the largest.
  void insert(std::uint32_t item, const Key& key) {
    if (item >= node_of_item_.size()) node_of_item_.resize(item + 1, kNoNode);
    if (nodes_.empty()) nodes_.emplace_back();
    Key lo = domain_.lo, hi = domain_.hi;
    std::uint32_t at = 0;
    for (int axis = 0;; axis = (axis + 1) % D) {
      ++nodes_[at].live;
      // A node that lost its item takes any item on whose way it lies.
      if (nodes_[at].item == kNoItem) break;
      const double middle = 0.5 * (lo[axis] + hi[axis]);
      const bool upper = key[axis] >= middle;
      (upper ? lo : hi)[axis] = middle;
      if (nodes_[at].child[upper] == kNoNode) {
        const auto made = static_cast<std::uint32_t>(nodes_.size());
        nodes_.emplace_back().parent = at;
        nodes_[at].child[upper] = made;
      }
      at = nodes_[at].child[upper];
    }
    nodes_[at].item = item;
    nodes_[at].key = key;
    node_of_item_[item] = at;
    validate(*this, item);
  }

  /// REQUIRES: `item` is in the tree.
  void remove(std::uint32_t item) {
    validate(*this, item);
    std::uint32_t at = node_of_item_[item];
    nodes_[at].item = kNoItem;
    node_of_item_[item] = kNoNode;
    for (; at != kNoNode; at = nodes_[at].parent) --nodes_[at].live;
  }

  /// A box of keys, borders included.
  struct Range {
    Key lo, hi;
    bool contains(const Key& key) const {
      for (int k = 0; k < D; ++k)
        if (key[k] < lo[k] || key[k] > hi[k]) return false;
      return true;
    }
  };

  /// Calls visit(item) for each point in the range, in an order that depends on the history of the tree alone.
  template <class Visit>
  void find(const Range& range, const Visit& visit) const {
    Range box = domain_;
    if (!nodes_.empty()) descend(0, 0, box, range, visit);
  }

  bool contains(std::uint32_t item) const { return item < node_of_item_.size() && node_of_item_[item] != kNoNode; }
  std::uint32_t size() const { return nodes_.empty() ? 0 : nodes_[0].live; }

  /// Where a search would pass by an item, or look for one where none is left (base/core/validate.h).
  std::optional<std::string> first_inconsistency() const;
  /// Why a search would pass by this item, which should be there.
  std::optional<std::string> first_inconsistency(std::uint32_t item) const;

 private:
  static constexpr std::uint32_t kNoNode = 0xffffffffu, kNoItem = 0xffffffffu;
  struct Node {
    Key key{};
    std::uint32_t item = kNoItem, live = 0, parent = kNoNode;  ///< live: items in the subtree
    std::array<std::uint32_t, 2> child{kNoNode, kNoNode};
  };

  /// Whether a point goes through the node on its way down.
  bool leads_to(const Key& key, std::uint32_t node) const;

  /// `box` is that of node `at`, which is halved along `axis`.
  template <class Visit>
  void descend(std::uint32_t at, int axis, Range& box, const Range& range, const Visit& visit) const {
    const Node& node = nodes_[at];
    if (node.live == 0) return;
    if (node.item != kNoItem && range.contains(node.key)) visit(node.item);
    const double low = box.lo[axis], high = box.hi[axis], middle = 0.5 * (low + high);
    const int next = (axis + 1) % D;
    // The outermost boxes are open: points outside the domain lie in them.
    if (node.child[0] != kNoNode && range.lo[axis] < middle && (range.hi[axis] >= low || low == domain_.lo[axis])) {
      box.hi[axis] = middle;
      descend(node.child[0], next, box, range, visit);
      box.hi[axis] = high;
    }
    if (node.child[1] != kNoNode && range.hi[axis] >= middle && (range.lo[axis] <= high || high == domain_.hi[axis])) {
      box.lo[axis] = middle;
      descend(node.child[1], next, box, range, visit);
      box.lo[axis] = low;
    }
  }

  Range domain_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> node_of_item_;
};

}  // namespace octafront
