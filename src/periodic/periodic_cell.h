#pragma once

// A cell that is repeated: which faces of it are copies of which. All of it is told by coordinates, bit for bit. Of a
// box that is repeated along axes, what lies on the face at the high end has its copy's other coordinates. Where other
// maps lead from face to face, low faces have their vertices on a grid that is far finer than anything meant, and far
// coarser than rounding: what is rounded on the way back goes to the place on the grid that it came from.

#include <octafront/surface_mesh.h>
#include <octafront/vec.h>

#include "base/geometry/same_place.h"
#include "base/geometry/triangle_tree.h"
#include "periodic/periodic_map.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace octafront {

/// The axes that "x", "xz", "xyz", ... name. Throws OptionError, which names the option, for anything else.
std::array<bool, 3> axes_named(std::string_view option, std::string_view axes);

inline constexpr std::array<char, 3> kAxisNames{'x', 'y', 'z'};

/// One of the faces of a cell: twice the number of its period (of a box: its axis), and one more at the high end.
using CellFace = std::uint32_t;

/// A map that leads from one part of a surface, the low face, to another one, the high face.
struct MappedFaces {
  PeriodicMap map;
  std::array<std::shared_ptr<const TriangleTree>, 2> on = {};  ///< the triangles of both
  bool is_flat = false;
  Vec3 normal = {};  ///< of the low face, if it is flat
};

struct PeriodicCell {
  Box3 box = {};
  std::array<bool, 3> along = {};            ///< the axes along which it is repeated; none: it is no periodic box
  std::vector<MappedFaces> mapped = {};      ///< if not a box: its periods
  double grid = 0;                           ///< a power of two: where vertices of low faces lie, if not a box
  std::vector<CellFace> face_of_patch = {};  ///< if not a box: per patch of the surface; kNone: on no face

  bool is_box() const { return mapped.empty(); }
  bool is_periodic() const { return along[0] || along[1] || along[2] || !is_box(); }
  /// Periods are numbered below this; those of a box by axis, so some may be none.
  int periods() const { return is_box() ? 3 : static_cast<int>(mapped.size()); }
  bool has(int period) const { return is_box() ? along[period] : true; }
  /// Those that there are, ascending.
  std::vector<int> periods_there() const;
  /// Of a box: hi - lo in double precision; lo + period is hi exactly.
  double period(int axis) const { return box.hi[axis] - box.lo[axis]; }

  bool is_low(Vec3 p, int period) const {
    return is_box() ? along[period] && p[period] == box.lo[period] : is_on_grid(p) && is_near_face(p, period, 0);
  }
  bool is_high(Vec3 p, int period) const {
    return is_box() ? along[period] && p[period] == box.hi[period] : is_mapped(p, period) && is_near_face(p, period, 1);
  }
  /// Whether p lies on a face (0: the low one) up to rounding. If not a box.
  bool is_near_face(Vec3 p, int period, int end) const;
  /// The copy of a place on the low face; that of any other place, up to rounding.
  Vec3 to_high(Vec3 p, int period) const;
  /// The other way.
  Vec3 to_low(Vec3 p, int period) const;
  /// Where a vertex of a low face near p lies; p itself in a box.
  Vec3 on_grid(Vec3 p) const;

  /// The place on the low faces that p is a copy of; p itself elsewhere.
  Vec3 original(Vec3 p) const { return originals(std::array{p})[0]; }
  /// The same of points that move together: by those periods on whose high face all of them are.
  template <std::size_t N>
  std::array<Vec3, N> originals(std::array<Vec3, N> points) const {
    // Of other periods than those of a box what is low for the first may be high for it again.
    const int rounds = is_box() ? 1 : periods();
    for (int k = 0; k < rounds * periods(); ++k) {
      const int period = k % periods();
      bool all = has(period);
      for (const Vec3 p : points) all = all && is_high(p, period);
      if (!all) continue;
      for (Vec3& p : points) p = to_low(p, period);
    }
    return points;
  }
  /// Where p goes, which lies beside `from` on a line of faces, if `from` goes to its copy `to`. Not finite if p has no
  /// such copy.
  Vec3 carried(Vec3 p, Vec3 from, Vec3 to) const;
  /// A new place on the line between two vertices, which may lie on faces: p, or one that has its copies bit for bit.
  Vec3 settled(Vec3 p, Vec3 a, Vec3 b) const;

  /// "x", or "period 1", for messages.
  std::string name_of_period(int period) const;

 private:
  bool is_on_grid(Vec3 p) const { return on_grid(p) == p; }
  bool is_mapped(Vec3 p, int period) const;
  std::optional<Vec3> carried_by(Vec3 p, Vec3 from, Vec3 to, int steps) const;
};

/// The cell that fills the box. Where lo + (hi - lo) is rounded, hi becomes what it is rounded to.
PeriodicCell cell_of(Box3 box, const std::array<bool, 3>& along);

/// A place on the faces of a box at the ends of these axes, if it is no farther from them than `within`, axis by axis.
Vec3 put_on_faces(Vec3 p, const Box3& box, const std::array<bool, 3>& along, Vec3 within);

/// A cell of other periods, whose faces are not known yet: the grid is that for coordinates up to `largest`.
PeriodicCell mapped_cell(const std::vector<PeriodicMap>& maps, double largest);

/// The periodic face of the cell that a triangle of its surface lies in; kNone: in none. The triangles are those that
/// the cell was made of, of a box any.
CellFace face_of_cell(const PeriodicCell& cell, Vec3 a, Vec3 b, Vec3 c);
/// The same of triangles of a mesh of the cell, by their patch where it is no box.
CellFace face_of_cell(const PeriodicCell& cell, std::uint32_t patch, Vec3 a, Vec3 b, Vec3 c);

/// Fills in the faces of the patches of the surface that the cell was made of.
void find_faces_of_patches(const SurfaceMesh& surface, PeriodicCell& cell);

/// The vertices of a surface of the cell that lie on periodic faces, ascending.
std::vector<VertexIndex> vertices_on_faces(const SurfaceMesh& surface, const PeriodicCell& cell);

/// What of a surface is a copy of what: of one whose triangles on opposite faces are the same.
struct PeriodicFaces {
  PeriodicCell cell;
  std::vector<CellFace> face;                ///< per triangle; kNone: on no periodic face
  std::vector<std::uint32_t> other;          ///< per triangle: the one on the opposite face; kNone without
  std::vector<std::uint32_t> copy_of_patch;  ///< per patch at a low end: the one that is its copy; kNone for others
  std::vector<std::uint8_t> is_copied;       ///< per patch: it is a copy
  std::vector<CellFace> face_of_patch;       ///< per patch; kNone: on no periodic face

  bool is_copy(std::uint32_t patch) const { return patch < is_copied.size() && is_copied[patch] != 0; }
};

/// `surface`: with patches, each wholly on one face or on none, and each with one copy at most. Without a cell: empty.
/// Throws MeshingError if a triangle has no copy.
PeriodicFaces find_periodic_faces(const SurfaceMesh& surface, const PeriodicCell& cell);

}  // namespace octafront
