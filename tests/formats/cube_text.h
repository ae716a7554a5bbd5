#pragma once

// The unit cube of six tetrahedra around its diagonal, as rows of text for files of other programs.

#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include <array>
#include <string>

#include <fmt/core.h>

namespace octafront::testing {

inline constexpr std::array<Vec3, 8> kCubeNodes{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
inline constexpr std::array<std::array<int, 4>, 6> kCubeTets{
    {{1, 2, 3, 7}, {1, 3, 4, 7}, {1, 4, 8, 7}, {1, 8, 5, 7}, {1, 5, 6, 7}, {1, 6, 2, 7}}};

/// "1, 0, 0, 0" and so on, a line each; `separator` between fields, numbers from `first` on.
inline std::string cube_nodes(const std::string& separator = ", ", int first = 1) {
  std::string rows;
  for (std::size_t i = 0; i < kCubeNodes.size(); ++i)
    rows += fmt::format("{1}{0}{2}{0}{3}{0}{4}\n", separator, static_cast<int>(i) + first, kCubeNodes[i].x,
                        kCubeNodes[i].y, kCubeNodes[i].z);
  return rows;
}
inline std::string cube_tets(const std::string& separator = ", ") {
  std::string rows;
  for (std::size_t i = 0; i < kCubeTets.size(); ++i)
    rows += fmt::format("{1}{0}{2}{0}{3}{0}{4}{0}{5}\n", separator, i + 1, kCubeTets[i][0], kCubeTets[i][1],
                        kCubeTets[i][2], kCubeTets[i][3]);
  return rows;
}

inline double volume_of(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& t : mesh.tets) {
    const Vec3 a = mesh.points[t[0]];
    sum += dot(cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a), mesh.points[t[3]] - a) / 6;
  }
  return sum;
}

/// "NAME 4" for each further set, one behind the other.
inline std::string sets_of(const TetMesh& mesh) {
  std::string all;
  for (const NamedSet& set : mesh.sets)
    all += (all.empty() ? "" : ", ") + set.name + " " + std::to_string(set.members.size());
  return all;
}

/// Whether one of the notes has this in it.
inline bool says(const std::vector<std::string>& notes, const std::string& part) {
  for (const std::string& note : notes)
    if (note.find(part) != std::string::npos) return true;
  return false;
}

}  // namespace octafront::testing
