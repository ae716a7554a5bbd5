#pragma once

#include <octafront/vec.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// Parts or regions that have something in common, a colour or a layer: of one kind, the other list is empty. One part
/// or region may be in several groups.
struct PartGroup {
  std::string name;
  std::vector<std::uint32_t> parts;  ///< ascending
  std::vector<std::string> regions;  ///< their names
};

/// An edge that a place means.
struct FoundLine {
  std::uint32_t number = 0;          ///< among all edges
  std::vector<Vec3> points;          ///< along it, two or more
  std::vector<std::uint32_t> parts;  ///< that meet in it
};
/// What a place means, by name or by what it is like (docs/use/places.md).
struct FoundShapes {
  std::vector<std::uint32_t> parts;  ///< ascending
  std::vector<FoundLine> lines;
  std::vector<Vec3> points;
};

/// The geometry that an input of triangles stands for, as far as it is known, whoever answers. `patch` numbers the
/// patches of the input's surface. Answers are the same on every thread.
class TrueGeometry {
 public:
  virtual ~TrueGeometry() = default;

  /// The point of the patch nearest to p, which lies near it; nothing if its geometry is not known there.
  virtual std::optional<Vec3> on_face(std::uint32_t patch, Vec3 p) const = 0;
  /// The point nearest to p of the edges in which some two of these patches meet; nothing where none do.
  virtual std::optional<Vec3> on_edge(std::span<const std::uint32_t> patches, Vec3 p) const = 0;
  /// Whether p is a vertex, bit for bit: it stays where it is.
  virtual bool is_vertex(Vec3 p) const = 0;

  virtual const std::vector<std::string>& patch_names() const = 0;
  /// A patch may be several named parts that meet smoothly: the one that p lies nearest to, and the names of all, which
  /// several may share.
  virtual std::uint32_t part_at(std::uint32_t patch, Vec3 p) const = 0;
  virtual const std::vector<std::string>& part_names() const = 0;
  /// The patch that a part is of; kNone: of none.
  virtual std::uint32_t patch_of_part(std::uint32_t part) const = 0;
  /// The parts, edges or vertices that a place means; nothing where it means none of these. Here by the names of parts.
  virtual FoundShapes find(const std::string& place) const {
    FoundShapes found;
    for (std::uint32_t part = 0; part < part_names().size(); ++part)
      if (part_names()[part] == place) found.parts.push_back(part);
    return found;
  }
  /// Further groups of parts or regions.
  virtual const std::vector<PartGroup>& groups() const = 0;
};

}  // namespace octafront
