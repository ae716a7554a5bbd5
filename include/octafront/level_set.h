#pragma once

#include <octafront/run_context.h>
#include <octafront/tet_mesh.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// A surface in a mesh: where the linear interpolant of values at its points is `level`.
struct LevelSet {
  std::string name;            ///< of the region where values are below the level
  std::vector<double> values;  ///< one per point; those of mid-side nodes have no say
  double level = 0;
};

struct LevelSetOptions {
  /// Pieces of a region that are smaller go to the region that they touch most; cubed input units, 0: none.
  double least_piece = 0;
};

/// What became of one level set.
struct LevelSetReport {
  std::string name;
  std::uint64_t moved = 0;      ///< points that went to the surface
  std::uint64_t divided = 0;    ///< edges that got a point on it
  std::uint64_t on = 0;         ///< that were taken for points of it: very near, and not to be moved
  std::uint64_t elements = 0;   ///< below the level
  double volume = 0;            ///< of them
  std::uint64_t triangles = 0;  ///< of its surface between regions
  double area = 0;              ///< of them
  std::uint64_t pieces = 0;     ///< parts of its region that do not touch in faces, before small ones went
  std::uint64_t dropped = 0;    ///< that went
};

struct CutMesh {
  TetMesh mesh;
  std::vector<LevelSetReport> level_sets;
};

/// As a JSON array, keys as the members above.
std::string to_json(const std::vector<LevelSetReport>& reports);

/// The mesh with each of the surfaces as faces of elements. What is below the level of the first level set is the
/// region of its name, what is below that of the second and not of the first the next one, and so on; the rest keeps
/// its region. Where there are several regions, each is divided, `NAME_inside` the part within. The surface between
/// regions is a patch, NAME_surface.
///
/// Points that are near to the surface along an edge go there where elements stay positive and sound (those of smooth
/// walls along these; on interfaces, curves and in sets of nodes none does); one that cannot, with the surface within a
/// tenth of an edge, is taken for a point of it. All edges that still cross it then get a point there, and elements are
/// divided from their lowest points, so neighbours match. Where rounding would turn an element around, a point near by
/// is taken for one on the surface, too. All elements are positive by
/// exact sign, all faces match (first_defect). Patches, curves, sets and names go along; what is second order becomes
/// linear. Elements at the surface may be as flat as chance makes them: adapt_to_metric() makes them sound, with the
/// surface kept.
///
/// Example: cut_along(mesh, {{"water", phi}}).
///
/// Throws InputError for a mesh that is not valid, or has wedges, pyramids, periods or split faces, or for values of
/// another number or that are not finite; OptionError for a name that is there or given twice, or that of no level set;
/// Cancelled.
CutMesh cut_along(const TetMesh& mesh, std::span<const LevelSet> level_sets, const LevelSetOptions& options = {},
                  const RunContext& context = {});

}  // namespace octafront
