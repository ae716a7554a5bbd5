#pragma once

// improve/schedule: better elements in the same body. Takes a valid tetrahedral mesh, leaves a valid one: vertices
// have moved, edges and faces have been exchanged; those of the boundary only where the surface is given on which
// they may. Single passes are in passes.h, their order in schedule.cpp, what an element is worth in shape.h, the mesh
// they work on in edit_mesh.h, how a mesh is divided among those who work on it in mesh_of_pieces.h. What is flat even
// then gets room off the surface, at the very end: raise_flat.h.

#include <octafront/options.h>
#include <octafront/tet_mesh.h>

#include "base/core/stage.h"
#include "improve/schedule/mesh_of_pieces.h"
#include "improve/shape/boundary_input.h"

namespace octafront {

/// Makes the elements of a valid mesh better, by the schedule of options.level. Without `input` the boundary does
/// not change, and is the user's own. With it, and unless options.move_boundary is off, vertices of the boundary slide
/// along the surface or curve that they lie on, corners stay, and edges inside patches may turn; the boundary stays as
/// near to the input as it was (see BoundaryGuide::keeps_truth), free of self-intersections (exactly), with the same
/// number of triangles, each of the same patch, unless the input has a tolerance: see edit_boundary(). All that hangs
/// on the mesh stays with what it belongs to (KeptLabels); of sets of faces and of curves on a boundary that may change
/// the borders and ends must be features of the input. Elements that must not change need a mesh whose boundary stays.
/// No pass makes the worst element worse, and none inverts one (exact signs). On an exception the mesh is lost. Throws
/// OptionError, Cancelled, and MeshingError if the faces of the mesh do not match. The report gets, for each kind of
/// pass, the places looked at and those changed, in all pieces. Returns true if the boundary changed; `features`, where
/// given, then become those of the new boundary, in its numbering (they may be input->of_mesh). `tets`: what of them
/// each of several ranks gives, and gets back. `before_stage` is for tests: where the elements are kept changes
/// nothing.
bool improve_mesh(TetMesh& mesh, const improve::BoundaryInput* input, const ImproveOptions& options, const Stage& stage,
                  Features* features = nullptr, Tets tets = Tets::kAll,
                  const improve::MeshOfPieces::BeforeStage& before_stage = {});

/// After the boundary or interfaces of a valid mesh were moved: passes against poor elements, from the first one below
/// a beta or dihedral angle of comfort on; what was moved stays. The mesh is untouched if there is no such element.
void relieve_mesh(TetMesh& mesh, const ImproveOptions& options, const Stage& stage);

}  // namespace octafront
