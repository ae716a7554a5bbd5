#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>
#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include <vector>

namespace octafront {

struct SurfaceMesh;

/// The tetrahedra of the lattice that lie deep inside a surface.
struct LatticeCore {
  std::vector<Vec3> points;
  std::vector<Tet> tets;  ///< positive; of several ranks each has some, those of rank 0 come first
  /// The boundary of all tets, each triangle counter-clockwise seen from within the core: joined to the surrounding
  /// surface, the skin bounds the shell that is left to fill. It may touch itself in edges and points, never cross.
  std::vector<Triangle> skin;
};

/// The lattice inside `surface`, by cells of the wanted size: its regular tetrahedra that do not touch the surface, no
/// corner nearer to it than kCoreClearance times the side of a cell. There are none between cells of different sizes,
/// and none where the surface is too narrow. REQUIRES a clean surface.
LatticeCore build_lattice_core(const SurfaceMesh& surface, const SizeField& sizes, const RunContext& context);

}  // namespace octafront
