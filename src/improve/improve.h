#pragma once

#include <octafront/options.h>
#include <octafront/report.h>
#include <octafront/run_context.h>
#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

namespace octafront {

/// Makes the elements of a valid mesh better, by the schedule of options.level. The boundary does not change. No pass makes
/// the worst element worse, and none inverts one (exact signs). `sizes` keeps edge lengths honest.
void improve_mesh(TetMesh& mesh, const SizeField& sizes, const ImproveOptions& options, const RunContext& context,
                  StageReport& report);

}  // namespace octafront
