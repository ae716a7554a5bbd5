#pragma once

#include <octafront/surface_mesh.h>

#include "base/geometry/triangle_tree.h"
#include "surface/edits/walk.h"

#include <optional>
#include <span>
#include <vector>

namespace octafront::surface {

/// Where two surfaces lie too far apart.
struct FarPlace {
  Vec3 at;                         ///< on either of them
  SurfacePoint on_input;           ///< the place itself, or the nearest point to it that faces alike
  double distance = 0;             ///< to the other surface, over the part that the bound there is of the general one
  std::uint32_t triangle = kNone;  ///< of the made surface, there or nearest
  bool within = false;             ///< inside a triangle of the input, not at its corners or the middles of its edges
};

/// A point of a triangle.
struct Sample {
  Vec3 p;
  std::uint32_t triangle;
  bool within = false;  ///< not at its corners or the middles of its edges
};

/// What is looked at of triangles of the input that are not much longer than those made there: whatever part of them
/// may be far, or their corners, between which there is little. Nets of voxels consist of such.
enum class Fine { kParts, kCorners };

/// Looks for places where a surface that is being made lies farther from its input than `limit`, at the centroids, edge
/// midpoints and vertices of the made one, and at the vertices and edge midpoints of the input and wherever else it may
/// lie beyond the limit; no deeper where it is known to lie beyond `far`. Of triangles of the input that are long, and
/// narrow beside those made there, only places an eighth of an edge apart are looked at. Where nothing changed since
/// the last look, what was found then stands. `input_tree` is over the triangles of `input`; both must outlive it.
/// `bound`: per triangle of the input what `far` is there, if that is less; the limit shrinks alike. Empty: so nowhere.
class DeviationWatch {
 public:
  DeviationWatch(double limit, double far, const SurfaceMesh& input, const TriangleTree& input_tree,
                 Fine fine = Fine::kParts, std::span<const double> bound = {});

  /// The places of `made`, whose triangles are called by `number`: ascending, the same ones for the same triangles in
  /// each look.
  std::vector<FarPlace> look(const SurfaceMesh& made, const std::vector<std::uint32_t>& number);

 private:
  /// The triangles of a look.
  struct Looked {
    std::vector<std::uint32_t> number;
    std::vector<TriangleCorners> corners;
  };

  double part_of(std::uint32_t triangle) const { return part_.empty() ? 1 : part_[triangle]; }
  std::vector<Sample> far_of_made(const SurfaceMesh& made, const std::vector<std::uint32_t>& changed) const;
  std::vector<std::uint32_t> note_changes(const SurfaceMesh& made, const std::vector<std::uint32_t>& number);

  void mark_near(const std::vector<Vec3>& corners);

  double limit_, far_;
  Fine fine_;
  const SurfaceMesh& input_;
  const TriangleTree& input_tree_;
  std::vector<double> part_;             ///< per triangle of the input, of the limits; empty: 1
  double least_part_ = 1;                ///< of them
  std::optional<TriangleTree> tighter_;  ///< over those triangles of which it is less than 1
  Looked last_;
  std::vector<std::uint8_t> is_changed_;      ///< by number
  std::vector<std::uint8_t> is_near_change_;  ///< per triangle of the input
  std::vector<FarPlace> of_made_, of_input_;  ///< found from the one or the other
};

/// The points of the input that lie under the middles of these triangles and of their edges, however near.
std::vector<FarPlace> places_under(const std::vector<std::uint32_t>& triangles, const SurfaceMesh& made,
                                   const TriangleTree& input_tree);

}  // namespace octafront::surface
