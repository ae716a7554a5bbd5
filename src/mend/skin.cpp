#include "mend/skin.h"

#include "geometry/measures.h"
#include "mend/whole_faces.h"

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

}  // namespace

Skin skin_of_cells(const Arrangement& arranged, const std::vector<Triangle>& given, const Cells& cells,
                   const Labels& labels, const RunContext& context) {
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
  restore_whole_faces(arranged, given, skin, context);
  drop_unused_points(skin);
  return skin;
}

}  // namespace octafront::mend
