#include "geometry/self_intersection.h"

#include <algorithm>

#include <oneapi/tbb/parallel_for.h>

namespace octafront {

// Descends the tree against itself. A task is a pair of nodes whose triangles are to be compared, or one node to be
// compared within. The list of tasks depends on the tree alone.
class SelfIntersectionSearch {
 public:
  SelfIntersectionSearch(const TriangleTree& tree, std::span<const Triangle> triangles, std::size_t limit)
      : tree_(tree), triangles_(triangles), limit_(limit) {}

  std::vector<std::array<std::uint32_t, 2>> run() const {
    if (tree_.empty()) return {};
    const std::vector<Task> tasks = split_tasks();
    std::vector<Pairs> found(tasks.size());
    tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) { work_off(tasks[i], found[i]); });
    Pairs all;
    for (const Pairs& pairs : found) all.insert(all.end(), pairs.begin(), pairs.end());
    std::sort(all.begin(), all.end());
    if (all.size() > limit_) all.resize(limit_);
    return all;
  }

 private:
  using Pairs = std::vector<std::array<std::uint32_t, 2>>;
  struct Task {
    std::uint32_t a, b;  // nodes; equal: within one node
  };

  bool is_leaf(std::uint32_t n) const { return tree_.nodes_[n].count > 0; }
  bool is_leaf_task(Task t) const { return is_leaf(t.a) && is_leaf(t.b); }

  // Calls next(task) for each part of a task that is not for leaves alone.
  template <class Next>
  void divide(Task t, Next&& next) const {
    const auto add = [&](std::uint32_t a, std::uint32_t b) {
      if (a == b || tree_.nodes_[a].box.overlaps(tree_.nodes_[b].box)) next(Task{a, b});
    };
    if (t.a == t.b) {
      const std::uint32_t left = tree_.nodes_[t.a].first, right = left + 1;
      add(left, left);
      add(right, right);
      add(left, right);
      return;
    }
    if (is_leaf(t.a) || (!is_leaf(t.b) && squared_length(tree_.nodes_[t.a].box.extent()) <
                                              squared_length(tree_.nodes_[t.b].box.extent())))
      std::swap(t.a, t.b);
    add(tree_.nodes_[t.a].first, t.b);
    add(tree_.nodes_[t.a].first + 1, t.b);
  }

  std::vector<Task> split_tasks() const {
    constexpr std::size_t kTasks = 512;
    std::vector<Task> tasks{{0, 0}};
    while (tasks.size() < kTasks) {
      std::vector<Task> finer;
      for (const Task& t : tasks) {
        if (is_leaf_task(t))
          finer.push_back(t);
        else
          divide(t, [&](Task part) { finer.push_back(part); });
      }
      if (finer.size() <= tasks.size()) return finer;
      tasks = std::move(finer);
    }
    return tasks;
  }

  void work_off(Task first, Pairs& found) const {
    std::vector<Task> stack{first};
    while (!stack.empty() && found.size() < limit_) {
      const Task t = stack.back();
      stack.pop_back();
      if (is_leaf_task(t))
        compare_leaves(t, found);
      else
        divide(t, [&](Task part) { stack.push_back(part); });
    }
  }

  void compare_leaves(Task t, Pairs& found) const {
    const auto &a = tree_.nodes_[t.a], &b = tree_.nodes_[t.b];
    for (std::uint32_t i = a.first; i < a.first + a.count; ++i) {
      const auto& s = tree_.items_[i];
      const Box3 s_box = box_of(s.corners);
      if (!s_box.overlaps(b.box)) continue;
      for (std::uint32_t j = t.a == t.b ? i + 1 : b.first; j < b.first + b.count; ++j) {
        const auto& o = tree_.items_[j];
        if (!s_box.overlaps(box_of(o.corners))) continue;
        if (triangles_conflict(s.corners, triangles_[s.triangle], o.corners, triangles_[o.triangle]))
          found.push_back({std::min(s.triangle, o.triangle), std::max(s.triangle, o.triangle)});
      }
    }
  }

  const TriangleTree& tree_;
  std::span<const Triangle> triangles_;
  std::size_t limit_;
};

std::vector<std::array<std::uint32_t, 2>> self_intersections(std::span<const Vec3> points,
                                                             std::span<const Triangle> triangles, std::size_t limit) {
  return self_intersections(TriangleTree(points, triangles), triangles, limit);
}

std::vector<std::array<std::uint32_t, 2>> self_intersections(const TriangleTree& tree,
                                                             std::span<const Triangle> triangles, std::size_t limit) {
  return SelfIntersectionSearch(tree, triangles, limit).run();
}

}  // namespace octafront
