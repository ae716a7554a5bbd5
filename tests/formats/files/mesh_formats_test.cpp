// What every mesh format keeps: written and read again, linear and of second order, with names and sets. What others
// make of the files is judged by tests/formats.

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/validity.h>

#include "formats/small_files.h"
#include "support/rich_mesh.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include <fmt/core.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using Kind = NamedSet::Kind;
using testing::TemporaryFolder;

std::string file_name(const FormatInfo& info) {
  const std::string_view ending = info.endings.substr(0, info.endings.find(' '));
  return ending.empty() ? fmt::format("mesh.{}", info.name) : fmt::format("mesh{}", ending);
}

/// Formats list sets in an order of their own.
TetMesh with_sorted_sets(TetMesh mesh) {
  std::sort(mesh.sets.begin(), mesh.sets.end(),
            [](const NamedSet& a, const NamedSet& b) { return std::pair(a.kind, a.name) < std::pair(b.kind, b.name); });
  return mesh;
}

/// What is left of a mesh in a format.
TetMesh kept(TetMesh mesh, const FormatHolds& holds) {
  const auto drop_names = [](std::vector<std::string>& names, Keeps keeps) {
    if (keeps != Keeps::kNames) names.clear();
  };
  drop_names(mesh.region_names, holds.regions);
  drop_names(mesh.patch_names, holds.patches);
  if (holds.curves == Keeps::kNothing || holds.curves == Keeps::kNodeSets) {
    mesh.curve_edges.clear();
    mesh.curve.clear();
  }
  drop_names(mesh.curve_names, holds.curves);
  std::erase_if(mesh.sets, [&](const NamedSet& set) {
    return !(set.kind == Kind::kNodes   ? holds.node_sets
             : set.kind == Kind::kEdges ? holds.edge_sets
             : set.kind == Kind::kFaces ? holds.face_sets
                                        : holds.element_sets);
  });
  return with_sorted_sets(std::move(mesh));
}

/// Sets of nodes that stand for curves: whoever writes them cannot get them back.
void drop_curve_nodes(TetMesh& mesh, const TetMesh& original) {
  std::erase_if(mesh.sets, [&](const NamedSet& set) {
    const auto& names = original.curve_names;
    const bool was_edges = std::any_of(original.sets.begin(), original.sets.end(),
                                       [&](const NamedSet& s) { return s.kind == Kind::kEdges && s.name == set.name; });
    return set.kind == Kind::kNodes && (was_edges || std::find(names.begin(), names.end(), set.name) != names.end());
  });
}

std::vector<std::string> described(const TetMesh& mesh) {
  std::vector<std::string> all;
  for (const NamedSet& set : mesh.sets)
    all.push_back(std::to_string(static_cast<int>(set.kind)) + " " + set.name + " " +
                  std::to_string(set.members.size()));
  return all;
}

void expect_equal(const TetMesh& back, const TetMesh& wanted, double tolerance) {
  ASSERT_EQ(back.points.size(), wanted.points.size());
  double farthest = 0;
  for (std::size_t v = 0; v < back.points.size(); ++v)
    farthest = std::max(farthest, length(back.points[v] - wanted.points[v]));
  EXPECT_LE(farthest, tolerance);
  EXPECT_EQ(back.tets, wanted.tets);
  EXPECT_EQ(back.mid_nodes, wanted.mid_nodes);
  EXPECT_EQ(back.region, wanted.region);
  EXPECT_EQ(back.region_names, wanted.region_names);
  EXPECT_EQ(back.boundary.size(), wanted.boundary.size());
  EXPECT_EQ(back.patch_names, wanted.patch_names);
  EXPECT_EQ(back.interfaces.size(), wanted.interfaces.size());
  EXPECT_EQ(back.curve_edges, wanted.curve_edges);
  EXPECT_EQ(back.curve, wanted.curve);
  EXPECT_EQ(back.curve_names, wanted.curve_names);
  EXPECT_EQ(described(back), described(wanted));
  EXPECT_EQ(first_defect(back), std::nullopt);
}

/// The corners of the faces of each patch, sorted: formats that have sides of elements turn triangles.
std::vector<std::pair<std::uint32_t, Triangle>> placed_faces(const TetMesh& mesh) {
  std::vector<std::pair<std::uint32_t, Triangle>> all;
  const auto add = [&](const std::vector<Triangle>& faces, const std::vector<std::uint32_t>& patch) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      Triangle t = faces[f];
      std::sort(t.begin(), t.end());
      all.emplace_back(patch.empty() ? 0 : patch[f], t);
    }
  };
  add(mesh.boundary, mesh.patch);
  add(mesh.interfaces, mesh.interface_patch);
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<Triangle> placed_set(const TetMesh& mesh, const std::string& name) {
  std::vector<Triangle> all;
  for (const NamedSet& set : mesh.sets) {
    if (set.name != name || set.kind != Kind::kFaces) continue;
    for (const std::uint32_t f : set.members) {
      all.push_back(f < mesh.boundary.size() ? mesh.boundary[f] : mesh.interfaces[f - mesh.boundary.size()]);
      std::sort(all.back().begin(), all.back().end());
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// Coordinates with many digits, some of them small.
TetMesh crooked(TetMesh mesh) {
  for (Vec3& p : mesh.points) {
    p = p * (1.0 / 3) + Vec3{1e-9 * p.y, -0.1, 1e3};
    if (p.x == 0) p.x = -1.2345678901234567e-12;
  }
  return mesh;
}

/// Names that every format takes as they are.
TetMesh with_plain_names(TetMesh mesh) {
  const auto plain = [](std::string& name) {
    for (char& c : name)
      if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  };
  for (auto* names : {&mesh.region_names, &mesh.patch_names, &mesh.curve_names})
    for (std::string& name : *names) plain(name);
  for (NamedSet& set : mesh.sets) plain(set.name);
  return mesh;
}

std::string text_in(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(TextOfFormats, SaysTheSameAsTheirBytes) {
  int formats = 0;
  for (const FormatInfo& info : known_formats()) {
    if (!info.also_text || !info.reads_mesh) continue;
    ++formats;
    for (const bool second : {false, true}) {
      SCOPED_TRACE(std::string(info.name) + (second ? " of second order" : ""));
      const TemporaryFolder folder;
      TetMesh mesh = testing::rich_mesh(2);
      if (second) mesh = testing::with_mid_nodes(std::move(mesh));
      mesh = crooked(std::move(mesh));
      const WriteOptions binary{.format = std::string(info.name)};
      WriteOptions text = binary;
      text.ascii = true;
      write_mesh(folder / "binary.mesh", mesh, {}, binary);
      write_mesh(folder / "text.mesh", mesh, {}, text);
      const std::string bytes = text_in(folder / "text.mesh");
      EXPECT_TRUE(std::all_of(bytes.begin(), bytes.end(),
                              [](char c) { return c == '\n' || static_cast<unsigned char>(c) >= 0x20; }));
      const TetMesh a = read_mesh(folder / "binary.mesh"), b = read_mesh(folder / "text.mesh");
      EXPECT_EQ(a.points, b.points);
      expect_equal(b, a, 0);
      EXPECT_EQ(a.sets, b.sets);
      EXPECT_EQ(placed_faces(a), placed_faces(b));
    }
  }
  EXPECT_EQ(formats, 4);
}

TEST(TextOfFormats, IsRefusedWhereThereIsNone) {
  const TemporaryFolder folder;
  for (const char* name : {"a.stl", "a.meshb", "a.exo"})
    EXPECT_THROW(check_mesh_target(folder / name, {.ascii = true}), OptionError) << name;
  for (const char* name : {"a.inp", "a.mesh", "a.vtk"})
    EXPECT_NO_THROW(check_mesh_target(folder / name, {.ascii = true})) << name;
}

TEST(CellsOnly, LeavesTetrahedraWithTheirRegions) {
  int formats = 0;
  for (const FormatInfo& info : known_formats()) {
    if (!info.reads_mesh || !info.writes_mesh) continue;
    ++formats;
    for (const bool second : {false, true}) {
      SCOPED_TRACE(std::string(info.name) + (second ? " of second order" : ""));
      const TemporaryFolder folder;
      TetMesh mesh = with_plain_names(testing::rich_mesh(2));
      if (second) mesh = testing::with_mid_nodes(std::move(mesh));
      const auto notes =
          write_mesh(folder / file_name(info), mesh, {}, {.format = std::string(info.name), .cells_only = true});
      const auto counts = fmt::format("cells only: {} faces and {} edges are left out",
                                      mesh.boundary.size() + mesh.interfaces.size(), mesh.curve_edges.size());
      EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [&](const auto& n) { return n.starts_with(counts); }));
      const TetMesh back = read_mesh(folder / file_name(info));
      EXPECT_EQ(back.tets, mesh.tets);
      EXPECT_EQ(back.mid_nodes, mesh.mid_nodes);
      EXPECT_EQ(back.region, mesh.region);
      EXPECT_TRUE(back.interfaces.empty());
      EXPECT_TRUE(back.curve_edges.empty());
      // Readers make one patch of the boundary that a file lacks.
      EXPECT_EQ(back.boundary.size(), mesh.boundary.size());
      EXPECT_TRUE(std::all_of(back.patch.begin(), back.patch.end(), [](std::uint32_t p) { return p == 0; }));
      for (const NamedSet& set : back.sets) EXPECT_TRUE(set.kind == Kind::kNodes || set.kind == Kind::kElements);
      for (const NamedSet& set : mesh.sets)
        if (set.kind == Kind::kElements && info.holds.element_sets) {
          EXPECT_NE(std::find(back.sets.begin(), back.sets.end(), set), back.sets.end()) << set.name;
        }
    }
  }
  EXPECT_GE(formats, 11);
}

TEST(CellsOnly, IsRefusedWhereFacesAreNeeded) {
  const TemporaryFolder folder;
  for (const char* name : {"a.stl", "polyMesh"})
    EXPECT_THROW(write_mesh(folder / name, testing::two_tets(), {}, {.cells_only = true}), OptionError) << name;
}

class EveryFormat : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryFormat, KeepsWhatItHolds) {
  const auto all = known_formats();
  const auto info = std::find_if(all.begin(), all.end(), [](const FormatInfo& i) { return i.name == GetParam(); });
  // Digits that the columns of a format leave.
  const double tolerance = GetParam() == "nastran" ? 2e-8 : GetParam() == "abaqus" ? 1e-11 : 0;
  for (const bool second : {false, true}) {
    if (second && !info->holds.second_order) continue;
    SCOPED_TRACE(second);
    const TemporaryFolder folder;
    TetMesh mesh = testing::rich_mesh(4);
    if (second) mesh = testing::with_mid_nodes(std::move(mesh));
    mesh = crooked(std::move(mesh));
    write_mesh(folder / file_name(*info), mesh, {}, {.format = GetParam()});
    MeshFile file = read_mesh_file(folder / file_name(*info));
    drop_curve_nodes(file.mesh, mesh);
    TetMesh wanted = kept(mesh, info->holds), back = with_sorted_sets(std::move(file.mesh));
    if (GetParam().starts_with("msh"))
      for (auto* names : {&wanted.region_names, &wanted.patch_names})
        for (std::string& name : *names) std::replace(name.begin(), name.end(), '"', '_');
    if (GetParam() == "netgen" || GetParam() == "unv") {
      for (NamedSet& set : wanted.sets) std::replace(set.name.begin(), set.name.end(), ' ', '_');
      for (auto* names : {&wanted.region_names, &wanted.patch_names, &wanted.curve_names})
        for (std::string& name : *names) std::replace(name.begin(), name.end(), ' ', '_');
    }
    expect_equal(back, wanted, tolerance);
    EXPECT_EQ(placed_faces(back), placed_faces(wanted));
    EXPECT_EQ(placed_set(back, "wet"), placed_set(wanted, "wet"));
    for (const NamedSet& set : wanted.sets)
      if (set.kind == Kind::kNodes || set.kind == Kind::kElements) {
        EXPECT_NE(std::find(back.sets.begin(), back.sets.end(), set), back.sets.end()) << set.name;
      }
  }
}

TEST_P(EveryFormat, KeepsNamesApartThatDifferAtTheirEnds) {
  const auto all = known_formats();
  const auto info = std::find_if(all.begin(), all.end(), [](const FormatInfo& i) { return i.name == GetParam(); });
  TetMesh mesh = testing::rich_mesh(2);
  // As those of contacts in assemblies: longer than MED's 80 bytes, with letters of two.
  const std::string common = "Träger links unten, geschweißt|Träger rechts oben, geschweißt, mit Steg und Flansch, ";
  for (auto* names : {&mesh.patch_names, &mesh.curve_names})
    for (std::size_t n = 0; n < names->size(); ++n) (*names)[n] = common + std::to_string(n) + "#2";
  const TemporaryFolder folder;
  write_mesh(folder / file_name(*info), mesh, {}, {.format = GetParam()});
  const TetMesh back = read_mesh(folder / file_name(*info));
  const auto different = [](const std::vector<std::string>& names) {
    return std::set<std::string>(names.begin(), names.end()).size();
  };
  if (info->holds.patches == Keeps::kNames) {
    EXPECT_EQ(different(back.patch_names), mesh.patch_names.size());
  }
  if (info->holds.curves == Keeps::kNames) {
    EXPECT_EQ(different(back.curve_names), mesh.curve_names.size());
  }
}

/// Whether a format holds all that another one does.
bool holds_as_much(const FormatHolds& a, const FormatHolds& b) {
  const auto as_much = [](Keeps x, Keeps y) { return x == y || x == Keeps::kNames; };
  return as_much(a.regions, b.regions) && as_much(a.patches, b.patches) &&
         (as_much(a.curves, b.curves) || b.curves == Keeps::kNodeSets) && a.node_sets >= b.node_sets &&
         a.edge_sets >= b.edge_sets && a.face_sets >= b.face_sets && a.element_sets >= b.element_sets;
}

TEST(EveryPairOfFormats, ConvertsThereAndBack) {
  std::vector<FormatInfo> both;
  for (const FormatInfo& info : known_formats())
    if (info.reads_mesh && info.writes_mesh) both.push_back(info);
  const TemporaryFolder folder;
  const auto through = [&](const TetMesh& mesh, const FormatInfo& info) {
    write_mesh(folder / file_name(info), mesh, {}, {.format = std::string(info.name)});
    return read_mesh(folder / file_name(info));
  };
  const auto order_free = [](TetMesh mesh) {
    // Faces of elements may begin with another corner.
    for (auto* faces : {&mesh.boundary, &mesh.interfaces})
      for (Triangle& t : *faces) std::sort(t.begin(), t.end());
    return with_sorted_sets(std::move(mesh));
  };
  int pairs = 0;
  for (const bool second : {false, true}) {
    TetMesh mesh = with_plain_names(testing::rich_mesh(2));
    if (second) mesh = testing::with_mid_nodes(std::move(mesh));
    for (const FormatInfo& a : both) {
      const TetMesh in_a = through(mesh, a);
      for (const FormatInfo& b : both) {
        if (!holds_as_much(b.holds, a.holds)) continue;
        SCOPED_TRACE(std::string(a.name) + " to " + std::string(b.name));
        const TetMesh there = order_free(through(in_a, b)), back = order_free(through(through(in_a, b), a));
        const TetMesh wanted = order_free(in_a);
        EXPECT_EQ(there.points, wanted.points);
        EXPECT_EQ(there.tets, wanted.tets);
        EXPECT_EQ(there.mid_nodes, wanted.mid_nodes);
        EXPECT_EQ(placed_faces(there), placed_faces(wanted));
        EXPECT_EQ(there.region, wanted.region);
        EXPECT_EQ(there.region_names, wanted.region_names);
        EXPECT_EQ(there.patch_names, wanted.patch_names);
        EXPECT_EQ(there.curve_names, wanted.curve_names);
        EXPECT_EQ(described(there), described(wanted));
        EXPECT_EQ(described(back), described(wanted));
        EXPECT_EQ(back.tets, wanted.tets);
        EXPECT_EQ(back.mid_nodes, wanted.mid_nodes);
        EXPECT_EQ(placed_faces(back), placed_faces(wanted));
        ++pairs;
      }
    }
  }
  EXPECT_GT(pairs, 80);
}

/// Those that are written and read here; the others have their judges in tests/formats.
std::vector<std::string> formats_both_ways() {
  std::vector<std::string> names;
  for (const FormatInfo& info : known_formats())
    if (info.reads_mesh && info.writes_mesh) names.emplace_back(info.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(, EveryFormat, ::testing::ValuesIn(formats_both_ways()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace octafront
