#include "mend/skin.h"

#include "core/parallel.h"
#include "core/stage.h"
#include "geometry/measures.h"
#include "geometry/winding_number.h"
#include "mend/min_cut.h"
#include "mesh/face_table.h"
#include "recovery/recover.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace octafront::mend {
namespace {

double area_of(const std::vector<Vec3>& points, const Triangle& t) {
  return triangle_area(points[t[0]], points[t[1]], points[t[2]]);
}

/// Keeps the points that triangles use, in their order.
void drop_unused_points(Skin& skin) {
  std::vector<VertexIndex> number(skin.points.size(), kNone);
  for (const Triangle& t : skin.triangles)
    for (const VertexIndex v : t) number[v] = 0;
  VertexIndex kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kNone) continue;
    skin.points[kept] = skin.points[v];
    number[v] = kept++;
  }
  skin.points.resize(kept);
  for (Triangle& t : skin.triangles)
    for (VertexIndex& v : t) v = number[v];
}

/// A closed box around everything, at this part of the diagonal, behind the points.
constexpr double kBoxMargin = 0.1;

SurfaceMesh boxed_walls(const Arrangement& arranged) {
  SurfaceMesh all;
  all.points = arranged.points;
  all.triangles = arranged.triangles;
  all.sides.assign(all.triangles.size(), Sides{0, 0});
  Box3 box = bounding_box(all.points);
  const double margin = kBoxMargin * box.diagonal();
  box.lo -= Vec3{margin, margin, margin};
  box.hi += Vec3{margin, margin, margin};
  const auto first = static_cast<VertexIndex>(all.points.size());
  for (int c = 0; c < 8; ++c)
    all.points.push_back({c & 1 ? box.hi.x : box.lo.x, c & 2 ? box.hi.y : box.lo.y, c & 4 ? box.hi.z : box.lo.z});
  constexpr std::array<std::array<VertexIndex, 4>, 6> kFaces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& [a, b, c, d] : kFaces)
    for (const Triangle t : {Triangle{a, b, c}, Triangle{a, c, d}}) {
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      all.sides.push_back({kNone, 0});
    }
  return all;
}

/// The walls as they wind: as often as they lie there forward more than backward; all turned if they enclose less than
/// nothing.
SurfaceMesh winding_walls(const Arrangement& arranged) {
  SurfaceMesh walls;
  walls.points = arranged.points;
  for (std::size_t t = 0; t < arranged.triangles.size(); ++t) {
    int net = 0;
    for (const Origin& o : arranged.origins_of(t)) net += o.reversed ? -1 : 1;
    const auto [a, b, c] = arranged.triangles[t];
    for (int i = 0; i < std::abs(net); ++i) walls.triangles.push_back(net > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
  }
  const Vec3 center = bounding_box(walls.points).center();
  double volume = 0;
  for (const auto& [a, b, c] : walls.triangles)
    volume += signed_volume(center, walls.points[a], walls.points[b], walls.points[c]);
  if (volume < 0)
    for (Triangle& t : walls.triangles) std::swap(t[1], t[2]);
  return walls;
}

/// The division of space and its cut.
class TetCut {
 public:
  TetCut(const Arrangement& arranged, const RunContext& context) : arranged_(arranged), context_(context) {}

  Skin skin() {
    StageReport counts;
    mesh_ = recover_volume(boxed_walls(arranged_), {context_, counts});
    find_windings();
    cut();
    return between();
  }

 private:
  struct Face {
    std::uint32_t tet, other;  ///< other: kNone at the box
    std::uint32_t wall;        ///< kNone: none
    Triangle corners;          ///< seen from `other` counter-clockwise
  };

  template <class Visit>
  void for_each_face(const Visit& visit) const {
    const auto tets = static_cast<std::uint32_t>(mesh_.tets.size());
    const FaceTable table(mesh_.points.size(), [&](const auto& add) {
      for (std::uint32_t t = 0; t < tets; ++t)
        for (int i = 0; i < 4; ++i) add(face_of(mesh_.tets[t], i), 4 * t + static_cast<std::uint32_t>(i));
      for (std::uint32_t w = 0; w < arranged_.triangles.size(); ++w) add(arranged_.triangles[w], 4 * tets + w);
    });
    table.for_each_group([&](const Triangle&, std::span<const FaceTable::Entry> group) {
      const std::uint32_t h = group[0].face;
      if (h >= 4 * tets) return;
      Face face{h / 4, kNone, kNone, face_of(mesh_.tets[h / 4], static_cast<int>(h % 4))};
      for (const FaceTable::Entry& entry : group.subspan(1))
        (entry.face < 4 * tets ? face.other : face.wall) =
            entry.face < 4 * tets ? entry.face / 4 : entry.face - 4 * tets;
      visit(face);
    });
  }

  void find_windings() {
    const WindingNumber around(winding_walls(arranged_));
    winding_.resize(mesh_.tets.size());
    parallel_for(winding_.size(), [&](std::size_t t) {
      const auto [a, b, c, d] = mesh_.tets[t];
      winding_[t] = around.at(centroid(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]));
    });
  }

  void cut() {
    MinCut cut(mesh_.tets.size());
    std::vector<double> area(mesh_.tets.size(), 0);
    std::vector<char> at_box(mesh_.tets.size(), 0);
    for_each_face([&](const Face& f) {
      const double size = area_of(mesh_.points, f.corners);
      area[f.tet] += size;
      if (f.other == kNone) {
        at_box[f.tet] = 1;
        return;
      }
      area[f.other] += size;
      cut.add_edge(f.tet, f.other, f.wall == kNone ? size : kWall * size);
    });
    const double all = squared_length(bounding_box(mesh_.points).extent());
    for (std::uint32_t t = 0; t < area.size(); ++t) {
      const double lean = std::clamp(winding_[t] - 0.5, -0.5, 0.5);
      if (at_box[t])
        cut.add_node_cost(t, 0, 10 * all);
      else if (lean > 0)
        cut.add_node_cost(t, kLean * lean * area[t], 0);
      else
        cut.add_node_cost(t, 0, -kLean * lean * area[t]);
    }
    inside_ = cut.on_source_side();
  }

  Skin between() const {
    Skin skin;
    skin.points = mesh_.points;
    for_each_face([&](const Face& f) {
      const bool in = inside_[f.tet], other_in = f.other != kNone && inside_[f.other];
      if (f.wall != kNone) {
        skin.wall_area += area_of(mesh_.points, f.corners);
        if (!in && !other_in) skin.idle_area += area_of(mesh_.points, f.corners);
      }
      if (in == other_in) return;
      const auto [a, b, c] = f.corners;
      skin.triangles.push_back(in ? Triangle{a, b, c} : Triangle{a, c, b});
      skin.wall.push_back(f.wall);
    });
    drop_unused_points(skin);
    return skin;
  }

  /// A wall between inside and outside costs this part of what it costs to invent one.
  static constexpr double kWall = 0.01;
  /// What it costs to go against the winding number, against the area of the tetrahedron.
  static constexpr double kLean = 0.5;

  const Arrangement& arranged_;
  const RunContext& context_;
  TetMesh mesh_;
  std::vector<double> winding_;
  std::vector<char> inside_;
};

}  // namespace

Skin skin_of_cells(const Arrangement& arranged, const Cells& cells, const Labels& labels) {
  Skin skin;
  skin.points = arranged.points;
  for (std::uint32_t t = 0; t < arranged.triangles.size(); ++t) {
    const auto [front, back] = cells.sides_of(t);
    const double size = area_of(arranged.points, arranged.triangles[t]);
    skin.wall_area += size;
    if (!labels.inside[front] && !labels.inside[back]) skin.idle_area += size;
    if (labels.inside[front] == labels.inside[back]) continue;
    const auto [a, b, c] = arranged.triangles[t];
    skin.triangles.push_back(labels.inside[back] ? Triangle{a, b, c} : Triangle{a, c, b});
    skin.wall.push_back(t);
  }
  drop_unused_points(skin);
  return skin;
}

Skin skin_of_tets(const Arrangement& arranged, const RunContext& context) {
  return TetCut(arranged, context).skin();
}

}  // namespace octafront::mend
