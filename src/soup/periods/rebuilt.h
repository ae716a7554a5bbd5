#pragma once

// What both ways to make faces the same have in common: triangles divided at their edges, surfaces rebuilt, names.

#include <octafront/surface_mesh.h>

#include "base/mesh/periodic_cell.h"
#include "soup/periods/periods.h"

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

namespace octafront::periods {

/// What a triangle of the surface is, beside its corners.
struct FaceKind {
  std::uint32_t patch;
  Sides sides;
  std::uint32_t origin;
  CellFace face;  ///< where it is known
};

/// New triangles of a surface, of which nothing is read any more.
struct Rebuilt {
  std::vector<Triangle> triangles;
  std::vector<FaceKind> kinds;
  void add(const Triangle& t, const FaceKind& kind) { triangles.push_back(t), kinds.push_back(kind); }
};

/// Patches and sides for all triangles, where there are none.
void fill_in(SurfaceMesh& surface);

/// Adds a triangle divided where its edges have vertices between their ends: from the lower end of the edge on.
void add_divided(const Triangle& t, const FaceKind& kind, const std::map<Edge, std::vector<VertexIndex>>& between,
                 Rebuilt& to);

/// The surface gets these triangles; points without any go.
void take(Rebuilt rebuilt, SurfaceMesh& surface);

/// Each face of the cell gets patches of its own, and each of these one copy.
void name_faces(SurfaceMesh& surface, const PeriodicCell& cell);

/// Runs `make`, which fills in sides and numbers triangles anew; the surface is plain after it if it was before, and
/// keeps its sources.
MadePeriodic made_of(SurfaceMesh& surface, const std::function<MadePeriodic()>& make);

}  // namespace octafront::periods
