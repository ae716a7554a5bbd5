#include "soup/cells/find_cells.h"

#include <octafront/error.h>

#include "base/core/disjoint_sets.h"
#include "base/core/wording.h"
#include "base/geometry/double_double.h"

#include <algorithm>
#include <queue>
#include <tuple>

#include <fmt/core.h>

namespace octafront {

namespace {

/// For each piece of the surface, a line that crosses it.
std::vector<SightLines::Line> lines_through_pieces(const SightLines& lines, const cells::SideGraph& graph,
                                                   std::span<const Vec3> points, std::span<const Triangle> triangles) {
  std::vector<std::optional<SightLines::Line>> line(graph.pieces);
  std::vector<Vec3> anywhere(graph.pieces);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    auto& of_piece = line[graph.piece[t]];
    if (of_piece) continue;
    of_piece = lines.line_through(t);
    anywhere[graph.piece[t]] = points[triangles[t][0]];
  }
  std::vector<SightLines::Line> all;
  for (std::size_t p = 0; p < line.size(); ++p) {
    if (!line[p])
      throw InputError(
          fmt::format("a piece of the surface near {} is so thin that it has no inside in double "
                      "precision; give it away",
                      at_point(anywhere[p])));
    all.push_back(*line[p]);
  }
  return all;
}

}  // namespace

Cells::Cells(std::span<const Vec3> points, std::span<const Triangle> triangles, const RunContext& context)
    : points_(points),
      triangles_(triangles),
      graph_(cells::make_side_graph(points, triangles, context)),
      lines_(points, triangles) {
  const auto infinity = static_cast<std::uint32_t>(2 * triangles.size());
  DisjointSets sets(infinity + 1);
  for (Side s = 0; s < infinity; ++s)
    for (const Side n : graph_.next[s]) sets.join(s, n);
  for (const SightLines::Line& line : lines_through_pieces(lines_, graph_, points, triangles)) {
    context.check();
    Side below = kNone;
    const auto see = [&](Side above) {
      seen_.push_back({below, above});
      sets.join(below == kNone ? infinity : below, above == kNone ? infinity : above);
    };
    for (const SightLines::Crossing& c : lines_.crossings(line.p, line.axis)) {
      see(c.below());
      below = c.above();
    }
    see(kNone);
  }
  std::vector<std::uint32_t> number(infinity + 1, kNone);
  number[sets.find(infinity)] = count_++;
  cell_.resize(infinity);
  for (Side s = 0; s < infinity; ++s) {
    std::uint32_t& n = number[sets.find(s)];
    if (n == kNone) n = count_++;
    cell_[s] = n;
  }
}

std::vector<double> Cells::volumes() const {
  using exact::DoubleDouble, exact::two_product;
  // By sums of two doubles: of long doubles each kind of machine has its own.
  std::vector<DoubleDouble> six(count_);
  // Each cell is seen from a vertex of its own: far from it what a tiny one has would cancel.
  std::vector<VertexIndex> origin(count_, kNone);
  const auto six_volumes_from = [&](VertexIndex o, const Triangle& t) {
    const Vec3 p = points_[t[0]] - points_[o], q = points_[t[1]] - points_[o], r = points_[t[2]] - points_[o];
    const auto times_det = [](double factor, double x, double y, double z, double w) {
      return DoubleDouble({factor, 0}) * (DoubleDouble(two_product(x, w)) - two_product(y, z));
    };
    return times_det(p.x, q.y, q.z, r.y, r.z) + times_det(p.y, q.z, q.x, r.z, r.x) + times_det(p.z, q.x, q.y, r.x, r.y);
  };
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const bool is_behind : {false, true}) {
      const std::uint32_t cell = cell_[2 * t + (is_behind ? 1 : 0)];
      if (origin[cell] == kNone) origin[cell] = triangles_[t][0];
      const DoubleDouble part = six_volumes_from(origin[cell], triangles_[t]);
      six[cell] = is_behind ? six[cell] + part : six[cell] - part;
    }
  std::vector<double> volumes;
  // Enclosed cells have a volume; of slivers rounding may leave less than nothing.
  for (const DoubleDouble& v : six) volumes.push_back(std::max(0.0, v.hi / 6));
  volumes[0] = 0;
  return volumes;
}

std::optional<std::uint32_t> Cells::at(Vec3 p) const {
  // Nobody means a place within rounding of a wall.
  constexpr double kNear = 1e-12;
  if (lines_.tree().is_within(p, kNear * lines_.tree().box().diagonal())) return std::nullopt;
  const std::optional<Side> side = lines_.first_side(p, 0);
  return side ? cell_[*side] : 0;
}

std::vector<std::vector<Side>> Cells::links() const {
  const std::size_t infinity = cell_.size();
  std::vector<std::vector<Side>> links(infinity + 1);
  const auto place = [&](Side s) { return s == kNone ? infinity : s; };
  for (const auto& [a, b] : seen_) {
    links[place(a)].push_back(static_cast<Side>(place(b)));
    links[place(b)].push_back(static_cast<Side>(place(a)));
  }
  return links;
}

std::vector<Vec3> Cells::way(Vec3 from, std::optional<Vec3> to) const {
  const auto infinity = static_cast<Side>(cell_.size());
  const auto seen_from = [&](Vec3 p) {
    for (int axis = 0; axis < 3; ++axis)
      if (const auto side = lines_.first_side(p, axis)) return *side;
    return infinity;
  };
  const Side start = seen_from(from), goal = to ? seen_from(*to) : infinity;
  if (start == infinity) return {};
  const auto middle = [&](Side s) {
    const auto [a, b, c] = triangles_[triangle_of(s)];
    return (points_[a] + points_[b] + points_[c]) / 3;
  };
  // The shortest way from middle to middle (E. W. Dijkstra, 1959).
  const auto others = links();
  std::vector<double> reached(infinity + 1, TriangleTree::kFar);
  std::vector<Side> came_from(infinity + 1, kNone);
  std::priority_queue<std::pair<double, Side>, std::vector<std::pair<double, Side>>, std::greater<>> queue;
  queue.push({reached[start] = 0, start});
  const double far = lines_.tree().box().diagonal();
  while (!queue.empty() && queue.top().second != goal) {
    const auto [length, s] = queue.top();
    queue.pop();
    if (length > reached[s]) continue;
    const auto visit = [&, s = s, length = length](Side n) {
      const double step = s == infinity || n == infinity ? far : distance(middle(s), middle(n));
      if (length + step >= reached[n]) return;
      reached[n] = length + step;
      came_from[n] = s;
      queue.push({reached[n], n});
    };
    if (s != infinity)
      for (const Side n : graph_.next[s]) visit(n);
    for (const Side n : others[s]) visit(n);
  }
  std::vector<Vec3> way;
  if (to) way.push_back(*to);
  for (Side s = goal; s != kNone; s = came_from[s])
    if (s != infinity) way.push_back(middle(s));
  way.push_back(from);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace octafront
