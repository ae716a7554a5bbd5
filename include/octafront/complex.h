#pragma once

#include <octafront/error.h>
#include <octafront/run_context.h>
#include <octafront/surface_mesh.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace octafront {

// From triangles as files have them to a complex of several regions (SurfaceMesh::sides). The cells into which the
// triangles divide space are found exactly; triangles that cross are divided where they do.

/// A region by a point in it.
struct RegionSeed {
  std::string name;
  Vec3 at;
};

/// How cells become regions.
struct ComplexOptions {
  std::vector<RegionSeed> regions;  ///< the cells of seeds with one name are one region
  std::vector<Vec3> voids;          ///< the cells of these points stay empty
  /// kAuto: every filled cell of a surface with inner walls is a region; without them all are one, also where it
  /// touches itself in edges and vertices. What the walls wind around is filled, else what they nest an odd number of
  /// times. kRegions: every enclosed cell, also where walls are doubled or cross. kMerge: all together are one region.
  enum class Cells { kAuto, kRegions, kMerge };
  Cells cells = Cells::kAuto;
  /// Closed shells inside others. kByDirection: a shell that faces inward is a cavity, one that faces outward a region.
  /// kRegion: whatever is enclosed is filled.
  enum class Nested { kByDirection, kCavity, kRegion };
  Nested nested = Nested::kByDirection;
  /// What bodies share where they overlap. kAuto: of several bodies the later one has it, parts of one file are united,
  /// solids of a CAD file are refused where it is no fit. kFirst, kLater: the first or the later body has it. kNew: it
  /// is a region of its own, "a&b".
  enum class Overlap { kAuto, kFirst, kLater, kNew };
  Overlap overlap = Overlap::kAuto;
  /// Of several bodies: walls nearer to each other than this are one; input units, >= 0. Without a value what facets of
  /// curved walls explain, or a part of the size of elements. 0: exactly as they are (docs/use/complex-input.md).
  std::optional<double> tolerance;
  /// Of several bodies: the first one is a cell, and what lies outside of it is left out.
  bool within_first = false;
};

/// A complex and what was done to get it.
struct Complex {
  SurfaceMesh surface;          ///< with sides and names of regions; `source` counts the faces of all inputs through
  std::vector<double> volumes;  ///< per region
  std::vector<std::string> notes;
};

/// Regions that should be apart, or inside, are joined through a hole between the walls.
class LeakError : public InputError {
 public:
  LeakError(const std::string& what, std::vector<Vec3> through) : InputError(what), way(std::move(through)) {}
  std::vector<Vec3> way;  ///< a polygon from one to the other that goes through no wall
};

/// The complex of the walls of one surface; nullopt if the surface is a plain one, without inner walls: one body or
/// several, with cavities or without, that touch nothing; also one that is open or crosses itself, as repair says
/// later. Faces with the same region on both sides stay as sheets. A surface with sides is a complex already, and the
/// options only name and empty its regions. Throws InputError, LeakError, Cancelled.
std::optional<Complex> complex_of_walls(const SurfaceMesh& surface, const ComplexOptions& options = {},
                                        const RunContext& context = {});

/// One of several bodies.
struct Body {
  std::string name;     ///< of its region
  SurfaceMesh surface;  ///< closed, free of self-intersections, after repair; patches keep their names
};

/// The bodies of one surface, by names of patches, in their order: a patch that is closed by itself is a body; of the
/// others what hangs together is one, with the name of the patch that has most of its faces. Parts of one name are one
/// body, patches without one are `part_1` by their number.
std::vector<Body> bodies_by_name(const SurfaceMesh& surface);

/// The complex of several bodies: where they touch they share faces, what they share where they overlap
/// goes as the options say, and gaps below the tolerance close: vertices of later bodies move onto earlier ones. Seeds
/// name and empty what no body fills. A body of which others leave nothing is refused. Throws InputError, with the name
/// of the body at fault; Cancelled.
Complex join_bodies(const std::vector<Body>& bodies, const ComplexOptions& options = {},
                    const RunContext& context = {});

/// What a clean surface or complex divides space into, but for the outside around all.
struct BoundedSpaces {
  std::uint32_t filled = 0;    ///< within regions; a space ends at walls
  std::uint32_t cavities = 0;  ///< enclosed by walls, and of no region
};
/// Cavities count also where their walls touch others in edges and vertices. Throws InputError where a piece is so thin
/// that no double lies inside; Cancelled. Cost: O(n log n).
BoundedSpaces bounded_spaces(const SurfaceMesh& clean, const RunContext& context = {});

/// A thin tube along a polygon, to look at; its radius is a fraction of the polygon's extent.
SurfaceMesh tube_along(const std::vector<Vec3>& way);

}  // namespace octafront
