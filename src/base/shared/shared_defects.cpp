#include "base/shared/shared_defects.h"

#include "base/mesh/face_table.h"
#include "base/mesh/mesh_share.h"
#include "base/shared/in_parts.h"
#include "base/shared/marks.h"
#include "base/shared/packing.h"
#include "base/shared/shared_tets.h"

#include <utility>
#include <vector>

namespace octafront {

namespace {

using Defect = std::optional<std::string>;

/// Of the first rank that has found one.
Defect first_among(const Comm& comm, const Defect& mine) {
  Packer to;
  to.add_text(mine.value_or(""));
  Defect first;
  comm.gather(to.bytes(), "defects").for_each([&](int, std::span<const std::byte> bytes) {
    std::string text = Unpacker(bytes).take_text();
    if (!first && !text.empty()) first = std::move(text);
  });
  return first;
}

MeshShare share_of(const TetMesh& mesh, const Comm& comm) {
  MeshShare share;
  share.first_tet = count_tets(mesh, comm).before;
  share.used_here = share.used_by_any = vertices_in_use(mesh);
  join_marks(comm, share.used_by_any, "vertices in use");
  share.used_by_several = marked_by_several(comm, share.used_here, "vertices at rims");
  return share;
}

/// Faces at rims go to the rank in whose range their least vertex is.
Defect rim_defect_here(const TetMesh& mesh, const MeshShare& share, const Comm& comm) {
  const auto ranks = static_cast<std::uint64_t>(comm.size()), points = static_cast<std::uint64_t>(mesh.points.size());
  const auto begin = [&](std::uint64_t rank) { return static_cast<VertexIndex>(points * rank / ranks); };
  std::vector<std::vector<RimFace>> out(ranks);
  for (const RimFace& f : rim_faces(mesh, share)) {
    std::uint64_t rank = face_key(f.corners)[0] * ranks / points;
    while (face_key(f.corners)[0] >= begin(rank + 1)) ++rank;
    out[rank].push_back(f);
  }
  std::vector<RimFace> all;
  exchange_in_parts(comm, std::move(out), "faces at rims",
                    [&](int, std::span<const RimFace> part) { all.insert(all.end(), part.begin(), part.end()); });
  const auto here = static_cast<std::uint64_t>(comm.rank());
  return rim_defect(mesh, share, all, begin(here), begin(here + 1));
}

/// Sums in the order of ranks.
RoundedSum volume_of_all(const TetMesh& mesh, const Comm& comm) {
  RoundedSum sum;
  for (const RoundedSum& part : gathered_lists(comm, std::vector<RoundedSum>{volume_of_tets(mesh)}, "volumes"))
    sum += part;
  return sum;
}

}  // namespace

Defect first_defect_of_shares(const TetMesh& mesh, const SurfaceMesh& surface, const RunContext& context,
                              const Comm& comm) {
  if (Defect defect = first_among(comm, indices_defect(mesh))) return defect;
  const MeshShare share = share_of(mesh, comm);
  if (Defect defect = first_among(comm, share_defect(mesh, share, context))) return defect;
  if (Defect defect = first_among(comm, rim_defect_here(mesh, share, comm))) return defect;
  if (Defect defect = volume_defect(mesh, volume_of_all(mesh, comm))) return defect;
  return difference_to(mesh, surface);
}

}  // namespace octafront
