#pragma once

#include <octafront/run_context.h>
#include <octafront/size_field.h>
#include <octafront/tet_mesh.h>

#include "report/page/bytes.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace octafront {

/// Values of elements as bytes: `low` is 0, `high` is 255, what lies beyond is cut.
struct ByteScale {
  double low, high;
  std::uint8_t operator()(double value) const;
};

inline constexpr ByteScale kBetaScale{0, 1};
inline constexpr ByteScale kLayersScale{0, 1};          // of the most layers
inline constexpr ByteScale kMinDihedralScale{0, 75};    // degrees; the regular tetrahedron has 70.5
inline constexpr ByteScale kMaxDihedralScale{60, 180};  // degrees
inline constexpr ByteScale kSizeRatioScale{-2, 2};      // the logarithm to base 2 of edge length made over wanted

/// A mesh in few bytes. Vertices are numbered as the elements meet them; of mid-side nodes only those are kept that are
/// not where the middle of a straight edge is.
struct MeshStreams {
  std::uint64_t points = 0;
  Vec3 origin;      ///< point (i, j, k) lies at origin + step * (i, j, k)
  double step = 1;  ///< in input units
  bool has_sizes = false;
  bool has_layers = false;
  /// By name:
  ///   tets      four numbers an element: how far its corner is behind the vertices met so far; 0 is a new vertex
  ///   points    the differences from vertex to vertex, all x, all y, all z
  ///   beta, min_dihedral, max_dihedral, size_ratio   a byte an element; the last one only if sizes are known
  ///   region    a number an element
  ///   boundary  a face each: the difference of its half-face (4 t + i) to the one before, its patch
  ///   walls     a face inside each, between two regions or on an interface: the difference of its lower half-face to
  ///             the one before, the other half-face less that, and 0, or its patch + 1
  ///   bends     a curved edge each, once: the difference of 6 t + its place in kTetEdges to the one before, how far
  ///             its mid-side node is from the middle of its ends along x, y, z; only of second order
  std::vector<std::pair<const char*, Bytes>> all;
};

MeshStreams mesh_streams(const TetMesh& mesh, const SizeField* sizes, const RunContext& context);

}  // namespace octafront
