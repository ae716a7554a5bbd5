#include "base/core/disjoint_sets.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/geometry/sight_line.h"
#include "base/geometry/winding_number.h"
#include "soup/mend/mend_steps.h"
#include "soup/mend/min_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace octafront::mend {
namespace {

/// Cells that are wound around this much more or less than half are certain.
constexpr double kCertain = 0.2;
/// Points that are looked at in each cell.
constexpr int kSamples = 3;

/// Pieces whose back lies at the unbounded cell, by area. Where that is the greater part, pieces that do not lie there
/// are of the same mind.
std::vector<char> turned_pieces(const Arrangement& arranged, const Cells& cells, const PieceOf& pieces) {
  std::vector<double> right(pieces.count, 0), wrong(pieces.count, 0);
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    const auto [front, back] = cells.sides_of(t);
    if (front == back || (front != 0 && back != 0)) continue;
    for (const Origin& o : arranged.origins_of(t))
      ((front == 0) != o.reversed ? right : wrong)[pieces.piece[o.triangle]] +=
          triangle_area(arranged.points, arranged.triangles[t]);
  }
  const bool most = std::accumulate(wrong.begin(), wrong.end(), 0.0) > std::accumulate(right.begin(), right.end(), 0.0);
  std::vector<char> turned(pieces.count);
  for (std::size_t p = 0; p < turned.size(); ++p) turned[p] = wrong[p] == right[p] ? most : wrong[p] > right[p];
  return turned;
}

/// How often more a triangle of the arrangement lies there forward than backward.
int times(const Arrangement& arranged, std::size_t t, const PieceOf& pieces, const std::vector<char>& turned) {
  int net = 0;
  for (const Origin& o : arranged.origins_of(t))
    if (!pieces.is_sheet[pieces.piece[o.triangle]])
      net += (turned[pieces.piece[o.triangle]] != 0) == o.reversed ? 1 : -1;
  return net;
}

/// The walls between cells, as often as they are there. What has one cell on both sides winds around nothing.
SurfaceMesh walls_of(const Arrangement& arranged, const Cells& cells, const PieceOf& pieces,
                     const std::vector<char>& turned) {
  SurfaceMesh walls;
  walls.points = arranged.points;
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    const auto [front, back] = cells.sides_of(t);
    if (front == back) continue;
    const int net = times(arranged, t, pieces, turned);
    const auto [a, b, c] = arranged.triangles[t];
    for (int i = 0; i < std::abs(net); ++i) walls.triangles.push_back(net > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
  }
  return walls;
}

struct Sample {
  std::uint32_t cell;
  Vec3 at;
  double room;  ///< length of the line within the cell
};

/// Points inside cells, in the middle between walls along lines through their largest triangles.
class Sampler {
 public:
  Sampler(const Arrangement& arranged, const Cells& cells)
      : arranged_(arranged), cells_(cells), lines_(arranged.points, arranged.triangles), found_(cells.count(), 0) {}

  std::vector<Sample> samples(const RunContext& context) {
    std::vector<double> area(arranged_.triangles.size());
    for (std::size_t t = 0; t < area.size(); ++t) area[t] = triangle_area(arranged_.points, arranged_.triangles[t]);
    std::vector<std::uint32_t> order(area.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t s, std::uint32_t t) { return area[s] > area[t]; });
    for (const std::uint32_t t : order) {
      const auto sides = cells_.sides_of(t);
      if (!wanted(sides[0]) && !wanted(sides[1])) continue;
      context.check();
      look_along(t);
    }
    return std::move(samples_);
  }

 private:
  bool wanted(std::uint32_t cell) const { return cell != 0 && found_[cell] < kSamples; }

  void look_along(std::uint32_t t) {
    const auto line = lines_.line_through(t);
    if (!line) return;
    const auto crossings = lines_.crossings(line->p, line->axis);
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
      const Side side = crossings[i].above();
      const std::uint32_t cell = cells_.sides_of(triangle_of(side))[side % 2];
      if (!wanted(cell)) continue;
      Vec3 at = line->p;
      const double from = height(crossings[i].triangle, *line), to = height(crossings[i + 1].triangle, *line);
      if (!(to > from)) continue;
      at[line->axis] = from + 0.5 * (to - from);
      samples_.push_back({cell, at, to - from});
      ++found_[cell];
    }
  }

  /// Where the line meets the plane of a triangle.
  double height(std::uint32_t t, const SightLines::Line& line) const {
    const auto [i, j, k] = arranged_.triangles[t];
    const Vec3 a = arranged_.points[i], b = arranged_.points[j], c = arranged_.points[k];
    const Vec3 n = double_area_normal(a, b, c);
    Vec3 p = line.p;
    p[line.axis] = a[line.axis];
    const double h = a[line.axis] - dot(n, p - a) / n[line.axis];
    const auto [lo, hi] = std::minmax({a[line.axis], b[line.axis], c[line.axis]});
    return std::clamp(h, lo, hi);
  }

  const Arrangement& arranged_;
  const Cells& cells_;
  SightLines lines_;
  std::vector<int> found_;
  std::vector<Sample> samples_;
};

std::vector<double> windings_of(const Arrangement& arranged, const Cells& cells, const SurfaceMesh& walls,
                                const RunContext& context) {
  const std::vector<Sample> samples = Sampler(arranged, cells).samples(context);
  const WindingNumber around(walls);
  std::vector<double> value(samples.size());
  parallel_for(samples.size(), [&](std::size_t i) { value[i] = around.at(samples[i].at); });
  std::vector<double> sum(cells.count(), 0), room(cells.count(), 0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sum[samples[i].cell] += value[i] * samples[i].room;
    room[samples[i].cell] += samples[i].room;
  }
  for (std::size_t c = 1; c < sum.size(); ++c)
    sum[c] = room[c] > 0 ? sum[c] / room[c] : std::numeric_limits<double>::quiet_NaN();
  sum[0] = 0;
  return sum;
}

std::vector<double> wall_areas(const Arrangement& arranged, const Cells& cells) {
  std::vector<double> area(cells.count(), 0);
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    const auto sides = cells.sides_of(t);
    if (sides[0] == sides[1]) continue;
    for (const std::uint32_t c : sides) area[c] += triangle_area(arranged.points, arranged.triangles[t]);
  }
  return area;
}

/// Certain cells stay what they are; others pay for every wall between inside and outside, and for going against what
/// little is known of them.
void cut_doubtful(const Arrangement& arranged, const Cells& cells, Labels& labels) {
  const std::vector<double> area = wall_areas(arranged, cells);
  const double all = std::accumulate(area.begin(), area.end(), 0.0);
  MinCut cut(cells.count());
  for (std::uint32_t c = 0; c < cells.count(); ++c) {
    const double lean = std::isnan(labels.winding[c]) ? 0 : labels.winding[c] - 0.5;
    const bool certain = c == 0 || std::abs(lean) > kCertain;
    labels.doubtful += !certain;
    const double cost = certain ? all : area[c] * std::abs(lean);
    if (c != 0 && lean > 0)
      cut.add_node_cost(c, cost, 0);
    else
      cut.add_node_cost(c, 0, cost);
  }
  if (labels.doubtful > 0) {
    for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
      const auto [front, back] = cells.sides_of(t);
      if (front != back) cut.add_edge(front, back, triangle_area(arranged.points, arranged.triangles[t]));
    }
    labels.inside = cut.on_source_side();
    return;
  }
  for (std::uint32_t c = 0; c < cells.count(); ++c) labels.inside[c] = c != 0 && labels.winding[c] > 0.5;
}

/// Enclosed cells outside that are thinner than the tolerance, with inside behind most of their walls.
void fill_thin_gaps(const Arrangement& arranged, const Cells& cells, double tolerance, Labels& labels) {
  const std::vector<double> volumes = cells.volumes(), area = wall_areas(arranged, cells);
  std::vector<double> inner(cells.count(), 0);
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    const auto [front, back] = cells.sides_of(t);
    if (labels.inside[front]) inner[back] += triangle_area(arranged.points, arranged.triangles[t]);
    if (labels.inside[back]) inner[front] += triangle_area(arranged.points, arranged.triangles[t]);
  }
  for (std::uint32_t c = 1; c < cells.count(); ++c)
    if (!labels.inside[c] && 2 * std::abs(volumes[c]) < tolerance * area[c] && 2 * inner[c] > area[c])
      labels.filled.push_back(c);
  for (const std::uint32_t c : labels.filled) labels.inside[c] = 1;
}

/// Cells inside that are thinner than the tolerance, with the outside behind most of their walls: what an open sheet
/// and its caps enclose beside a body.
void empty_thin_flaps(const Arrangement& arranged, const Cells& cells, double tolerance, Labels& labels) {
  // Of the area of its walls. A thin cell has two sides of half of it each: more is both.
  constexpr double kMostly = 0.6;
  const std::vector<double> volumes = cells.volumes(), area = wall_areas(arranged, cells);
  std::vector<double> outer(cells.count(), 0);
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    const auto [front, back] = cells.sides_of(t);
    if (front == back) continue;
    if (!labels.inside[front]) outer[back] += triangle_area(arranged.points, arranged.triangles[t]);
    if (!labels.inside[back]) outer[front] += triangle_area(arranged.points, arranged.triangles[t]);
  }
  for (std::uint32_t c = 1; c < cells.count(); ++c)
    if (labels.inside[c] && 2 * std::abs(volumes[c]) < tolerance * area[c] && outer[c] > kMostly * area[c])
      labels.emptied.push_back(c);
  for (const std::uint32_t c : labels.emptied) labels.inside[c] = 0;
}

/// Bodies that are thinner than the tolerance: nobody could fill them with elements.
void empty_thin_bodies(const Arrangement& arranged, const Cells& cells, double tolerance, Labels& labels) {
  DisjointSets bodies(cells.count());
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    const auto [front, back] = cells.sides_of(t);
    if (labels.inside[front] && labels.inside[back]) bodies.join(front, back);
  }
  std::vector<double> volume(cells.count(), 0), area(cells.count(), 0);
  const std::vector<double> volumes = cells.volumes();
  for (std::uint32_t c = 0; c < cells.count(); ++c)
    if (labels.inside[c]) volume[bodies.find(c)] += volumes[c];
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    const auto [front, back] = cells.sides_of(t);
    if (labels.inside[front] != labels.inside[back])
      area[bodies.find(labels.inside[front] ? front : back)] += triangle_area(arranged.points, arranged.triangles[t]);
  }
  for (std::uint32_t c = 1; c < cells.count(); ++c) {
    const std::uint32_t body = bodies.find(c);
    if (labels.inside[c] && 2 * volume[body] < tolerance * area[body]) labels.emptied.push_back(c);
  }
  for (const std::uint32_t c : labels.emptied) labels.inside[c] = 0;
}

}  // namespace

Labels label_cells(const Arrangement& arranged, const Cells& cells, const PieceOf& pieces, double tolerance,
                   const RunContext& context) {
  Labels labels;
  labels.inside.assign(cells.count(), 0);
  labels.turned = turned_pieces(arranged, cells, pieces);
  labels.winding = windings_of(arranged, cells, walls_of(arranged, cells, pieces, labels.turned), context);
  cut_doubtful(arranged, cells, labels);
  fill_thin_gaps(arranged, cells, tolerance, labels);
  empty_thin_flaps(arranged, cells, tolerance, labels);
  empty_thin_bodies(arranged, cells, tolerance, labels);
  return labels;
}

}  // namespace octafront::mend
