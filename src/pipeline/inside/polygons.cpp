#include "pipeline/inside/polygons.h"

#include <octafront/error.h>

#include "base/core/groups.h"
#include "base/geometry/same_place.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace octafront {
namespace {

/// How far a line may be from what was given, of the size there: what makes edges as long as the size of a curve with
/// a radius of three.
constexpr double kTrue = 0.05;

struct Net {
  std::vector<Vec3> points;
  std::vector<Edge> edges;
};

Net merged(const LineNet& net) {
  Net made;
  VerticesByPlace at;
  std::vector<VertexIndex> number;
  for (const Vec3& p : net.points) {
    if (!is_finite(p)) throw InputError(fmt::format("the line {} has a point that is not finite", net.name));
    number.push_back(at.add(p, static_cast<VertexIndex>(made.points.size())));
    if (number.back() == made.points.size()) made.points.push_back(p);
  }
  for (const auto& [a, b] : net.edges) {
    if (a >= number.size() || b >= number.size())
      throw InputError(fmt::format("the line {} names the point {}, but there are only {}", net.name, std::max(a, b),
                                   number.size()));
    if (number[a] != number[b]) made.edges.push_back(sorted_edge(number[a], number[b]));
  }
  std::sort(made.edges.begin(), made.edges.end());
  made.edges.erase(std::unique(made.edges.begin(), made.edges.end()), made.edges.end());
  if (made.edges.empty()) throw InputError(fmt::format("the line {} has no edge of any length", net.name));
  return made;
}

/// Walks along edges that nobody walked yet.
class Walk {
 public:
  explicit Walk(Net net)
      : net_(std::move(net)),
        at_(group_by_owner(net_.points.size(), static_cast<std::uint32_t>(2 * net_.edges.size()),
                           [&](std::uint32_t end) { return net_.edges[end / 2][end % 2]; })),
        done_(net_.edges.size(), 0) {}

  std::vector<std::vector<Vec3>> all() {
    std::vector<std::vector<Vec3>> polygons;
    for (const bool closed : {false, true})
      for (VertexIndex v = 0; v < net_.points.size(); ++v)
        for (const std::uint32_t end : at_[v])
          if (!done_[end / 2] && (closed || is_end(v))) polygons.push_back(from(v, end));
    return polygons;
  }

 private:
  bool is_end(VertexIndex v) const { return at_[v].size() != 2; }

  std::vector<Vec3> from(VertexIndex v, std::uint32_t end) {
    const VertexIndex start = v;
    std::vector<Vec3> polygon{net_.points[v]};
    for (;;) {
      done_[end / 2] = 1;
      v = net_.edges[end / 2][1 - end % 2];
      polygon.push_back(net_.points[v]);
      if (is_end(v) || v == start) return polygon;
      end = done_[at_[v][0] / 2] ? at_[v][1] : at_[v][0];
    }
  }

  Net net_;
  Groups<> at_;
  std::vector<char> done_;
};

double distance_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 along = b - a;
  const double t = std::clamp(dot(p - a, along) / squared_length(along), 0.0, 1.0);
  return distance(p, a + t * along);
}

/// Keeps the vertices of [first, last] without which the polygon would stray (U. Ramer 1972; D. Douglas, T. Peucker
/// 1973).
void keep_vertices(const std::vector<Vec3>& polygon, std::size_t first, std::size_t last, const SizeField& sizes,
                   std::vector<char>& keep) {
  std::vector<std::pair<std::size_t, std::size_t>> spans{{first, last}};
  while (!spans.empty()) {
    const auto [from, to] = spans.back();
    spans.pop_back();
    double worst = 1;
    std::size_t at = from;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double off = distance_to_segment(polygon[i], polygon[from], polygon[to]) / (kTrue * sizes.at(polygon[i]));
      if (off > worst) worst = off, at = i;
    }
    if (at == from) continue;
    keep[at] = 1;
    spans.push_back({from, at});
    spans.push_back({at, to});
  }
}

/// Without vertices that it does not need; a closed one keeps the one farthest from its ends.
std::vector<Vec3> simplified(const std::vector<Vec3>& polygon, const SizeField& sizes) {
  std::vector<char> keep(polygon.size(), 0);
  keep.front() = keep.back() = 1;
  std::size_t far = 0;
  if (polygon.front() == polygon.back())
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      if (far == 0 || squared_length(polygon[i] - polygon[0]) > squared_length(polygon[far] - polygon[0])) far = i;
  if (far > 0) {
    keep[far] = 1;
    keep_vertices(polygon, 0, far, sizes, keep);
  }
  keep_vertices(polygon, far, polygon.size() - 1, sizes, keep);
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    if (keep[i]) kept.push_back(polygon[i]);
  return kept;
}

/// A vertex of a polygon; one on a wall stays.
struct Corner {
  Vec3 p;
  bool on_wall = false;
};

/// Where the segment goes through walls, as parts of it, ascending, each place once; not at its ends.
std::vector<double> hits_of(Vec3 p, Vec3 q, const TriangleTree& walls) {
  constexpr double kSame = 1e-6;
  std::vector<double> hits;
  walls.for_each_hit(p, q, [&](std::uint32_t triangle, const SegmentHit&) {
    const auto& [a, b, c] = walls.corners(triangle);
    const Vec3 normal = cross(b - a, c - a);
    const double from = dot(p - a, normal), to = dot(q - a, normal);
    const double t = from / (from - to);
    if (t > kSame && t < 1 - kSame) hits.push_back(t);
  });
  std::sort(hits.begin(), hits.end());
  hits.erase(std::unique(hits.begin(), hits.end(), [](double s, double t) { return t - s < kSame; }), hits.end());
  return hits;
}

/// A vertex on each wall, and none beside it that the polygon could do without.
std::vector<Vec3> cut_at_walls(const std::vector<Vec3>& polygon, const SizeField& sizes, const TriangleTree& walls) {
  std::vector<Corner> corners{{polygon.front()}};
  for (std::size_t i = 0; i + 1 < polygon.size(); ++i) {
    const Vec3 p = polygon[i], q = polygon[i + 1];
    for (const double t : hits_of(p, q, walls)) corners.push_back({p + t * (q - p), true});
    corners.push_back({q});
  }
  constexpr double kBeside = 0.5, kBlunt = 0.866;  // of the size; cosine of 30 degrees
  std::vector<Vec3> kept{corners.front().p};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const auto& [last, last_on] = corners[i - 1];
    const auto& [at, on] = corners[i];
    const auto& [next, next_on] = corners[i + 1];
    const double reach = kBeside * sizes.at(at);
    const bool beside = (last_on && distance(last, at) < reach) || (next_on && distance(next, at) < reach);
    const bool blunt = dot(normalized(at - last), normalized(next - at)) > kBlunt;
    if (on || !beside || !blunt) kept.push_back(at);
  }
  kept.push_back(corners.back().p);
  return kept;
}

/// How many sizes long the way from a to b is, from sample to sample.
std::vector<double> lengths_in_sizes(Vec3 a, Vec3 b, const SizeField& sizes) {
  const double shortest = std::min({sizes.at(a), sizes.at(b), sizes.at(0.5 * (a + b))});
  constexpr double kSamplesPerSize = 4, kMostSamples = 1e6;
  const auto count =
      static_cast<std::size_t>(std::clamp(std::ceil(kSamplesPerSize * distance(a, b) / shortest), 8.0, kMostSamples));
  std::vector<double> sum{0};
  for (std::size_t i = 0; i < count; ++i) {
    const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    sum.push_back(sum.back() + distance(a, b) / static_cast<double>(count) / sizes.at(a + t * (b - a)));
  }
  return sum;
}

void divide_edge(Vec3 a, Vec3 b, const SizeField& sizes, std::vector<Vec3>& out) {
  const std::vector<double> sum = lengths_in_sizes(a, b, sizes);
  const auto parts = static_cast<std::size_t>(std::max(1.0, std::round(sum.back())));
  std::size_t i = 0;
  for (std::size_t k = 1; k < parts; ++k) {
    const double wanted = sum.back() * static_cast<double>(k) / static_cast<double>(parts);
    while (sum[i + 1] < wanted) ++i;
    const double t =
        (static_cast<double>(i) + (wanted - sum[i]) / (sum[i + 1] - sum[i])) / static_cast<double>(sum.size() - 1);
    out.push_back(a + t * (b - a));
  }
  out.push_back(b);
}

}  // namespace

std::vector<std::vector<Vec3>> polygons_of(const LineNet& net) {
  return Walk(merged(net)).all();
}

std::vector<Vec3> divided(const std::vector<Vec3>& polygon, const SizeField& sizes, const TriangleTree& walls) {
  const std::vector<Vec3> corners = cut_at_walls(simplified(polygon, sizes), sizes, walls);
  std::vector<Vec3> made{corners.front()};
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) divide_edge(corners[i], corners[i + 1], sizes, made);
  return made;
}

}  // namespace octafront
