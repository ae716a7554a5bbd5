#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace octafront::io {

/// Edges of wedges and pyramids, as corners of WideCell, in the order of their mid-side nodes here: of a wedge those of
/// its base, of the triangle above it, and those between them.
inline constexpr std::array<std::array<std::size_t, 2>, 9> kWedgeEdges{
    {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};
inline constexpr std::array<std::array<std::size_t, 2>, 8> kPyramidEdges{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};

/// Outward faces of wedges and pyramids, as corners of WideCell; the last one of a triangle is repeated. In the order
/// of Abaqus's S1, S2, ...
inline constexpr std::array<std::array<std::size_t, 4>, 5> kWedgeFaces{
    {{0, 2, 1, 1}, {3, 4, 5, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
inline constexpr std::array<std::array<std::size_t, 4>, 5> kPyramidFaces{
    {{0, 3, 2, 1}, {0, 1, 4, 4}, {1, 2, 4, 4}, {2, 3, 4, 4}, {3, 0, 4, 4}}};

/// Outward faces of hexahedra: a quadrilateral, counter-clockwise seen from the one above it, and that one. In the
/// order of Abaqus's S1, S2, ...
inline constexpr std::array<std::array<std::size_t, 4>, 6> kHexahedronFaces{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

/// The order of nodes in a format: its node i is ours at place wedge[i] or pyramid[i]. Ours are the corners of
/// WideCell, then the mid-side nodes of kWedgeEdges or kPyramidEdges. Linear cells have the first six or five.
struct WideOrder {
  std::array<std::uint8_t, 15> wedge;
  std::array<std::uint8_t, 13> pyramid;

  std::span<const std::uint8_t> of(bool is_wedge) const {
    return is_wedge ? std::span<const std::uint8_t>(wedge) : std::span<const std::uint8_t>(pyramid);
  }
};

/// The nodes of a wedge or pyramid, linear or not, that a file has in its order, in ours.
template <class T>
std::span<const T> in_our_order(std::span<const T> nodes, const WideOrder& order, std::array<T, 15>& room) {
  const auto places = order.of(nodes.size() == 6 || nodes.size() == 15);
  for (std::size_t k = 0; k < nodes.size(); ++k) room[places[k]] = nodes[k];
  return std::span(room).first(nodes.size());
}

/// Abaqus, FEBio.
inline constexpr WideOrder kPlainWide{{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14},
                                      {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}};
/// VTK, SU2: the first triangle of a wedge faces outward.
inline constexpr WideOrder kVtkWide{{0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13}, kPlainWide.pyramid};
/// Nastran, CGNS, Exodus: the edges between the triangles come before those of the second one.
inline constexpr WideOrder kCgnsWide{{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11}, kPlainWide.pyramid};
/// Gmsh: edges by their corners, 12 13 14 23 25 36 45 46 56; 12 14 15 23 25 34 35 45.
inline constexpr WideOrder kGmshWide{{0, 1, 2, 3, 4, 5, 6, 8, 12, 7, 13, 14, 9, 11, 10},
                                     {0, 1, 2, 3, 4, 5, 8, 9, 6, 10, 7, 11, 12}};
/// XDMF: corners of a wedge as Gmsh and meshio have them, mid-side nodes as VTK.
inline constexpr WideOrder kXdmfWide = kPlainWide;
/// MED: bases face the other way.
inline constexpr WideOrder kMedWide{kVtkWide.wedge, {0, 3, 2, 1, 4, 8, 7, 6, 5, 9, 12, 11, 10}};
/// I-deas: mid-side nodes stand between the corners of each triangle. There are no pyramids; a wedge stands for one,
/// see as_wedge().
inline constexpr WideOrder kUnvWide{{0, 6, 1, 7, 2, 8, 12, 13, 14, 3, 9, 4, 10, 5, 11}, kPlainWide.pyramid};

/// A pyramid as a wedge whose first edge between its triangles has no length, for formats without pyramids: place i of
/// the wedge has the pyramid's node at kPyramidAsWedge[i], and side i of the pyramid is that side of the wedge.
inline constexpr std::array<std::uint8_t, 15> kPyramidAsWedge{4, 1, 0, 4, 2, 3, 10, 5, 9, 11, 7, 12, 4, 6, 8};
inline constexpr std::array<std::size_t, 5> kPyramidSideOfWedge{3, 0, 2, 1, 4};

/// The nodes of a pyramid, linear or not, as those of such a wedge; both in our order.
template <class T>
std::span<const T> as_wedge(std::span<const T> pyramid, std::array<T, 15>& room) {
  const std::size_t count = pyramid.size() == 5 ? 6 : room.size();
  for (std::size_t i = 0; i < count; ++i) room[i] = pyramid[kPyramidAsWedge[i]];
  return std::span(room).first(count);
}

}  // namespace octafront::io
