#pragma once

#include <octafront/complex.h>
#include <octafront/ids.h>
#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>
#include <octafront/vec.h>

#include <string>
#include <vector>

namespace octafront {

// What lies inside of bodies and is part of their mesh: sheets as faces, lines as edges, points as nodes.

/// A surface, open or closed, whose parts inside of a body become faces of the mesh: a crack, a fault, a membrane.
struct Sheet {
  std::string name;     ///< of its patch, or before those that it has
  SurfaceMesh surface;  ///< without sides; it may cross and touch itself, others, and walls
};

/// Lines that become edges of the mesh, and a curve: bars, wires, wells.
struct LineNet {
  std::string name;  ///< of the curve
  std::vector<Vec3> points;
  std::vector<Edge> edges;  ///< indices into points
};

/// Points that become nodes of the mesh, and a set of nodes.
struct PointSet {
  std::string name;
  std::vector<Vec3> points;
};

/// The complex of a clean surface, or complex, with sheets in it: regions stay what they are, and sheets are faces with
/// one region on both sides, divided where they cross each other and walls. What lies outside of all regions is cut
/// off, walls that a sheet lies on get its name; notes say how much that is. `options.tolerance`: vertices of sheets
/// that are nearer to walls than this come onto them; without a value a millionth of the surface's diagonal.
/// Throws InputError, which names the sheet of which nothing would be left; Cancelled.
Complex embed_sheets(const SurfaceMesh& surface, const std::vector<Sheet>& sheets, const ComplexOptions& options = {},
                     const RunContext& context = {});

}  // namespace octafront
