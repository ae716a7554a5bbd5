#pragma once

// A tree of boxes over anything that has one.

#include <octafront/vec.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace octafront {

/// `Bounds`: a Box3, or a struct with a `box` and what else is known of all that lies in it, which can add() others.
/// Halved by the middles of boxes, those that are equal by number. Const and safe on any number of threads.
template <class Bounds>
class BoxTree {
 public:
  struct Item {
    Bounds bounds;
    std::uint32_t number;
  };

  explicit BoxTree(std::vector<Item> items) : items_(std::move(items)), nodes_(1) {
    divide(0, 0, static_cast<std::uint32_t>(items_.size()));
  }

  /// Of all items.
  const Bounds& bounds() const { return nodes_.front().bounds; }

  /// visit(item) for the items whose bounds, and those of all boxes around them, one may enter(bounds); in an order
  /// that depends on the tree only, and on which side goes_first(left, right).
  template <class Enter, class Visit, class LeftFirst>
  void for_each(const Enter& enter, const Visit& visit, const LeftFirst& goes_first) const {
    std::array<std::uint32_t, 64> stack{};
    int depth = items_.empty() ? 0 : 1;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!enter(node.bounds)) continue;
      if (node.count == 0) {
        const bool left_first = goes_first(nodes_[node.first].bounds, nodes_[node.first + 1].bounds);
        stack[depth++] = node.first + left_first;
        stack[depth++] = node.first + !left_first;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        if (enter(items_[i].bounds)) visit(items_[i]);
    }
  }
  template <class Enter, class Visit>
  void for_each(const Enter& enter, const Visit& visit) const {
    for_each(enter, visit, [](const Bounds&, const Bounds&) { return true; });
  }

 private:
  static constexpr std::uint32_t kLeafSize = 4;
  struct Node {
    Bounds bounds{};
    std::uint32_t first = 0, count = 0;  ///< leaf: its items; count 0: its left child, then the right one
  };

  static const Box3& box_of(const Box3& box) { return box; }
  template <class Other>
  static const Box3& box_of(const Other& bounds) {
    return bounds.box;
  }

  void divide(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
    Node made{{}, begin, end - begin};
    for (std::uint32_t i = begin; i < end; ++i) made.bounds.add(items_[i].bounds);
    if (end - begin > kLeafSize) {
      const Vec3 extent = box_of(made.bounds).extent();
      const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
      const std::uint32_t middle = begin + (end - begin) / 2;
      const auto key = [axis](const Item& item) { return std::pair(box_of(item.bounds).center()[axis], item.number); };
      std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                       [&](const Item& a, const Item& b) { return key(a) < key(b); });
      made.first = static_cast<std::uint32_t>(nodes_.size()), made.count = 0;
      nodes_.resize(nodes_.size() + 2);
      divide(made.first, begin, middle);
      divide(made.first + 1, middle, end);
    }
    nodes_[node] = made;
  }

  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

}  // namespace octafront
