#pragma once

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "report/picture/scene.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// The sizes that a mesh has, on a scale of their logarithms.
struct SizeRange {
  double least = 1, most = 1;
  /// Where a size is: 0 the least, 1 the most.
  double share(double size) const;
};

/// The mean length of the edges of an element, and of a triangle.
double mean_edge(const TetMesh& mesh, std::size_t tet);
double mean_edge(const SurfaceMesh& surface, std::size_t triangle);
SizeRange size_range(const TetMesh& mesh);
SizeRange size_range(const SurfaceMesh& surface);

/// How many values lie in each of 40 equal parts from 0 to 1.
std::vector<std::uint64_t> counts_in_parts(std::span<const double> values);

void quality_legend(Legend& legend, std::vector<std::uint64_t> counts);
void size_legend(Legend& legend, const SizeRange& sizes, const std::string& unit);

/// The marks, and the regions or patches that the faces of a scene are of, with their colours.
void list_marks(Legend& legend, std::span<const std::string> marks);
void list_parts(Scene& scene, PictureOptions::Color color);

/// "12,345,678"
std::string in_groups(std::uint64_t number);

}  // namespace octafront
