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

/// All fields of the file that a mesh was read from, as far as an output holds fields.
std::vector<MeshField> all_fields(Session& session, const TetMesh& mesh);
/// Of a mesh that got another order: fields at points have values at its corners, and go where it has more nodes, which
/// a note says.
void keep_fields_of_corners(Session& session, std::vector<MeshField>& fields, std::size_t corners, std::size_t nodes);

/// The report gets what became of fields.
void tell_fields(Session& session, const std::vector<FieldReport>& fields);

}  // namespace octafront::cli
