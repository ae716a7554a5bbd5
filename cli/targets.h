#pragma once

#include <octafront/mesh_field.h>
#include <octafront/report.h>
#include <octafront/tet_mesh.h>

#include "session.h"

#include <span>
#include <string>
#include <vector>

namespace octafront::cli {

/// Refuses outputs of meshes that cannot be written, before any work. Throws OptionError, OutputError.
void check_mesh_targets(const Arguments& arguments);

/// Adds the groups that were asked for, but to a mesh that generate() made with them; writes the mesh to all outputs,
/// with fields to those that hold some, and says what was lost on the way. `told`: notes on it that stand with the
/// first output.
void write_mesh_targets(Session& session, const TetMesh& mesh, std::span<const MeshField> fields = {},
                        std::vector<std::string> told = {});

/// Whether ranks write their shares of a mesh by themselves: all outputs are .pvtu, and nothing asks for more.
bool takes_shares(const Arguments& arguments);
/// Writes them; called by all ranks.
void write_share_targets(Session& session, const TetMesh& share);

/// Whether an output holds fields on the mesh.
bool some_target_holds_fields(const Arguments& arguments);
/// Refuses outputs that surfaces alone are not written to. Throws OptionError.
void check_surface_targets(const Arguments& arguments);

/// Parts from CAD in elements of first order for a solver of structures: says in the report what second order is worth.
void recommend_second_order(const Arguments& arguments, Report& report);

/// To a file, or to standard output if it is called "-". Throws OutputError.
void write_text_target(const std::filesystem::path& file, const std::string& text);

}  // namespace octafront::cli
