#pragma once

#include <octafront/tet_mesh.h>

#include <optional>
#include <string>

namespace octafront {

struct SurfaceMesh;

/// How a valid mesh differs from the complex that it should fill, as a sentence: a triangle of one that the other
/// lacks, other regions on its sides, or regions that meet without an interface.
std::optional<std::string> difference_to_complex(const TetMesh& mesh, const SurfaceMesh& complex);

}  // namespace octafront
