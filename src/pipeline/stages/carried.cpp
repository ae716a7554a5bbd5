#include <octafront/adapt.h>
#include <octafront/error.h>

#include "adapt/carry/carry.h"

#include <cmath>

#include <fmt/core.h>

namespace octafront {

MeshField carried(const MeshField& field, const TetMesh& before, const TetMesh& now,
                  std::span<const VertexIndex> old_of_new, std::span<const TetIndex> old_tet_of_new) {
  const std::size_t count = field.of_elements ? before.tets.size() : before.points.size();
  const char* what = field.of_elements ? "elements" : "vertices";
  if (field.components == 0 || field.values.size() != count * field.components)
    throw InputError(fmt::format("the field \"{}\" has {} values of {} components, and the mesh {} {}", field.name,
                                 field.values.size(), field.components, count, what));
  for (std::size_t i = 0; i < field.values.size(); ++i)
    if (!std::isfinite(field.values[i]))
      throw InputError(fmt::format("the field \"{}\" has the value {} at number {} of the {}", field.name,
                                   field.values[i], i / field.components, what));
  const adapt::Carrier carrier(before, now, old_of_new, old_tet_of_new);
  MeshField made{field.name, field.of_elements, field.components, {}};
  made.values = field.of_elements ? carrier.of_tets(field.values, field.components)
                                  : carrier.at_vertices(field.values, field.components);
  return made;
}

MeshField carried(const MeshField& field, const TetMesh& before, const AdaptedMesh& adapted) {
  return carried(field, before, adapted.mesh, adapted.old_of_new, adapted.old_tet_of_new);
}

}  // namespace octafront
