#include <octafront/error.h>
#include <octafront/io.h>

#include "formats/files/formats.h"
#include "formats/small_files.h"
#include "support/complexes.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <clocale>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::surface_of;
using testing::TemporaryFolder;

/// Coordinates that need all seventeen digits, and extremes.
SurfaceMesh awkward_surface() {
  SurfaceMesh s = testing::icosphere(2);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (Vec3& p : s.points) p = p * (1 + 0.1 * unit(random)) + Vec3{1e6 / 3, -1e-9 / 7, 1e300 * 0};
  s.points[0] = {std::numeric_limits<double>::denorm_min(), -0.0, std::numeric_limits<double>::max()};
  s.points[1] = {0.1, 1e-300, 123456789012345678.0};
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    s.patch.push_back(static_cast<std::uint32_t>(t * 4 / s.triangles.size()));
  s.patch_names = {"inlet", "outlet of the pump", "wall/3", "last"};
  return s;
}

TEST(ReadSurface, KnowsEveryVariantByContent) {
  const SurfaceMesh tet = testing::unit_tetrahedron();
  for (const auto& [name, bytes] : testing::small_surface_files()) {
    SCOPED_TRACE(name);
    // The name must not matter, except where the keyword OFF is missing.
    const SurfaceFile file = surface_of(bytes, name == "headless.off" ? name : "anything.bin");
    ASSERT_EQ(file.surface.triangles.size(), 4U);
    for (std::size_t t = 0; t < 4; ++t)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(file.surface.points[file.surface.triangles[t][k]], tet.points[tet.triangles[t][k]]);
    EXPECT_TRUE(file.surface.source.empty()) << "triangle t is face t";
  }
}

TEST(ReadSurface, ContentDecidesOverAnyName) {
  for (const auto& [name, bytes] : testing::small_surface_files())
    for (const FormatInfo& other : known_formats()) {
      // OFF without its keyword is told by its name.
      if (other.endings.empty() || bytes.starts_with("4 4")) continue;
      SCOPED_TRACE(name + " named " + std::string(other.endings));
      const std::string ending(other.endings.substr(0, other.endings.find(' ')));
      EXPECT_EQ(surface_of(bytes, "x" + ending).format, surface_of(bytes, name).format);
    }
}

TEST(ReadSurface, PlyHoldsComplexes) {
  const TemporaryFolder folder;
  for (const testing::KnownComplex& known : testing::known_complexes()) {
    SCOPED_TRACE(known.name);
    write_surface(folder / "a.ply", known.surface);
    EXPECT_EQ(read_surface(folder / "a.ply").surface, known.surface);
  }
}

TEST(ReadSurface, PlyWithOneSideOnlyIsNoComplex) {
  const std::string head =
      "ply\nformat ascii 1.0\ncomment region 0 iron\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n";
  const std::string points = "end_header\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_TRUE(surface_of(head + "property int back\n" + points + "3 0 1 2 7\n").surface.sides.empty());
  const SurfaceMesh both =
      surface_of(head + "property int back\nproperty int front\n" + points + "3 0 1 2 0 -1\n").surface;
  EXPECT_EQ(both.sides, (std::vector<Sides>{{kNone, 0}}));
  EXPECT_EQ(both.region_names, std::vector<std::string>{"iron"});
  EXPECT_THROW(surface_of(head + "property int back\nproperty int front\n" + points + "3 0 1 2 -2 0\n"), InputError);
}

TEST(ReadSurface, BinaryStlMayBeginWithSolid) {
  const TemporaryFolder folder;
  write_surface(folder / "a.stl", testing::unit_tetrahedron());
  std::string bytes = testing::file_bytes(folder / "a.stl");
  bytes.replace(0, 12, "solid thing\n");
  EXPECT_EQ(surface_of(bytes).format, "binary STL");
}

TEST(ReadSurface, SolidsAndGroupsBecomePatches) {
  for (const auto& [name, bytes] : testing::small_surface_files()) {
    if (name == "text.stl") {
      const SurfaceMesh s = surface_of(bytes).surface;
      EXPECT_EQ(s.patch, (std::vector<std::uint32_t>{0, 0, 1, 1}));
      EXPECT_EQ(s.patch_names, (std::vector<std::string>{"first part", "second"}));
    } else if (name == "plain.obj") {
      const SurfaceMesh s = surface_of(bytes).surface;
      EXPECT_EQ(s.patch, (std::vector<std::uint32_t>{0, 1, 1, 1}));
      EXPECT_EQ(s.patch_names, (std::vector<std::string>{"thing/side", "thing/side/red"}));
    }
  }
}

TEST(ReadSurface, AllOnOneLine) {
  const SurfaceFile file = surface_of(
      "solid a b facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet endsolid a b");
  EXPECT_EQ(file.surface.triangles.size(), 1U);
  EXPECT_EQ(file.surface.patch_names, (std::vector<std::string>{"a b"}));
}

TEST(ReadSurface, OldMacLineEnds) {
  EXPECT_EQ(surface_of("OFF\r3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r").surface.points.size(), 3U);
  EXPECT_EQ(surface_of("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r").surface.points.size(), 3U);
}

TEST(ReadSurface, DividesPolygonsAndSaysSo) {
  const SurfaceFile file =
      surface_of("OFF\n6 3 0\n0 0 0\n2 1 0\n0 2 0\n1 1 0\n5 5 5\n6 6 6\n3 0 1 2\n4 0 1 2 3\n2 4 5\n");
  ASSERT_EQ(file.surface.triangles.size(), 3U);
  EXPECT_EQ(file.surface.source, (std::vector<std::uint32_t>{0, 1, 1}));
  // The reflex corner 3 is in both halves: the diagonal runs from 1 to 3.
  for (const std::size_t t : {1U, 2U}) {
    const Triangle& corners = file.surface.triangles[t];
    EXPECT_NE(std::find(corners.begin(), corners.end(), 3U), corners.end());
  }
  ASSERT_EQ(file.notes.size(), 2U);
  EXPECT_EQ(file.notes[0], "1 polygon divided into triangles");
}

/// Six quadrilaterals in three groups, as Gmsh's recombined surfaces are; corners 1 to 8 of the unit cube.
TEST(ReadSurface, QuadrilateralsOfMeshesBecomeTwoTriangles) {
  const std::string corners[] = {"0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"};
  const std::string faces[] = {"1 4 3 2", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"};
  std::string gmsh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n";
  std::string medit = "MeshVersionFormatted 2\nDimension 3\nVertices\n8\n";
  for (int i = 0; i < 8; ++i) {
    gmsh += std::to_string(i + 1) + " " + corners[i] + "\n";
    medit += corners[i] + " 0\n";
  }
  gmsh += "$EndNodes\n$Elements\n6\n";
  medit += "Quadrilaterals\n6\n";
  for (int i = 0; i < 6; ++i) {
    const std::string group = std::to_string(1 + i / 2);
    gmsh += std::to_string(i + 1) + " 3 2 " + group + " 7 " + faces[i] + "\n";
    medit += faces[i] + " " + group + "\n";
  }
  for (const std::string& bytes : {gmsh + "$EndElements\n", medit + "End\n"}) {
    SCOPED_TRACE(bytes.substr(0, 20));
    const SurfaceMesh cube = surface_of(bytes, "cube.bin").surface;
    ASSERT_EQ(cube.triangles.size(), 12U);
    EXPECT_DOUBLE_EQ(enclosed_volume(cube), 1);
    for (std::size_t t = 0; t < 12; ++t) EXPECT_EQ(cube.patch_of(t), t / 4);
  }
}

TEST(WriteSurface, KeepsEveryBitExceptInStl) {
  const TemporaryFolder folder;
  const SurfaceMesh s = awkward_surface();
  for (const char* name : {"a.obj", "a.ply", "a.off", "A.PLY"}) {
    SCOPED_TRACE(name);
    write_surface(folder / name, s);
    SurfaceMesh wanted = s;
    if (std::string(name) == "a.off") {
      wanted.patch.clear();
      wanted.patch_names.clear();
    }
    EXPECT_EQ(read_surface(folder / name).surface, wanted);
    EXPECT_TRUE(std::signbit(read_surface(folder / name).surface.points[0].y));
  }
}

TEST(WriteSurface, StlRoundsToSinglePrecision) {
  const TemporaryFolder folder;
  const SurfaceMesh s = testing::icosphere(1);
  write_surface(folder / "a.stl", s);
  const SurfaceMesh back = read_surface(folder / "a.stl").surface;
  ASSERT_EQ(back.triangles.size(), s.triangles.size());
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT(distance(back.points[back.triangles[t][k]], s.points[s.triangles[t][k]]), 1e-7);
  SurfaceMesh large = s;
  large.points[3].x = 1e40;
  EXPECT_THROW(write_surface(folder / "b.stl", large), OutputError);
  EXPECT_FALSE(std::filesystem::exists(folder / "b.stl"));
}

TEST(WriteSurface, TheLocaleChangesNothing) {
  const TemporaryFolder folder;
  const SurfaceMesh s = awkward_surface();
  write_surface(folder / "a.obj", s);
  const std::string before = testing::file_bytes(folder / "a.obj");
  const std::string old = std::setlocale(LC_ALL, nullptr);
  // Where no locale with a decimal comma is installed, this test sees nothing.
  for (const char* locale : {"de_DE.UTF-8", "fr_FR.UTF-8", "nl_NL.UTF-8"}) std::setlocale(LC_ALL, locale);
  write_surface(folder / "b.obj", s);
  EXPECT_EQ(testing::file_bytes(folder / "b.obj"), before);
  EXPECT_EQ(read_surface(folder / "b.obj").surface, s);
  std::setlocale(LC_ALL, old.c_str());
}

TEST(KnownFormats, HaveARowThatTellsAndReadsThem) {
  for (const io::Format& format : io::formats()) {
    SCOPED_TRACE(format.info.name);
    EXPECT_EQ(format.info.reads_surface, format.read_surface != nullptr);
    EXPECT_EQ(format.info.reads_mesh, format.read_mesh != nullptr);
    // Who has no way of telling is told by another row with the same reader.
    const bool is_told = std::ranges::any_of(io::formats(), [&](const io::Format& other) {
      return other.told != nullptr && other.read_mesh == format.read_mesh && other.read_surface == format.read_surface;
    });
    EXPECT_EQ(is_told, format.info.reads_surface || format.info.reads_mesh);
  }
}

TEST(KnownFormats, CanDoWhatTheySay) {
  const TemporaryFolder folder;
  for (const FormatInfo& info : known_formats()) {
    SCOPED_TRACE(info.name);
    const std::string ending(info.endings.substr(0, info.endings.find(' ')));
    const auto file = folder / ("a" + (ending.empty() ? "." + std::string(info.name) : ending));
    if (info.writes_surface) {
      EXPECT_NO_THROW(check_surface_target(file));
      write_surface(file, testing::cube());
      EXPECT_TRUE(info.reads_surface);
      EXPECT_EQ(read_surface(file).surface.triangles.size(), 12U);
    } else {
      EXPECT_THROW(check_surface_target(file), OptionError);
    }
    const std::string name(info.name);
    if (!info.writes_mesh) {
      // Known, but this build lacks what it needs.
      EXPECT_THROW(check_mesh_target(file, {.format = name}), OptionError);
      continue;
    }
    EXPECT_NO_THROW(check_mesh_target(file, {.format = name}));
    write_mesh(file, testing::two_tets(), {}, {.format = name});
    if (info.reads_mesh) {
      EXPECT_EQ(read_mesh(file).tets.size(), 2U);
    }
    if (info.writes_surface) {
      EXPECT_EQ(read_surface(file).surface.triangles.size(), 6U);
    }
  }
}

}  // namespace
}  // namespace octafront
