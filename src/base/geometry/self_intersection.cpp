#include "base/geometry/self_intersection.h"

#include "base/core/parallel.h"

#include <algorithm>
#include <utility>

namespace octafront {

// Descends a tree against itself. A task is a pair of nodes whose triangles are to be compared, or one node to be
// compared within. The list of tasks depends on the tree alone.
class SelfIntersectionSearch {
 public:
  using Pairs = std::vector<std::array<std::uint32_t, 2>>;

  /// Triangle i of the tree is number numbers[i] of all, or i if there are no numbers.
  SelfIntersectionSearch(const TriangleTree& tree, std::span<const std::uint32_t> numbers,
                         std::span<const Triangle> triangles, std::size_t limit, const RunContext& context)
      : tree_(tree), numbers_(numbers), triangles_(triangles), limit_(limit), context_(context) {}

  void run(Pairs& all) const {
    if (tree_.empty()) return;
    const std::vector<Task> tasks = split_tasks();
    std::vector<Pairs> found(tasks.size());
    parallel_for(tasks.size(), [&](std::size_t i) { work_off(tasks[i], found[i]); });
    for (const Pairs& pairs : found) all.insert(all.end(), pairs.begin(), pairs.end());
  }

 private:
  struct Task {
    std::uint32_t a, b;  // nodes; equal: within one
  };

  std::uint32_t number(std::uint32_t i) const { return numbers_.empty() ? i : numbers_[i]; }
  const TriangleTree::Node& node(std::uint32_t n) const { return tree_.nodes_[n]; }
  bool is_leaf_task(Task t) const { return node(t.a).count > 0 && node(t.b).count > 0; }

  // Calls next(task) for each part of a task that is not for leaves alone.
  template <class Next>
  void divide(Task t, Next&& next) const {
    const auto add = [&](Task part) {
      if (part.a == part.b || node(part.a).box.overlaps(node(part.b).box)) next(part);
    };
    const auto &a = node(t.a), &b = node(t.b);
    if (t.a == t.b) {
      add({a.first, a.first});
      add({a.first + 1, a.first + 1});
      add({a.first, a.first + 1});
      return;
    }
    const bool split_b =
        a.count > 0 || (b.count == 0 && squared_length(a.box.extent()) < squared_length(b.box.extent()));
    for (std::uint32_t child : {0u, 1u}) add(split_b ? Task{t.a, b.first + child} : Task{a.first + child, t.b});
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
      context_.check();
      const Task t = stack.back();
      stack.pop_back();
      if (is_leaf_task(t))
        compare_leaves(t, found);
      else
        divide(t, [&](Task part) { stack.push_back(part); });
    }
  }

  void compare_leaves(Task t, Pairs& found) const {
    const auto &a = node(t.a), &b = node(t.b);
    for (std::uint32_t i = a.first; i < a.first + a.count; ++i) {
      const auto& s = tree_.items_[i];
      const Box3 s_box = box_of(s.corners);
      if (!s_box.overlaps(b.box)) continue;
      const std::uint32_t s_number = number(s.triangle);
      for (std::uint32_t j = t.a == t.b ? i + 1 : b.first; j < b.first + b.count; ++j) {
        const auto& o = tree_.items_[j];
        if (!s_box.overlaps(box_of(o.corners))) continue;
        const std::uint32_t o_number = number(o.triangle);
        if (triangles_conflict(s.corners, triangles_[s_number], o.corners, triangles_[o_number]))
          found.push_back({std::min(s_number, o_number), std::max(s_number, o_number)});
      }
    }
  }

  const TriangleTree& tree_;
  std::span<const std::uint32_t> numbers_;
  std::span<const Triangle> triangles_;
  std::size_t limit_;
  const RunContext& context_;
};

namespace {

using Pairs = SelfIntersectionSearch::Pairs;

// Vertices with more triangles than this are the centres of fans. The boxes of a fan's triangles all overlap.
constexpr std::size_t kFan = 256;

// Triangles by the fan that they belong to, those of none first; a triangle of several fans belongs to one of them.
struct Fans {
  std::vector<std::vector<std::uint32_t>> parts{1};
  std::vector<VertexIndex> centers{kNone};
};

Fans find_fans(std::size_t points, std::span<const Triangle> triangles) {
  std::vector<std::uint32_t> degree(points, 0);
  for (const Triangle& t : triangles)
    for (const VertexIndex v : t) ++degree[v];
  Fans fans;
  std::vector<std::uint32_t> part(points, 0);
  for (VertexIndex v = 0; v < points; ++v) {
    if (degree[v] <= kFan) continue;
    part[v] = static_cast<std::uint32_t>(fans.parts.size());
    fans.parts.emplace_back();
    fans.centers.push_back(v);
  }
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto largest =
        std::ranges::max_element(triangles[t], {}, [&](VertexIndex v) { return std::pair(degree[v], v); });
    fans.parts[part[*largest]].push_back(t);
  }
  return fans;
}

// The directions in which a triangle is seen from a corner, boxed: those of the two other corners, and the arc between
// them, which rises above its chord by less than the chord is long.
struct View {
  Box3 box;
  std::uint32_t triangle;
};

View view_from(VertexIndex center, std::span<const Vec3> points, const Triangle& t, std::uint32_t number) {
  constexpr double kRoundingOfView = 1e-9;
  Box3 box;
  std::array<Vec3, 2> u;
  int n = 0;
  for (const VertexIndex v : t)
    if (v != center && n < 2) u[n++] = normalized(points[v] - points[center]);
  const bool usable =
      n == 2 && is_finite(u[0]) && is_finite(u[1]) && squared_length(u[0]) > 0.5 && squared_length(u[1]) > 0.5;
  if (!usable) return {{{-2, -2, -2}, {2, 2, 2}}, number};
  const double squared_chord = squared_length(u[1] - u[0]);
  // An arc of angle x rises by 1 - cos(x / 2) = c^2 / 8 + ..., at most c^2 / 4 up to half a turn.
  const double bulge = squared_chord / 4 + kRoundingOfView;
  box.add(u[0]);
  box.add(u[1]);
  return {box.grown(bulge), number};
}

// Triangles with a common corner that meet elsewhere are seen in a common direction from there. A sweep along the axis
// along which directions differ most.
void search_fan(VertexIndex center, std::span<const std::uint32_t> fan, std::span<const Vec3> points,
                std::span<const Triangle> triangles, std::size_t limit, Pairs& found) {
  std::vector<View> views;
  Box3 all;
  for (const std::uint32_t t : fan) {
    views.push_back(view_from(center, points, triangles[t], t));
    all.add(views.back().box.lo);
    all.add(views.back().box.hi);
  }
  const Vec3 e = all.extent();
  const auto along = [&](Vec3 p) { return e.x >= e.y && e.x >= e.z ? p.x : e.y >= e.z ? p.y : p.z; };
  std::ranges::sort(views, [&](const View& a, const View& b) {
    return std::pair(along(a.box.lo), a.triangle) < std::pair(along(b.box.lo), b.triangle);
  });
  const auto corners = [&](const Triangle& t) { return TriangleCorners{points[t[0]], points[t[1]], points[t[2]]}; };
  for (std::size_t i = 0; i < views.size() && found.size() < limit; ++i) {
    const Triangle& s = triangles[views[i].triangle];
    for (std::size_t j = i + 1; j < views.size() && along(views[j].box.lo) <= along(views[i].box.hi); ++j) {
      if (!views[i].box.overlaps(views[j].box)) continue;
      const Triangle& o = triangles[views[j].triangle];
      if (triangles_conflict(corners(s), s, corners(o), o))
        found.push_back(
            {std::min(views[i].triangle, views[j].triangle), std::max(views[i].triangle, views[j].triangle)});
    }
  }
}

// Some triangles, their tree, and their numbers among all.
struct Numbered {
  const TriangleTree& tree;
  std::span<const std::uint32_t> numbers;
};

// The triangles of two parts, one of them a fan. The boxes of a fan's triangles all meet at its centre, and those of
// two fans on one axis all meet each other. So each triangle of one part is looked for in the tree of the other by
// itself, not by its box; in which, a sample tells: sectors of a cone meet few boxes of the disc below, but its sectors
// those of the whole cone.
class SearchBetween {
 public:
  SearchBetween(std::span<const Vec3> points, std::span<const Triangle> triangles, std::size_t limit,
                const RunContext& context)
      : points_(points), triangles_(triangles), limit_(limit), context_(context) {}

  void run(const Numbered& a, const Numbered& b, Pairs& found) const {
    if (!a.tree.box().overlaps(b.tree.box())) return;
    if (work(a, b) <= work(b, a))
      search(a, b, found);
    else
      search(b, a, found);
  }

 private:
  static constexpr std::size_t kSample = 64, kBlock = 256;

  TriangleCorners corners(std::uint32_t t) const {
    const auto [a, b, c] = triangles_[t];
    return {points_[a], points_[b], points_[c]};
  }

  // Pairs to compare, as far as a sample tells.
  double work(const Numbered& these, const Numbered& others) const {
    const std::size_t step = 1 + these.numbers.size() / kSample;
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < these.numbers.size(); i += step)
      others.tree.for_each_near(corners(these.numbers[i]), [&](std::uint32_t, const TriangleCorners&) { ++pairs; });
    return static_cast<double>(step * pairs);
  }

  void search(const Numbered& these, const Numbered& others, Pairs& found) const {
    std::vector<Pairs> of_block((these.numbers.size() + kBlock - 1) / kBlock);
    parallel_for(of_block.size(), [&](std::size_t block) {
      const std::size_t end = std::min((block + 1) * kBlock, these.numbers.size());
      for (std::size_t i = block * kBlock; i < end && of_block[block].size() < limit_; ++i)
        search_for(these.numbers[i], others, of_block[block]);
    });
    for (const Pairs& pairs : of_block) found.insert(found.end(), pairs.begin(), pairs.end());
  }

  void search_for(std::uint32_t s, const Numbered& others, Pairs& pairs) const {
    context_.check();
    const TriangleCorners here = corners(s);
    others.tree.for_each_near(here, [&](std::uint32_t i, const TriangleCorners& there) {
      const std::uint32_t o = others.numbers[i];
      if (triangles_conflict(here, triangles_[s], there, triangles_[o]))
        pairs.push_back({std::min(s, o), std::max(s, o)});
    });
  }

  std::span<const Vec3> points_;
  std::span<const Triangle> triangles_;
  std::size_t limit_;
  const RunContext& context_;
};

Pairs sorted_up_to(Pairs pairs, std::size_t limit) {
  std::sort(pairs.begin(), pairs.end());
  if (pairs.size() > limit) pairs.resize(limit);
  return pairs;
}

// Each fan by the directions from its centre; between them, and in the rest, by trees.
Pairs search_with_fans(const Fans& fans, std::span<const Vec3> points, std::span<const Triangle> triangles,
                       std::size_t limit, const RunContext& context) {
  std::vector<TriangleTree> trees;
  for (const auto& part : fans.parts) {
    std::vector<Triangle> own;
    for (const std::uint32_t t : part) own.push_back(triangles[t]);
    trees.emplace_back(points, own);
  }
  Pairs found;
  SelfIntersectionSearch(trees[0], fans.parts[0], triangles, limit, context).run(found);
  const SearchBetween between(points, triangles, limit, context);
  for (std::size_t a = 1; a < trees.size(); ++a) {
    context.check();
    search_fan(fans.centers[a], fans.parts[a], points, triangles, limit, found);
    for (std::size_t b = 0; b < a; ++b) between.run({trees[a], fans.parts[a]}, {trees[b], fans.parts[b]}, found);
  }
  return sorted_up_to(std::move(found), limit);
}

}  // namespace

std::vector<std::array<std::uint32_t, 2>> self_intersections(std::span<const Vec3> points,
                                                             std::span<const Triangle> triangles, std::size_t limit,
                                                             const RunContext& context) {
  const Fans fans = find_fans(points.size(), triangles);
  if (fans.parts.size() > 1) return search_with_fans(fans, points, triangles, limit, context);
  return self_intersections(TriangleTree(points, triangles), triangles, limit, context);
}

std::vector<std::array<std::uint32_t, 2>> self_intersections(const TriangleTree& tree,
                                                             std::span<const Triangle> triangles, std::size_t limit,
                                                             const RunContext& context) {
  Pairs found;
  SelfIntersectionSearch(tree, {}, triangles, limit, context).run(found);
  return sorted_up_to(std::move(found), limit);
}

}  // namespace octafront
