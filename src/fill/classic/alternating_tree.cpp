#include "fill/classic/alternating_tree.h"

namespace octafront {

template <int D>
bool AlternatingTree<D>::leads_to(const Key& key, std::uint32_t node) const {
  Range box = domain_;
  std::uint32_t at = 0;
  for (int axis = 0; at < node; axis = (axis + 1) % D) {  // children come behind their parents
    const double middle = 0.5 * (box.lo[axis] + box.hi[axis]);
    const bool upper = key[axis] >= middle;
    (upper ? box.lo : box.hi)[axis] = middle;
    at = nodes_[at].child[upper];
  }
  return at == node;
}

template <int D>
std::optional<std::string> AlternatingTree<D>::first_inconsistency(std::uint32_t item) const {
  const std::string name = "item " + std::to_string(item);
  if (!contains(item)) return name + " is not in the tree";
  const std::uint32_t node = node_of_item_[item];
  if (node >= nodes_.size() || nodes_[node].item != item) return name + " is not where the tree looks for it";
  if (!leads_to(nodes_[node].key, node)) return name + " lies in a node to which its point does not lead";
  for (std::uint32_t at = node; at != kNoNode; at = nodes_[at].parent)
    if (nodes_[at].live == 0) return name + " lies below a node that says it is empty";
  return std::nullopt;
}

template <int D>
std::optional<std::string> AlternatingTree<D>::first_inconsistency() const {
  for (std::uint32_t at = 0; at < nodes_.size(); ++at) {
    const Node& node = nodes_[at];
    std::uint32_t live = node.item != kNoItem;
    for (const std::uint32_t child : node.child) {
      if (child == kNoNode) continue;
      if (child <= at || child >= nodes_.size() || nodes_[child].parent != at)
        return "node " + std::to_string(at) + " has a child that is not its own";
      live += nodes_[child].live;
    }
    if (live != node.live) return "node " + std::to_string(at) + " has not as many items below it as it says";
    if (node.item != kNoItem && (!contains(node.item) || node_of_item_[node.item] != at))
      return "item " + std::to_string(node.item) + " is not where the tree looks for it";
  }
  for (std::uint32_t item = 0; item < node_of_item_.size(); ++item)
    if (contains(item))
      if (auto wrong = first_inconsistency(item)) return wrong;
  return std::nullopt;
}

template class AlternatingTree<3>;

}  // namespace octafront
