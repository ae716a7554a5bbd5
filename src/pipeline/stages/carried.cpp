#include <octafront/adapt.h>
#include <octafront/carry.h>

#include <utility>

namespace octafront {

MeshField carried(const MeshField& field, const TetMesh& before, const TetMesh& now,
                  std::span<const VertexIndex> old_of_new, std::span<const TetIndex> old_tet_of_new) {
  const KnownItems same{old_of_new, old_tet_of_new};
  return std::move(carry_fields({&field, 1}, before, now, {}, {}, OutsideNodes::kOnwards, &same).fields.front());
}

MeshField carried(const MeshField& field, const TetMesh& before, const AdaptedMesh& adapted) {
  return carried(field, before, adapted.mesh, adapted.old_of_new, adapted.old_tet_of_new);
}

}  // namespace octafront
