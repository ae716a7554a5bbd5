#include <octafront/error.h>

#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "periodic/face_maker.h"
#include "periodic/face_names.h"
#include "periodic/make_periodic.h"
#include "periodic/map_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

using periods::FaceKind;
using periods::FaceMaker;
using periods::FaceParts;
using periods::Rebuilt;
using periods::VerticesAlong;

/// A new vertex on a line that two faces share comes to others with the next round.
constexpr int kMostMapRounds = 6;
/// A face is flat where no vertex is farther from its plane than this part of the diagonal.
constexpr double kFlat = 1e-9;

/// The lines at which parts of a face end, and walls that end on it.
struct FaceLines {
  std::vector<std::uint32_t> triangles;
  std::set<Edge> edges;
  std::set<VertexIndex> vertices;
};

class MapMaker : FaceMaker {
 public:
  MapMaker(SurfaceMesh& surface, const std::vector<AskedMap>& asked, const RunContext& context)
      : FaceMaker(surface, context) {
    double largest = 0;
    for (const Vec3 p : surface.points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    std::vector<PeriodicMap> maps;
    for (const AskedMap& map : asked) maps.push_back(map.map);
    made_.cell = mapped_cell(maps, largest);
    face_ = periods::mapped_faces(surface, cell(), asked, tolerance_);
  }

  MadePeriodic run() {
    put_on_grid();
    bool changed = true;
    for (int round = 0; changed; ++round) {
      if (round == kMostMapRounds)
        throw InputError("`periodic`: the maps do not lead the lines of the faces back onto each other");
      changed = false;
      for (int k = 0; k < cell().periods(); ++k) changed = match(k) || changed;
    }
    for (int k = 0; k < cell().periods(); ++k) describe(k);
    return made();
  }

 private:
  const PeriodicMap& map_of(int k) const { return cell().mapped[static_cast<std::size_t>(k)].map; }
  bool is_low(CellFace face) const { return face != kNone && face % 2 == 0; }

  /// Vertices of faces near the axis of a rotation lie on it, those of low faces on the grid.
  void put_on_grid() {
    for (std::uint32_t t = 0; t < face_.size(); ++t) {
      if (face_[t] == kNone) continue;
      for (const VertexIndex v : surface_.triangles[t]) {
        Vec3 p = map_of(static_cast<int>(face_[t] / 2)).onto_axis(surface_.points[v], tolerance_);
        if (is_low(face_[t]) || p != surface_.points[v]) p = cell().on_grid(p);
        move(surface_.points[v], p);
      }
    }
  }

  FaceLines lines_of(CellFace face) const {
    std::vector<std::uint8_t> on_face(surface_.points.size(), 0);
    for (std::uint32_t t = 0; t < face_.size(); ++t)
      for (const VertexIndex v : surface_.triangles[t]) on_face[v] |= face_[t] == face;
    FaceParts parts = periods::parts_of_face(
        surface_, [&](std::uint32_t t) { return face_[t] == face; }, [&](VertexIndex v) { return on_face[v] != 0; });
    FaceLines lines{std::move(parts.triangles), {}, {parts.touched.begin(), parts.touched.end()}};
    for (const auto& [edge, part] : parts.lines) {
      lines.edges.insert(edge);
      lines.vertices.insert(edge.begin(), edge.end());
    }
    return lines;
  }

  /// Makes the high face of a period the copy of the low one. Returns whether something changed.
  bool match(int k) {
    context_.check();
    const CellFace low = 2 * static_cast<CellFace>(k);
    std::array lines{lines_of(low), lines_of(low + 1)};
    for (CellFace end = 0; end < 2; ++end)
      if (lines[end].triangles.empty())
        throw InputError(fmt::format("`periodic`: the map {} leads from or to nothing: there is no face {}",
                                     map_of(k).in_words(), name_of_face(cell(), low + end)));
    const bool divided = divide_lines(k, lines);
    if (divided) lines = {lines_of(low), lines_of(low + 1)};
    const std::map<VertexIndex, VertexIndex> copy_of = bring_together(k, lines);
    require_same_lines(k, lines, copy_of);
    if (!divided && are_same(k, lines[0].triangles, lines[1].triangles)) return false;
    copy_triangles(k, lines, copy_of);
    return true;
  }

  Vec3 led(Vec3 p, int k, int end) const { return end == 0 ? map_of(k).apply(p) : map_of(k).undo(p); }

  /// The vertices of one face by the nearest ones of the other, within the tolerance; kNone where there is none.
  std::map<VertexIndex, VertexIndex> nearest_on_other(int k, const std::array<FaceLines, 2>& lines, int end) const {
    const std::set<VertexIndex>& others = lines[static_cast<std::size_t>(1 - end)].vertices;
    const VerticesAlong there(surface_.points, {others.begin(), others.end()}, 0);
    std::map<VertexIndex, VertexIndex> nearest;
    for (const VertexIndex v : lines[static_cast<std::size_t>(end)].vertices)
      nearest[v] = there.nearest(led(surface_.points[v], k, end), tolerance_);
    return nearest;
  }

  /// Where a line of one face has a vertex and that of the other has none, it gets one.
  bool divide_lines(int k, const std::array<FaceLines, 2>& lines) {
    std::map<Edge, std::vector<std::pair<double, VertexIndex>>> on;
    for (int end = 0; end < 2; ++end) {
      const std::vector<Edge> edges(lines[static_cast<std::size_t>(1 - end)].edges.begin(),
                                    lines[static_cast<std::size_t>(1 - end)].edges.end());
      const TriangleTree tree = tree_of_segments(surface_.points, edges);
      for (const auto& [v, other] : nearest_on_other(k, lines, end)) {
        if (other != kNone) continue;
        const Vec3 p = led(surface_.points[v], k, end);
        const TriangleTree::Nearest at = tree.nearest(p, tolerance_ * tolerance_);
        if (at.triangle == kNone) refuse(k, end, surface_.points[v]);
        const Edge& edge = edges[at.triangle];
        const Vec3 a = surface_.points[edge[0]], b = surface_.points[edge[1]];
        on[edge].emplace_back(dot(p - a, b - a), static_cast<VertexIndex>(surface_.points.size()));
        surface_.points.push_back(end == 0 ? p : cell().on_grid(p));
      }
    }
    if (on.empty()) return false;
    std::map<Edge, std::vector<VertexIndex>> between;
    for (auto& [edge, vertices] : on) {
      std::sort(vertices.begin(), vertices.end());
      for (const auto& [along, v] : vertices) between[edge].push_back(v);
    }
    Rebuilt to;
    for (std::uint32_t t = 0; t < face_.size(); ++t)
      periods::add_divided(surface_.triangles[t], kind_of(t), between, to);
    take(std::move(to));
    return true;
  }

  /// Vertices of lines of the high face become the copies of those of the low one.
  std::map<VertexIndex, VertexIndex> bring_together(int k, const std::array<FaceLines, 2>& lines) {
    std::map<VertexIndex, VertexIndex> copy_of;
    std::set<VertexIndex> taken;
    for (const auto& [v, copy] : nearest_on_other(k, lines, 0)) {
      if (copy == kNone || !taken.insert(copy).second) refuse(k, 0, surface_.points[v]);
      copy_of[v] = copy;
    }
    for (const VertexIndex v : lines[1].vertices)
      if (!taken.contains(v)) refuse(k, 1, surface_.points[v]);
    for (const auto& [v, copy] : copy_of)
      if (v != copy) move(surface_.points[copy], map_of(k).apply(surface_.points[v]));
    return copy_of;
  }

  void require_same_lines(int k, const std::array<FaceLines, 2>& lines,
                          const std::map<VertexIndex, VertexIndex>& copy_of) const {
    std::set<Edge> led_there;
    for (const Edge& e : lines[0].edges) {
      const Edge copy = sorted_edge(copy_of.at(e[0]), copy_of.at(e[1]));
      if (!lines[1].edges.contains(copy)) refuse(k, 0, (surface_.points[e[0]] + surface_.points[e[1]]) * 0.5);
      led_there.insert(copy);
    }
    for (const Edge& e : lines[1].edges)
      if (!led_there.contains(e)) refuse(k, 1, (surface_.points[e[0]] + surface_.points[e[1]]) * 0.5);
  }

  void copy_triangles(int k, const std::array<FaceLines, 2>& lines, std::map<VertexIndex, VertexIndex> copy_of) {
    std::vector<Triangle> old;
    for (const std::uint32_t t : lines[1].triangles) old.push_back(surface_.triangles[t]);
    const TriangleTree models(surface_.points, old);
    Rebuilt to;
    for (std::uint32_t t = 0; t < face_.size(); ++t)
      if (face_[t] != 2 * static_cast<CellFace>(k) + 1) to.add(surface_.triangles[t], kind_of(t));
    for (const std::uint32_t t : lines[0].triangles) {
      Triangle copy{};
      for (int i = 0; i < 3; ++i) {
        const auto [at, is_new] =
            copy_of.try_emplace(surface_.triangles[t][i], static_cast<VertexIndex>(surface_.points.size()));
        if (is_new) surface_.points.push_back(map_of(k).apply(surface_.points[at->first]));
        copy[i] = at->second;
      }
      const Vec3 a = surface_.points[copy[0]], b = surface_.points[copy[1]], c = surface_.points[copy[2]];
      const std::uint32_t model = models.nearest(centroid(a, b, c)).triangle;
      const TriangleCorners& m = models.corners(model);
      if (dot(double_area_normal(a, b, c), double_area_normal(m[0], m[1], m[2])) < 0) std::swap(copy[1], copy[2]);
      to.add(copy, kind_of(lines[1].triangles[model]));
    }
    made_.imprinted += lines[0].triangles.size();
    take(std::move(to));
  }

  /// What the cell knows of its faces: where they are, and whether they are flat.
  void describe(int k) {
    MappedFaces& faces = made_.cell.mapped[static_cast<std::size_t>(k)];
    for (CellFace end = 0; end < 2; ++end) {
      std::vector<Triangle> on;
      for (std::uint32_t t = 0; t < face_.size(); ++t)
        if (face_[t] == 2 * static_cast<CellFace>(k) + end) on.push_back(surface_.triangles[t]);
      faces.on[end] = std::make_shared<const TriangleTree>(surface_.points, on);
      if (end == 1) continue;
      Vec3 largest;
      for (const Triangle& t : on) {
        const Vec3 n = double_area_normal(surface_.points[t[0]], surface_.points[t[1]], surface_.points[t[2]]);
        if (squared_length(n) > squared_length(largest)) largest = n;
      }
      faces.normal = normalized(largest);
      faces.is_flat = std::all_of(on.begin(), on.end(), [&](const Triangle& t) {
        return std::all_of(t.begin(), t.end(), [&](VertexIndex v) {
          return std::abs(dot(surface_.points[v] - surface_.points[on[0][0]], faces.normal)) <= kFlat * diagonal_;
        });
      });
    }
  }

  [[noreturn]] void refuse(int k, int end, Vec3 at) const {
    const CellFace has = 2 * static_cast<CellFace>(k) + static_cast<CellFace>(end);
    throw InputError(fmt::format(
        "the map {} does not lead the faces onto each other: {} has a line at {} that {} has not at {}. Both must have "
        "the same outline, and the same lines where walls and patches end on them",
        map_of(k).in_words(), name_of_face(cell(), has), at_point(at), name_of_face(cell(), has ^ 1u),
        at_point(led(at, k, end))));
  }
};

}  // namespace

MadePeriodic make_periodic(SurfaceMesh& surface, const std::vector<AskedMap>& maps, const RunContext& context) {
  return MapMaker(surface, maps, context).run();
}

}  // namespace octafront
