#include "base/core/renumber.h"
#include "base/geometry/measures.h"
#include "soup/mend/mend_steps.h"

namespace octafront::mend {
Skin skin_of_cells(const Arrangement& arranged, const std::vector<Triangle>& given, const Cells& cells,
                   const Labels& labels, const RunContext& context) {
  Skin skin;
  skin.points = arranged.points;
  for (std::uint32_t t = 0; t < arranged.triangles.size(); ++t) {
    const auto [front, back] = cells.sides_of(t);
    const double size = triangle_area(arranged.points, arranged.triangles[t]);
    skin.wall_area += size;
    if (!labels.inside[front] && !labels.inside[back]) skin.idle_area += size;
    if (labels.inside[front] == labels.inside[back]) continue;
    const auto [a, b, c] = arranged.triangles[t];
    skin.triangles.push_back(labels.inside[back] ? Triangle{a, b, c} : Triangle{a, c, b});
    skin.wall.push_back(t);
  }
  restore_whole_faces(arranged, given, skin, context);
  drop_unused_points(skin.points, skin.triangles);
  return skin;
}

}  // namespace octafront::mend
