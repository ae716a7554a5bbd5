#pragma once

#include <octafront/ids.h>
#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include "base/core/flat_map.h"
#include "base/core/groups.h"
#include "base/mesh/face_table.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace octafront {

/// A wall of a cavity: (a, b, c) such that (a, b, c, p) is positive for a point p of the cavity next to it.
using Wall = Triangle;

/// Per point, whether a cell of a coarse grid that holds it reaches into one of the boxes.
std::vector<std::uint8_t> near_boxes(const std::vector<Vec3>& points, const std::vector<Box3>& boxes);

/// A repair wants to know of tetrahedra that a WorkMesh of a part was not given.
struct BeyondPart {};

/// A tetrahedral mesh under repair: tetrahedra come and go, and know their vertices' other tetrahedra.
class WorkMesh {
 public:
  enum class Holds { kAll, kFocus };
  /// Takes the mesh over; vertex numbers and tetrahedron numbers stay as they are. Repairs will mostly stay within the
  /// boxes of `focus`, if there are any: only what lies there is indexed beforehand.
  /// `two_sided`: triangles with something to fill on both sides; no cavity grows through them.
  /// `holds`: what of the tetrahedra are given; those of the focus alone are all that touch points near_boxes(), and
  /// around() throws BeyondPart for others.
  WorkMesh(std::vector<Vec3> points, std::vector<Tet> tets, const std::vector<Box3>& focus = {},
           const std::vector<Triangle>& two_sided = {}, Holds holds = Holds::kAll);

  const std::vector<Vec3>& points() const { return points_; }
  Vec3 at(VertexIndex v) const { return points_[v]; }
  VertexIndex add_point(Vec3 p);
  TetIndex add(const Tet& tet);
  void remove(TetIndex t) { alive_[t] = false; }
  void restore(TetIndex t) { alive_[t] = true; }
  bool alive(TetIndex t) const { return alive_[t]; }
  const Tet& tet(TetIndex t) const { return tets_[t]; }
  /// The living tetrahedra around a vertex, in order of their number.
  std::vector<TetIndex> around(VertexIndex v) const;
  /// Whether the face, turned either way, is a triangle with something to fill on both sides.
  bool is_two_sided(const Triangle& face) const { return two_sided_.contains(face_key(face)); }
  /// The living tetrahedron that has `outward` as a face, seen counter-clockwise from outside; kNone if none has.
  TetIndex tet_behind(const Triangle& outward) const;

  /// What is wrong with a tetrahedron and its neighbourhood, or with all of them.
  std::optional<std::string> first_inconsistency(TetIndex t) const;
  std::optional<std::string> first_inconsistency() const;

  /// The living tetrahedra; leaves the object empty.
  std::vector<Tet> take_tets();
  std::vector<Vec3> take_points() { return std::move(points_); }

 private:
  void index_tets() const;

  std::vector<Vec3> points_;
  std::vector<Tet> tets_;
  std::size_t original_tets_;
  Holds holds_;
  std::vector<bool> alive_;
  mutable std::vector<std::uint8_t> indexed_;                     ///< per original vertex
  mutable Groups<TetIndex, std::uint64_t> incident_;              ///< tetrahedra of each original vertex
  std::unordered_map<VertexIndex, std::vector<TetIndex>> added_;  ///< looked up, never iterated
  FlatSet<Triangle> two_sided_;                                   ///< by face_key
};

/// A face as a wall: the same for all ways to write the corners in this turn, another one for its back. Sorts like
/// face_key().
using WallKey = std::pair<Triangle, bool>;
inline WallKey wall_key(const Wall& wall) {
  return {face_key(wall), is_even(wall)};
}
inline WallKey back_of(const WallKey& key) {
  return {key.first, !key.second};
}

/// The cavities of a mesh: sets of walls connected by edges. Each is closed and oriented; it may be pinched. Two-sided
/// triangles may be walls twice.
class Cavities {
 public:
  explicit Cavities(const std::vector<Wall>& walls);

  std::size_t size() const { return walls_.size(); }
  const std::vector<Wall>& walls(std::size_t cavity) const { return walls_[cavity]; }
  /// The cavity that a wall on these corners, turned either way, belongs to, or kNone.
  std::uint32_t owner(const Triangle& wall) const;
  void close(std::size_t cavity);

  /// Each cavity is closed and owns its walls.
  std::optional<std::string> first_inconsistency() const;

 private:
  std::vector<std::vector<Wall>> walls_;                   ///< empty: closed
  std::array<FlatMap<Triangle, std::uint32_t>, 2> owner_;  ///< by the parts of wall_key
};

/// One of the cavities of a mesh.
struct OpenCavity {
  WorkMesh& mesh;
  Cavities& cavities;
  std::uint32_t number = 0;

  const std::vector<Wall>& walls() const { return cavities.walls(number); }
};

}  // namespace octafront
