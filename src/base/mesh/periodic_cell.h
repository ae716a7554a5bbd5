#pragma once

// A cell that is repeated along axes: which faces of it are copies of which. All of it is told by coordinates, bit for
// bit: what lies on the face at the high end of an axis has its copy's other coordinates.

#include <octafront/surface_mesh.h>
#include <octafront/vec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

namespace octafront {

/// The axes that "x", "xz", "xyz", ... name. Throws OptionError, which names the option, for anything else.
std::array<bool, 3> axes_named(std::string_view option, std::string_view axes);

inline constexpr std::array<char, 3> kAxisNames{'x', 'y', 'z'};

struct PeriodicCell {
  Box3 box = {};
  std::array<bool, 3> along = {};  ///< the axes along which it is repeated; none: it is no periodic cell

  bool is_periodic() const { return along[0] || along[1] || along[2]; }
  /// hi - lo in double precision; lo + period is hi exactly.
  double period(int axis) const { return box.hi[axis] - box.lo[axis]; }
  bool is_low(Vec3 p, int axis) const { return along[axis] && p[axis] == box.lo[axis]; }
  bool is_high(Vec3 p, int axis) const { return along[axis] && p[axis] == box.hi[axis]; }

  /// The place on the low faces that p is a copy of; p itself elsewhere.
  Vec3 original(Vec3 p) const { return originals(std::array{p})[0]; }
  /// The same of points that move together: along those axes at whose high end all of them are.
  template <std::size_t N>
  std::array<Vec3, N> originals(std::array<Vec3, N> points) const {
    for (int axis = 0; axis < 3; ++axis) {
      bool all = along[axis];
      for (const Vec3 p : points) all = all && p[axis] == box.hi[axis];
      if (!all) continue;
      for (Vec3& p : points) p[axis] = box.lo[axis];
    }
    return points;
  }
};

/// The cell that fills the box. Where lo + (hi - lo) is rounded, hi becomes what it is rounded to.
PeriodicCell cell_of(Box3 box, const std::array<bool, 3>& along);

/// One of the six faces of a box: twice its axis, and one more at the high end.
using CellFace = std::uint32_t;

/// "x_min", "x_max", ...
std::string name_of_face(CellFace face);

/// The periodic face of the cell that the triangle lies in; kNone: in none.
CellFace face_of_cell(const PeriodicCell& cell, Vec3 a, Vec3 b, Vec3 c);

/// What of a surface is a copy of what: of one whose triangles on opposite faces are the same.
struct PeriodicFaces {
  PeriodicCell cell;
  std::vector<CellFace> face;                ///< per triangle; kNone: on no periodic face
  std::vector<std::uint32_t> other;          ///< per triangle: the one on the opposite face; kNone without
  std::vector<std::uint32_t> copy_of_patch;  ///< per patch at a low end: the one that is its copy; kNone for others
  std::vector<std::uint8_t> is_copied;       ///< per patch: it is a copy

  bool is_copy(std::uint32_t patch) const { return patch < is_copied.size() && is_copied[patch] != 0; }
};

/// `surface`: with patches, each wholly on one face or on none, and each with one copy at most. Without a cell: empty.
/// Throws MeshingError if a triangle has no copy.
PeriodicFaces find_periodic_faces(const SurfaceMesh& surface, const PeriodicCell& cell);

/// Vertices by their coordinates.
class VerticesByPlace {
 public:
  void add(Vec3 p, VertexIndex v) { at_.try_emplace({p.x, p.y, p.z}, v); }
  /// The first one added there; kNone: none.
  VertexIndex find(Vec3 p) const {
    const auto it = at_.find({p.x, p.y, p.z});
    return it == at_.end() ? kNone : it->second;
  }

 private:
  std::map<std::array<double, 3>, VertexIndex> at_;
};

}  // namespace octafront
