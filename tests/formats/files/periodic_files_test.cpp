// Pairs of nodes of periodic cells in the formats that hold them.

#include <octafront/io.h>
#include <octafront/validity.h>

#include "formats/small_files.h"

#include <array>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::TemporaryFolder;

/// The unit cube around its long diagonal in six tetrahedra: opposite faces are the same triangles. Patches are faces.
TetMesh kuhn_cube() {
  TetMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.points.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)});
  mesh.tets = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  mesh.boundary = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  mesh.patch = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5};
  mesh.patch_names = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  mesh.periods = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::uint32_t axis = 0; axis < 3; ++axis)
    for (VertexIndex v = 0; v < 8; ++v)
      if (v >> axis & 1) mesh.periodic_nodes.push_back({axis, v, v & ~(1u << axis)});
  return mesh;
}

/// What follows the line `first` up to the line `last`, word by word.
std::vector<std::string> words_between(const std::string& file, const std::string& first, const std::string& last) {
  std::ifstream in(file);
  std::vector<std::string> words;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line == last) inside = false;
    if (inside) {
      std::istringstream parts(line);
      for (std::string word; parts >> word;) words.push_back(word);
    }
    if (line == first) inside = true;
  }
  return words;
}

/// The links of a $Periodic section: by entity and its original the pairs of node tags.
using Links = std::map<std::array<int, 2>, std::set<std::array<int, 2>>>;

Links links_of(const std::vector<std::string>& words) {
  Links links;
  std::size_t at = 0;
  const auto next = [&] { return words.at(at++); };
  for (int left = std::stoi(next()); left > 0; --left) {
    EXPECT_EQ(next(), "2");
    const int tag = std::stoi(next()), original = std::stoi(next());
    // "16" of version 4.1, "Affine" of 2.2.
    next();
    at += 16;
    for (int n = std::stoi(next()); n > 0; --n) {
      const int copy = std::stoi(next());
      links[{tag, original}].insert({copy, std::stoi(next())});
    }
  }
  EXPECT_EQ(at, words.size());
  return links;
}

TEST(PeriodicFiles, MshPairsNodesOfEachPatch) {
  const TetMesh mesh = kuhn_cube();
  ASSERT_EQ(first_defect(mesh), std::nullopt);
  const TemporaryFolder folder;
  for (const char* format : {"msh", "msh22"}) {
    SCOPED_TRACE(format);
    const std::string file = (folder / (std::string(format) + ".msh")).string();
    write_mesh(file, mesh, {}, {.format = format, .ascii = true});
    const Links links = links_of(words_between(file, "$Periodic", "$EndPeriodic"));
    EXPECT_EQ(links.size(), 3u);
    EXPECT_EQ(links.at({2, 1}), (std::set<std::array<int, 2>>{{2, 1}, {4, 3}, {6, 5}, {8, 7}}));
    EXPECT_EQ(links.at({6, 5}), (std::set<std::array<int, 2>>{{5, 1}, {6, 2}, {7, 3}, {8, 4}}));
    for (const bool ascii : {true, false}) {
      write_mesh(file, mesh, {}, {.format = format, .ascii = ascii});
      const TetMesh read = read_mesh(file);
      EXPECT_EQ(read.points, mesh.points);
      EXPECT_EQ(read.periods, mesh.periods);
      EXPECT_EQ(read.periodic_nodes, mesh.periodic_nodes);
      EXPECT_TRUE(read.period_rotations.empty());
    }
  }
}

/// A quarter turn about the z axis leads y_min to x_min; nodes 1 and 5 lie on the axis.
TetMesh quarter() {
  TetMesh mesh = kuhn_cube();
  mesh.periods = {{0, 0, 0}};
  mesh.period_rotations = {{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}};
  mesh.periodic_nodes = {{0, 2, 1}, {0, 6, 5}};
  return mesh;
}

TEST(PeriodicFiles, MshPairsNodesOfRotations) {
  const TetMesh mesh = quarter();
  const TemporaryFolder folder;
  for (const char* format : {"msh", "msh22"}) {
    SCOPED_TRACE(format);
    const std::string file = (folder / (std::string(format) + ".msh")).string();
    write_mesh(file, mesh, {}, {.format = format, .ascii = true});
    const Links links = links_of(words_between(file, "$Periodic", "$EndPeriodic"));
    EXPECT_EQ(links.size(), 1u);
    EXPECT_EQ(links.at({1, 3}), (std::set<std::array<int, 2>>{{1, 1}, {3, 2}, {5, 5}, {7, 6}}));
    const TetMesh read = read_mesh(file);
    EXPECT_EQ(read.period_rotations, mesh.period_rotations);
    EXPECT_EQ(read.periodic_nodes, mesh.periodic_nodes);
  }
}

TEST(PeriodicFiles, AbaqusTurnsDisplacements) {
  const TemporaryFolder folder;
  const std::string file = (folder / "sector.inp").string();
  write_mesh(file, quarter());
  const std::vector<std::string> words = words_between(file, "*EQUATION", "");
  // u1(3) + u2(2) = 0, u2(3) - u1(2) = 0, u3(3) - u3(2) = 0.
  const std::vector<std::string> first(words.begin(), words.begin() + 21);
  EXPECT_EQ(first, (std::vector<std::string>{"2",  "3,", "1,",  "1.,", "2,", "2,", "1.",  "2",  "3,", "2,", "1.,",
                                             "2,", "1,", "-1.", "2",   "3,", "3,", "1.,", "2,", "3,", "-1."}));
}

TEST(PeriodicFiles, AbaqusTiesEachCopyOnceToTheLowEnds) {
  const TetMesh mesh = kuhn_cube();
  const TemporaryFolder folder;
  const std::string file = (folder / "cell.inp").string();
  write_mesh(file, mesh);
  std::ifstream in(file);
  std::map<int, std::multiset<std::string>> terms;  // by dependent node, of direction 2
  int directions = 0;
  for (std::string line; std::getline(in, line) && line != "*EQUATION";) continue;
  for (std::string count; std::getline(in, count);) {
    std::string equation, line;
    std::getline(in, equation);
    while (equation.back() == ',') std::getline(in, line), equation += " " + line;
    std::vector<std::string> parts;
    std::istringstream words(equation);
    for (std::string word; std::getline(words, word, ',');) parts.push_back(word.substr(word.find_first_not_of(' ')));
    ASSERT_EQ(parts.size(), 3 * std::stoul(count));
    EXPECT_EQ(parts[2], "1.");
    ++directions;
    if (parts[1] != "2") continue;
    auto& of = terms[std::stoi(parts[0])];
    for (std::size_t i = 3; i < parts.size(); i += 3) {
      EXPECT_EQ(parts[i + 1], "2");
      EXPECT_EQ(parts[i + 2], "-1.");
      of.insert(parts[i]);
    }
  }
  // Seven vertices are copies of the first one; nodes 9, 10 and 11 are the periods.
  EXPECT_EQ(directions, 21);
  EXPECT_EQ(terms.size(), 7u);
  EXPECT_EQ(terms.at(2), (std::multiset<std::string>{"1", "9"}));
  EXPECT_EQ(terms.at(7), (std::multiset<std::string>{"1", "10", "11"}));
  EXPECT_EQ(terms.at(8), (std::multiset<std::string>{"1", "10", "11", "9"}));
  EXPECT_EQ(read_mesh(file).points, mesh.points);
}

}  // namespace
}  // namespace octafront
