#include "periodic/matched.h"

#include <octafront/error.h>

#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "base/geometry/plane_mesh.h"
#include "base/geometry/triangle_tree.h"
#include "periodic/face_names.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

namespace octafront::periods {

namespace {

using arrangement::Place;
using arrangement::PlaneMesh;

/// A piece of one face only is a difference from this part of the face's area on.
constexpr double kLeastDifference = 1e-9;

Vec3 seen_at_low(Vec3 p, const PeriodicCell& cell, int axis) {
  p[axis] = cell.box.lo[axis];
  return p;
}

/// A border edge as it goes: from its lower to its higher vertex, over what is nearly on it.
struct Line {
  Edge edge;
  std::uint32_t part = 0;
  std::vector<Vec3> way;
};

std::vector<Line> lines_of(const SurfaceMesh& surface, const PeriodicCell& cell, int axis, const FaceParts& face) {
  std::vector<Line> lines;
  for (const auto& [edge, part] : face.lines)
    lines.push_back(
        {edge,
         part,
         {seen_at_low(surface.points[edge[0]], cell, axis), seen_at_low(surface.points[edge[1]], cell, axis)}});
  return lines;
}

std::vector<Vec3> ends_of(const std::vector<Line>& lines) {
  std::vector<Vec3> ends;
  for (const Line& line : lines) ends.insert(ends.end(), {line.way.front(), line.way.back()});
  std::ranges::sort(ends, {}, key_of);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

/// Lines of one face go over the ends of those of the other that lie beside them within the tolerance.
void bend_over(std::vector<Line>& lines, const std::vector<Vec3>& ends, double tolerance) {
  std::vector<Vec3> corners;
  std::vector<Triangle> flat;
  for (const Line& line : lines) {
    const auto a = static_cast<VertexIndex>(corners.size());
    corners.insert(corners.end(), {line.way.front(), line.way.back()});
    flat.push_back({a, a + 1, a + 1});
  }
  const TriangleTree tree(corners, flat);
  std::vector<std::vector<std::pair<double, Vec3>>> beside(lines.size());
  const Vec3 reach{tolerance, tolerance, tolerance};
  for (const Vec3 p : ends)
    tree.for_each_box_near({p - reach, p + reach}, [&](std::uint32_t l, const TriangleCorners&) {
      const Vec3 a = lines[l].way.front(), b = lines[l].way.back();
      const double t = dot(p - a, b - a) / squared_length(b - a);
      if (p == a || p == b || !(t > 0 && t < 1) || distance(p, a + (b - a) * t) > tolerance) return true;
      if (distance(p, a) > tolerance && distance(p, b) > tolerance) beside[l].emplace_back(t, p);
      return true;
    });
  for (std::size_t l = 0; l < lines.size(); ++l) {
    std::sort(beside[l].begin(), beside[l].end(), [](const auto& s, const auto& t) { return s.first < t.first; });
    std::vector<Vec3>& way = lines[l].way;
    for (std::size_t i = 0; i < beside[l].size(); ++i)
      way.insert(way.begin() + 1 + static_cast<std::ptrdiff_t>(i), beside[l][i].second);
  }
}

class Divider {
 public:
  Divider(const PeriodicCell& cell, int axis, const std::array<std::vector<Line>, 2>& lines)
      : cell_(cell), axis_(axis), lines_(lines), mesh_(plane_of(cell, axis), axis, cell.box) {}

  CommonDivision run(std::uint32_t parts_below, const std::vector<Vec3>& points) {
    for (const Vec3 p : points) node_.add(p, mesh_.add_point({p}));
    for (const auto& of_face : lines_)
      for (const Line& line : of_face)
        for (const Vec3 p : line.way) node_.add(p, mesh_.add_point({p}));
    for (std::uint32_t side = 0; side < 2; ++side)
      for (const Line& line : lines_[side])
        for (std::size_t i = 0; i + 1 < line.way.size(); ++i)
          add_segment(line.way[i], line.way[i + 1],
                      side == 0 || line.part == kNone ? line.part : parts_below + line.part);
    mesh_.improve();
    CommonDivision made;
    number_nodes(made);
    take_pieces(parts_below, made);
    for (std::uint32_t side = 0; side < 2; ++side) find_between(side, made);
    return made;
  }

 private:
  static arrangement::Homogeneous plane_of(const PeriodicCell& cell, int axis) {
    const Vec3 a = cell.box.lo;
    Vec3 b = a, c = a;
    b[(axis + 1) % 3] = cell.box.hi[(axis + 1) % 3], c[(axis + 2) % 3] = cell.box.hi[(axis + 2) % 3];
    return arrangement::plane_through(a, b, c);
  }

  void add_segment(Vec3 p, Vec3 q, std::uint32_t part) {
    const PlaneMesh::Node a = node_.find(p), b = node_.find(q);
    if (a == b) return;
    mesh_.add_segment(a, b, arrangement::plane_along_axis(p, q, axis_), part);
  }

  void number_nodes(CommonDivision& made) {
    constexpr std::uint32_t kCornersOfRim = 3;
    for (PlaneMesh::Node n = kCornersOfRim; n < mesh_.nodes(); ++n)
      made.nodes.push_back(seen_at_low(mesh_.place(n).at, cell_, axis_));
  }

  static std::uint32_t number(PlaneMesh::Node n) { return n - 3; }

  void take_pieces(std::uint32_t parts_below, CommonDivision& made) {
    double all = 0, alone = 0, largest = 0;
    Vec3 at;
    std::uint32_t has = 0;
    for (const auto& [corners, parts] : mesh_.pieces()) {
      const std::array<Vec3, 3> p{made.nodes[number(corners[0])], made.nodes[number(corners[1])],
                                  made.nodes[number(corners[2])]};
      const double size = 0.5 * length(double_area_normal(p[0], p[1], p[2]));
      all += size;
      if (parts.size() == 2 && parts[0] < parts_below && parts[1] >= parts_below) {
        made.pieces.push_back(
            {{number(corners[0]), number(corners[1]), number(corners[2])}, {parts[0], parts[1] - parts_below}});
        continue;
      }
      alone += size;
      if (size > largest) largest = size, at = centroid(p[0], p[1], p[2]), has = parts[0] < parts_below ? 0 : 1;
    }
    if (alone > kLeastDifference * all) refuse(alone / all, at, has);
  }

  [[noreturn]] void refuse(double share, Vec3 at, std::uint32_t has) const {
    const auto low = 2 * static_cast<CellFace>(axis_);
    at[axis_] = has == 0 ? cell_.box.lo[axis_] : cell_.box.hi[axis_];
    throw InputError(fmt::format(
        "the body is no cell that is periodic along {}: its face {} has something at {} that the "
        "opposite face {} has not, and so {:.3g} % of these faces differ. Opposite faces must have the same outline; "
        "bodies that cross them are wrapped around where they are given as bodies of their own, with `box`",
        kAxisNames[axis_], name_of_face(cell_, low + has), at_point(at), name_of_face(cell_, low + 1 - has),
        100 * share));
  }

  /// Nodes that lie on the way of a line, exactly, in their order.
  void find_between(std::uint32_t side, CommonDivision& made) const {
    const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
    std::vector<std::uint32_t> by_u(made.nodes.size());
    for (std::uint32_t n = 0; n < by_u.size(); ++n) by_u[n] = n;
    std::sort(by_u.begin(), by_u.end(), [&](auto a, auto b) { return made.nodes[a][u] < made.nodes[b][u]; });
    for (const Line& line : lines_[side]) {
      std::vector<std::uint32_t> found;
      for (std::size_t i = 0; i + 1 < line.way.size(); ++i) {
        const Vec3 p = line.way[i], q = line.way[i + 1];
        if (i > 0) found.push_back(number(node_.find(p)));
        std::vector<std::pair<double, std::uint32_t>> inside;
        const double least = std::min(p[u], q[u]), most = std::max(p[u], q[u]);
        auto at = std::lower_bound(by_u.begin(), by_u.end(), least,
                                   [&](std::uint32_t n, double x) { return made.nodes[n][u] < x; });
        for (; at != by_u.end() && made.nodes[*at][u] <= most; ++at) {
          const Vec3 x = made.nodes[*at];
          if (x == p || x == q || x[v] < std::min(p[v], q[v]) || x[v] > std::max(p[v], q[v])) continue;
          if (arrangement::orient_along(axis_, {p}, {q}, mesh_.place(*at + 3)) != 0) continue;
          inside.emplace_back(dot(x - p, q - p), *at);
        }
        std::sort(inside.begin(), inside.end());
        for (const auto& [along, n] : inside) found.push_back(n);
      }
      if (!found.empty()) made.between[side][line.edge] = std::move(found);
    }
  }

  const PeriodicCell& cell_;
  const int axis_;
  const std::array<std::vector<Line>, 2>& lines_;
  PlaneMesh mesh_;
  VerticesByPlace node_;  ///< of the division
};

}  // namespace

CommonDivision divide_alike(const SurfaceMesh& surface, const PeriodicCell& cell, int axis,
                            const std::array<FaceParts, 2>& faces, double tolerance) {
  std::array<std::vector<Line>, 2> lines{lines_of(surface, cell, axis, faces[0]),
                                         lines_of(surface, cell, axis, faces[1])};
  const std::array ends{ends_of(lines[0]), ends_of(lines[1])};
  bend_over(lines[0], ends[1], tolerance), bend_over(lines[1], ends[0], tolerance);
  std::vector<Vec3> points;
  for (const FaceParts& face : faces)
    for (const VertexIndex v : face.touched) points.push_back(seen_at_low(surface.points[v], cell, axis));
  return Divider(cell, axis, lines).run(static_cast<std::uint32_t>(faces[0].first.size()), points);
}

}  // namespace octafront::periods
