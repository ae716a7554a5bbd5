#pragma once

// pipeline/inside: lines and points inside of a body. Takes them, sizes and the walls around; leaves fins, small sheets
// that stand on them, with which a mesh is made as with any sheet: so lines are edges and points nodes of it. Takes the
// fins out of the mesh again, and leaves curves and sets of nodes.

#include <octafront/inside.h>
#include <octafront/options.h>
#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include "base/geometry/triangle_tree.h"
#include "base/mesh/known_surface.h"

#include <string>
#include <vector>

namespace octafront {

/// The walls, and what lies between them.
class WallsAround {
 public:
  /// Coordinates as files give them: what is nearer to a wall than this part of the diagonal is on it. Sheets come onto
  /// walls within as much.
  static constexpr double kOnWalls = 1e-6;

  WallsAround(const SurfaceMesh& walls, const TriangleTree& tree);

  const TriangleTree& walls() const { return walls_; }
  /// In some region, and on no wall to the outside, exactly.
  bool is_inside(Vec3 p) const;
  /// In none, nor on a wall.
  bool is_outside(Vec3 p) const;
  /// How far it is to the nearest wall that p does not lie on, nor one that goes on smoothly from those; at most
  /// `reach`.
  double clearance(Vec3 p, double reach) const;
  /// Away from the outer walls that p lies on: the sum of their unit normals, inward; 0 if it lies on none.
  Vec3 inward(Vec3 p) const;

 private:
  const TriangleTree& walls_;
  SurfaceMesh hull_;
  TriangleTree tree_;  ///< over it
  double near_;
};

/// Fins of all lines and points of a domain.
class Fins {
 public:
  /// Lines are divided to the sizes; of a polygon with shorter edges the vertices stay that it needs to be true within
  /// a hundredth of the size. Throws InputError for what no mesh can have: coordinates that are not finite, indices out
  /// of range, lines without length, no line or point at all. `named`: sizes for
  /// some of them.
  Fins(const std::vector<LineNet>& lines, const std::vector<PointSet>& points, const SizeField& sizes,
       const std::vector<NamedSize>& named, const KnownSurface& walls);

  /// A sheet for each name.
  const std::vector<Sheet>& sheets() const { return sheets_; }
  /// Smaller sizes where lines and points are nearer to walls than elements are long.
  const std::vector<SizeRegion>& narrow() const { return narrow_; }

  /// Takes the fins out of the interfaces of a mesh that was made with them as sheets.
  void leave(TetMesh& mesh);
  /// After that: lines as curves, points as sets of nodes. Returns what a user should know: how much of each there is.
  std::vector<std::string> enter(TetMesh& mesh) const;

 private:
  /// A part of a line, or a point where both ends are one.
  struct Foot {
    Vec3 a, b;
  };
  struct Stand {
    std::string name;
    bool is_line = true;
    double length = 0, outside = 0;  ///< as given, and what of that lies outside
    std::size_t points_outside = 0;
    std::vector<Foot> feet = {};          ///< one per triangle of its sheet
    std::vector<Vec3> asked = {};         ///< points as given
    std::vector<Edge> edges = {};         ///< of the mesh, ascending, each once
    std::vector<VertexIndex> nodes = {};  ///< likewise
  };

  void stand_on(const LineNet& lines, const SizeField& sizes, const WallsAround& ground);
  void stand_on(const PointSet& points, const SizeField& sizes, const WallsAround& ground);
  /// The line with shorter edges where it runs beside a wall.
  std::vector<Vec3> divided_beside_walls(const std::vector<Vec3>& line, const WallsAround& ground);

  void find(const TetMesh& mesh, std::size_t stand, const std::vector<std::uint32_t>& faces);

  std::vector<Stand> stands_;
  std::vector<Sheet> sheets_;
  std::vector<SizeRegion> narrow_;
};

}  // namespace octafront
