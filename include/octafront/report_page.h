#pragma once

#include <octafront/no_context.h>
#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include <string>

namespace octafront {

/// A web page that shows a mesh in 3D, and what a report says of it: one file, which opens without a network in any
/// browser of 2023 or later (WebGL 2, DecompressionStream). docs/use/report.md says what is in it, and how it is
/// packed.
///
/// `report` is a JSON object as `octafront --json` writes it, or to_json(); what it lacks is not shown. `sizes`, which
/// may be null, are those that the mesh was made to: then elements can be coloured by their size against them. Points
/// are rounded to a two-thousandth of the shortest edge. Elements of second order are drawn by their corners.
///
/// Names of files, regions and patches may hold anything: they are shown as text. Some 11 bytes an element.
/// Requires indices in range. Throws OptionError if `report` is no JSON object, Cancelled.
std::string report_page(const TetMesh& mesh, const SizeField* sizes, const std::string& report,
                        const RunContext& context = no_context());

}  // namespace octafront
