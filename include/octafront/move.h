#pragma once

#include <octafront/carry.h>
#include <octafront/mesh_field.h>
#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/tet_mesh.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// One step of a motion.
struct MoveStep {
  double fraction = 0;  ///< of the whole motion that is done after it
  /// What was done with the mesh after it: "moved" alone, "improved" (the boundary stays), "adapted" (to the lengths
  /// that it had) or "remeshed" (anew, from its walls).
  std::string change;
  std::uint64_t elements = 0;
  double beta_min = 0, beta_mean = 0, volume = 0;
};

/// A mesh that was moved, and what was known on it.
struct MovedMesh {
  TetMesh mesh;
  std::vector<MeshField> fields;  ///< those given, on it
  std::vector<MoveStep> history;
  std::vector<std::string> notes;    ///< what was lost
  std::vector<FieldReport> carried;  ///< of each field: before the motion, on the mesh that was given, and after it
};

/// As a JSON array of steps, keys as the members above.
std::string to_json(const std::vector<MoveStep>& history);

/// Moves every point of a mesh by its displacement, in steps as long as elements stay positive, by exact sign, and
/// their least beta above half of options.move.least_quality. Where after a step elements are poorer than that quality,
/// the mesh is improved inside its boundary, and where that is not enough adapted to the lengths that it had at each of
/// its places: splits, collapses, swaps, walls on the smooth surface that they stand for; in each step, and to the
/// length options.size.size, if that is given. Where that is not enough
/// either, or options.move.remesh asks for it, the walls that moved are meshed anew by generate(). What is left of the
/// displacement, and fields at points, go along linear, fields of elements stay with their elements and are carried as
/// carry_fields() does. Patches, regions, curves, sets and names go along; curves and sets of elements not where it is
/// meshed anew. A mesh with wedges, pyramids or pairs is improved at most; periods move with their pairs.
///
/// With options.move.boundary_alone displacements inside have no say: each component there is harmonic, of linear
/// elements, again in each step.
///
/// Throws InputError for a mesh that is not valid, or has split faces, for displacements that are not as many as the
/// points or not finite, or that differ between copies of a periodic mesh; MeshingError where the body would touch
/// itself (the place, and the largest part of the motion that is possible, to a thousandth; looked for each time that
/// something went by the length of an edge, 200 times a step at most), or where elements cannot follow; Cancelled. The
/// same for any number of threads.
MovedMesh move_mesh(const TetMesh& mesh, std::span<const Vec3> displacement, std::span<const MeshField> fields = {},
                    const Options& options = {}, const RunContext& context = {});

}  // namespace octafront
