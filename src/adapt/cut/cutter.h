#pragma once

// adapt/cut: a mesh in which surfaces inside become faces of elements.

#include <octafront/level_set.h>
#include <octafront/tet_mesh.h>

#include <array>
#include <cstdint>
#include <vector>

namespace octafront::adapt {

/// A mesh that is cut, and what it is made of.
struct CutState {
  TetMesh mesh;                             ///< points, tets, boundary, interfaces, curve_edges, and old regions
  std::vector<std::vector<double>> values;  ///< of each level set at the points, less its level
  std::vector<std::uint32_t> old_tet;       ///< per tet
  std::vector<std::uint32_t> old_face;      ///< per face of the boundary, then per interface
  std::vector<std::uint32_t> old_edge;      ///< per curve edge
  std::vector<std::uint32_t> old_node;      ///< per point; kNone: new
  std::vector<std::uint32_t> inside;        ///< per tet the first level set that it is below of; kNone: none
};

/// Points near the surface of the level set go there, along the edge on which it is nearest, where they may; what is
/// very near and may not is taken for a point of it.
void move_to_surface(CutState& state, std::size_t level_set, LevelSetReport& report);

/// Divides all elements that the surface of the level set crosses, and enters which lie inside.
void divide_along(CutState& state, std::size_t level_set, LevelSetReport& report);

/// The parts of a region that do not touch in faces; small ones go to what they touch most, within their old region.
void drop_pieces(CutState& state, double least, std::vector<LevelSetReport>& reports);

}  // namespace octafront::adapt
