#include "pipeline/stages/agreement.h"

#include <octafront/error.h>
#include <octafront/options.h>

#include "base/shared/comm.h"
#include "base/shared/hashing.h"
#include "pipeline/stages/stages.h"

namespace octafront {

namespace {

void hash_into(BytesHash& hash, const SurfaceMesh& surface) {
  hash.add(surface.points), hash.add(surface.triangles), hash.add(surface.patch), hash.add(surface.sides);
}

void hash_into(BytesHash& hash, const SizeField& sizes, const std::vector<Vec3>& points) {
  for (const Vec3& p : points) hash.add(sizes.at(p));
  hash.add(sizes.min_size()), hash.add(sizes.max_size());
}

void hash_into(BytesHash& hash, const TetMesh& mesh, Tets tets) {
  if (tets == Tets::kAll) hash.add(mesh.tets), hash.add(mesh.region);
  hash.add(mesh.points), hash.add(mesh.boundary), hash.add(mesh.patch);
  hash.add(mesh.interfaces), hash.add(mesh.interface_patch), hash.add(mesh.mid_nodes), hash.add(mesh.high_nodes);
}

/// hash_into(hash) only where somebody is to agree.
template <class HashInto>
void agree_by(const RunContext& context, const char* what, const HashInto& hash_all) {
  const Comm comm(context.ranks);
  if (comm.alone()) return;
  BytesHash hash;
  hash_all(hash);
  comm.agree(hash.value(), what);
}

}  // namespace

void refuse_for_ranks(const Options& options, const RunContext& context) {
  if (!Comm(context.ranks).alone() && options.improve.seconds)
    throw OptionError(
        "`seconds` hangs on the time that a machine takes, which is not the same on all ranks: leave it out");
}

void agree_on(const SurfaceMesh& surface, const char* what, const RunContext& context) {
  agree_by(context, what, [&](BytesHash& hash) { hash_into(hash, surface); });
}

void agree_on(const SizeField& sizes, const std::vector<Vec3>& points, const char* what, const RunContext& context) {
  agree_by(context, what, [&](BytesHash& hash) { hash_into(hash, sizes, points); });
}

void agree_on(const Filled& filled, const char* what, const RunContext& context) {
  agree_by(context, what, [&](BytesHash& hash) {
    hash_into(hash, filled.mesh, filled.tets), hash_into(hash, filled.boundary.surface);
    hash_into(hash, filled.boundary.sizes, filled.boundary.surface.points);
  });
}

}  // namespace octafront
