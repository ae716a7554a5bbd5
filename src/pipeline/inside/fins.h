#pragma once

// pipeline/inside: lines and points inside of a body. Takes them, sizes and the walls around; leaves fins, small sheets
// that stand on them, with which a mesh is made as with any sheet: so lines are edges and points nodes of it. Takes the
// fins out of the mesh again, and leaves curves and sets of nodes.

#include <octafront/inside.h>
#include <octafront/options.h>
#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include "base/mesh/known_surface.h"

#include <string>
#include <vector>

namespace octafront {

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
    double length = 0;                    ///< as given
    std::vector<Foot> feet = {};          ///< one per triangle of its sheet
    std::vector<Vec3> asked = {};         ///< points as given
    std::vector<Edge> edges = {};         ///< of the mesh, ascending, each once
    std::vector<VertexIndex> nodes = {};  ///< likewise
  };

  void stand_on(const LineNet& lines, const SizeField& sizes, const KnownSurface& walls);
  void stand_on(const PointSet& points, const SizeField& sizes, const KnownSurface& walls);
  void find(const TetMesh& mesh, std::size_t stand, const std::vector<std::uint32_t>& faces);

  std::vector<Stand> stands_;
  std::vector<Sheet> sheets_;
};

}  // namespace octafront
