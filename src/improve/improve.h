#pragma once

// improve: better elements from the same boundary. Takes a valid tetrahedral mesh, leaves a valid one: vertices inside
// have moved, edges and faces inside have been exchanged. Single passes are in passes.h, their order in schedule.cpp,
// what an element is worth in shape.h, the mesh they work on in edit_mesh.h.

#include <octafront/options.h>
#include <octafront/report.h>
#include <octafront/run_context.h>
#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

namespace octafront {

/// Makes the elements of a valid mesh better, by the schedule of options.level. The boundary does not change; patches,
/// sources and regions stay with what they belong to. No pass makes the worst element worse, and none inverts one
/// (exact signs). `sizes` keeps edge lengths honest. On an exception the mesh is as it was. Throws OptionError,
/// Cancelled, and MeshingError if the faces of the mesh do not match. The report gets, for each pass, the places looked
/// at, those changed, and CPU time per element.
void improve_mesh(TetMesh& mesh, const SizeField& sizes, const ImproveOptions& options, const RunContext& context,
                  StageReport& report);

}  // namespace octafront
