#pragma once

#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "base/shared/comm.h"

#include <optional>
#include <string>

namespace octafront {

/// first_defect() of a mesh of first order without curves whose tetrahedra are the shares of the ranks, numbered by
/// rank. All ranks get the same answer.
std::optional<std::string> first_defect_of_shares(const TetMesh& mesh, const SurfaceMesh& surface,
                                                  const RunContext& context, const Comm& comm);

}  // namespace octafront
