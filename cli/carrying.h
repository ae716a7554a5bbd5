#pragma once

#include <octafront/carry.h>
#include <octafront/mesh_field.h>
#include <octafront/tet_mesh.h>

#include "session.h"

#include <vector>

namespace octafront::cli {

/// Fields of the file that a mesh was read from that are to go along, by --carry. Without it all there are, as far as
/// an output holds fields. Throws OptionError, InputError for what was asked for and cannot go.
std::vector<MeshField> fields_to_carry(Session& session, const TetMesh& mesh);

/// The same fields on the mesh that was made of theirs; the report is told of them. `same`: null: not known.
std::vector<MeshField> carried_fields(Session& session, const std::vector<MeshField>& fields, const TetMesh& before,
                                      const TetMesh& now, OutsideNodes outside, const KnownItems* same = nullptr);

}  // namespace octafront::cli
