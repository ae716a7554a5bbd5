// Meshes in parts: the division, pieces with their ghosts, and the sets of files that are made of them. What others
// make of these files is judged by tests/formats/parts_judges.py.

#include "formats/parts/pieces.h"

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/share_files.h>

#include "base/core/thread_limit.h"
#include "base/shared/shared_tets.h"
#include "base/shared/virtual_ranks.h"
#include "formats/parts/division.h"
#include "formats/parts/mesh_parts.h"
#include "formats/small_files.h"
#include "support/mixed_mesh.h"
#include "support/rich_mesh.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <ranges>
#include <set>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace octafront {
namespace {

namespace fs = std::filesystem;
using io::MeshParts;
using io::Piece;
using io::Pieces;
using testing::TemporaryFolder;

std::vector<TetMesh> meshes_to_divide() {
  return {testing::rich_mesh(4), testing::with_mid_nodes(testing::rich_mesh(2)), testing::mixed_mesh(3),
          testing::with_mid_nodes(testing::mixed_mesh(2))};
}

std::vector<Partitioner> partitioners() {
  if (has_metis()) return {Partitioner::kCurve, Partitioner::kMetis};
  return {Partitioner::kCurve};
}

TEST(Division, HasEachElementInOnePart) {
  for (const TetMesh& mesh : meshes_to_divide())
    for (const Partitioner by : partitioners()) {
      const io::Division division = io::divide(mesh, 5, by);
      ASSERT_EQ(division.part.size(), mesh.tets.size());
      EXPECT_TRUE(std::ranges::all_of(division.part, [](std::uint32_t p) { return p < 5; }));
      for (const WideCell& cell : mesh.wide_cells)
        for (TetIndex t = cell.first; t < cell.first + cell.tet_count; ++t)
          EXPECT_EQ(division.part[t], division.part[cell.first]);
      const io::DivisionCost cost = io::cost_of(mesh, division);
      EXPECT_GT(cost.cut, 0U);
      EXPECT_GT(cost.least, 0U);
      if (by == Partitioner::kCurve) {
        EXPECT_LE(cost.most, cost.least + 1);
      }
    }
}

TEST(Division, IsTheSameForAnyNumberOfThreads) {
  const TetMesh mesh = testing::rich_mesh(20);
  for (const Partitioner by : partitioners()) {
    const auto with = [&](int threads) {
      const ThreadLimit limit(threads);
      return io::divide(mesh, 7, by).part;
    };
    EXPECT_EQ(with(1), with(2));
  }
}

TEST(Division, KeepsPartsTogether) {
  // The worst one can do is a cut everywhere: stretches of a curve have few faces for what they hold.
  const TetMesh mesh = testing::rich_mesh(16);
  const std::size_t faces = (4 * mesh.tets.size() - mesh.boundary.size()) / 2;
  EXPECT_LT(io::cost_of(mesh, io::divide(mesh, 8, Partitioner::kCurve)).cut, faces / 16);
  if (has_metis()) {
    EXPECT_LT(io::cost_of(mesh, io::divide(mesh, 8, Partitioner::kMetis)).cut, faces / 16);
  }
}

TEST(Division, RefusesMorePartsThanElements) {
  const TetMesh mesh = testing::two_tets();
  EXPECT_EQ(io::divide(mesh, 2, Partitioner::kCurve).part, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_THROW(io::divide(mesh, 3, Partitioner::kCurve), OptionError);
  EXPECT_THROW(io::divide(mesh, 0, Partitioner::kCurve), OptionError);
  for (const Partitioner by : partitioners())
    EXPECT_EQ(io::divide(mesh, 1, by).part, (std::vector<std::uint32_t>{0, 0}));
}

TEST(Division, HasNoEmptyParts) {
  const TetMesh mesh = testing::rich_mesh(4);
  for (const std::uint32_t parts : {30U, 100U, 300U, 383U, 384U})
    for (const Partitioner by : partitioners()) {
      try {
        EXPECT_GT(io::cost_of(mesh, io::divide(mesh, parts, by)).least, 0U) << parts;
      } catch (const OptionError& refused) {
        EXPECT_EQ(by, Partitioner::kMetis) << refused.what();  // which has its limits
        EXPECT_GT(parts, 30U);
      }
    }
}

/// Elements of other parts that share a corner, by looking at all.
std::set<std::uint64_t> ghosts_of(const MeshParts& parts, const io::Division& division, std::uint32_t number) {
  const io::MixedCells cells(parts);
  const TetMesh& mesh = parts.mesh();
  std::vector<bool> is_at(mesh.points.size(), false);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const VertexIndex v : mesh.tets[t])
      if (division.part[t] == number) is_at[v] = true;
  std::set<std::uint64_t> ghosts;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t)
    if (division.part[t] != number && std::ranges::any_of(mesh.tets[t], [&](VertexIndex v) { return is_at[v]; }))
      ghosts.insert(cells.cell_of(t));
  return ghosts;
}

/// Nodes of a cell, in numbers of the whole.
std::vector<std::uint64_t> nodes_of(const io::MixedCells& cells, std::size_t cell, const Piece* piece) {
  io::CellRoom room;
  std::vector<std::uint64_t> nodes;
  for (const VertexIndex v : cells.nodes(cell, room)) nodes.push_back(piece == nullptr ? v : piece->point_ids[v]);
  return nodes;
}

TEST(Piece, HasItsElementsAndTheirNeighbours) {
  for (const TetMesh& given : meshes_to_divide()) {
    const io::WithoutDiagonals without = io::without_diagonals(given);
    const TetMesh& mesh = without.mesh ? *without.mesh : given;
    const MeshParts parts(mesh, {.last_points = without.diagonals});
    const io::Division division = io::divide(mesh, 4, Partitioner::kCurve);
    const io::MixedCells cells(parts);
    Pieces pieces(parts, division);
    std::vector<int> owned(cells.cells(), 0), owned_points(parts.points(), 0), owned_faces(cells.faces(), 0);
    for (std::uint32_t k = 0; k < 4; ++k) {
      SCOPED_TRACE(k);
      const Piece piece = pieces.piece(k);
      const MeshParts of_piece(piece.mesh, {.last_points = piece.last_points});
      const io::MixedCells own(of_piece);
      std::set<std::uint64_t> ghosts;
      for (std::size_t c = 0; c < own.cells(); ++c) {
        const TetIndex t = own.first_tet(c);
        const std::uint64_t id = piece.cell_ids[t];
        EXPECT_EQ(nodes_of(own, c, &piece), nodes_of(cells, id, nullptr));
        EXPECT_EQ(of_piece.region_of(t), parts.region_of(cells.first_tet(id)));
        EXPECT_EQ(piece.tet_part[t] == k, t < piece.own_tets);
        t < piece.own_tets ? void(++owned[id]) : void(ghosts.insert(id));
      }
      EXPECT_EQ(ghosts, ghosts_of(parts, division, k));
      for (std::size_t v = 0; v < of_piece.points(); ++v) {
        EXPECT_EQ(piece.mesh.points[v], mesh.points[piece.point_ids[v]]);
        if (piece.point_part[v] == k) ++owned_points[piece.point_ids[v]];
      }
      for (std::size_t f = 0; f < own.faces(); ++f) {
        const std::size_t first = own.first_face(f);
        const std::uint64_t id = piece.face_ids[first];
        EXPECT_EQ(of_piece.patch_of(first), parts.patch_of(cells.first_face(id)));
        if (piece.tet_part[of_piece.sides()[first].tet] == k) ++owned_faces[id];
      }
    }
    for (const auto& counts : {owned, owned_points, owned_faces})
      EXPECT_TRUE(std::ranges::all_of(counts, [](int n) { return n == 1; }));
  }
}

TEST(Piece, HasItsShareOfCurvesSetsAndFields) {
  const TetMesh mesh = testing::rich_mesh(4);
  const MeshParts parts(mesh);
  std::vector<MeshField> fields{{"at", false, 3, {}}, {"of", true, 1, {}}};
  for (const Vec3& p : mesh.points) fields[0].values.insert(fields[0].values.end(), {p.x, p.y, p.z});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) fields[1].values.push_back(static_cast<double>(t));
  Pieces pieces(parts, io::divide(mesh, 6, Partitioner::kCurve), fields);
  std::vector<int> edges(mesh.curve_edges.size(), 0);
  std::vector<std::set<std::uint64_t>> members(mesh.sets.size());
  for (std::uint32_t k = 0; k < 6; ++k) {
    const Piece piece = pieces.piece(k);
    for (std::size_t e = 0; e < piece.edge_ids.size(); ++e) edges[piece.edge_ids[e]] += piece.edge_part[e] == k;
    ASSERT_EQ(piece.mesh.sets.size(), mesh.sets.size());
    for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
      const NamedSet& set = piece.mesh.sets[s];
      EXPECT_TRUE(std::ranges::is_sorted(set.members));
      const auto& ids = set.kind == NamedSet::Kind::kNodes   ? piece.point_ids
                        : set.kind == NamedSet::Kind::kEdges ? piece.edge_ids
                        : set.kind == NamedSet::Kind::kFaces ? piece.face_ids
                                                             : piece.cell_ids;
      for (const std::uint32_t m : set.members) members[s].insert(ids[m]);
    }
    for (std::size_t v = 0; v < piece.mesh.points.size(); ++v)
      EXPECT_EQ(piece.fields[0].values[3 * v + 1], piece.mesh.points[v].y);
    for (std::size_t t = 0; t < piece.mesh.tets.size(); ++t)
      EXPECT_EQ(piece.fields[1].values[t], static_cast<double>(piece.cell_ids[t]));
  }
  EXPECT_TRUE(std::ranges::all_of(edges, [](int n) { return n == 1; }));
  for (std::size_t s = 0; s < mesh.sets.size(); ++s)
    EXPECT_TRUE(std::ranges::equal(members[s], mesh.sets[s].members)) << mesh.sets[s].name;
}

/// All files below a folder, by name.
std::map<std::string, std::string> all_files(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    all[fs::relative(entry.path(), folder).string()] =
        std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return all;
}

fs::path target_of(const FormatInfo& info) {
  if (info.endings.empty()) return "polyMesh";
  return "m" + std::string(info.endings.substr(0, info.endings.find(' ')));
}

std::vector<FormatInfo> formats_in_parts() {
  std::vector<FormatInfo> all;
  for (const FormatInfo& info : known_formats())
    if (info.holds.parts) all.push_back(info);
  return all;
}

TEST(FilesInParts, AreTheSameForAnyNumberOfThreads) {
  EXPECT_GE(formats_in_parts().size(), 2U);
  for (const FormatInfo& info : formats_in_parts())
    for (const TetMesh& mesh : meshes_to_divide()) {
      SCOPED_TRACE(info.name);
      const auto with = [&](int threads) {
        const TemporaryFolder folder;
        RunContext context;
        context.threads = threads;
        write_mesh(folder / target_of(info).string(), mesh, context, {.parts = 3});
        return all_files(folder / "");
      };
      const auto one = with(1);
      EXPECT_FALSE(one.empty());
      EXPECT_EQ(one, with(2));
    }
}

TEST(FilesInParts, KnowNoTime) {
  // HDF5 would write down the second in which a dataset was made.
  const auto file = [](const std::string& name) {
    const TemporaryFolder folder;
    write_mesh(folder / name, testing::rich_mesh(2));
    return all_files(folder / "");
  };
  const std::vector<FormatInfo> all = known_formats();
  for (const std::string name : {"vtkhdf", "med", "xdmf", "cgns"}) {
    const auto info = std::ranges::find_if(all, [&](const FormatInfo& i) { return i.name == name; });
    if (!info->writes_mesh) continue;
    const auto before = file("m." + name);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    EXPECT_EQ(before, file("m." + name)) << name;
  }
}

TEST(FilesInParts, OfGmshHoldTheWholeMesh) {
  for (const TetMesh& mesh : meshes_to_divide()) {
    const TemporaryFolder folder;
    write_mesh(folder / "one.msh", mesh);
    write_mesh(folder / "parts.msh", mesh, {}, {.parts = 3});
    write_mesh(folder / "split.msh", mesh, {}, {.parts = 3, .split_files = true});
    EXPECT_FALSE(fs::exists(folder / "split.msh"));
    const TetMesh one = read_mesh(folder / "one.msh"), parts = read_mesh(folder / "parts.msh");
    EXPECT_EQ(parts.points.size(), one.points.size());
    EXPECT_EQ(parts.tets.size(), one.tets.size());
    EXPECT_EQ(parts.wide_cells.size(), one.wide_cells.size());
    EXPECT_EQ(parts.region_names, one.region_names);
    EXPECT_EQ(parts.patch_names, one.patch_names);
    EXPECT_EQ(parts.boundary.size(), one.boundary.size());
    EXPECT_EQ(parts.interfaces.size(), one.interfaces.size());
    EXPECT_EQ(parts.curve_edges.size(), one.curve_edges.size());
    ASSERT_EQ(parts.sets.size(), one.sets.size());
    for (std::size_t s = 0; s < one.sets.size(); ++s) {
      EXPECT_EQ(parts.sets[s].name, one.sets[s].name);
      EXPECT_EQ(parts.sets[s].members.size(), one.sets[s].members.size());
    }
    std::size_t elements = 0;
    const MeshParts whole(mesh);
    Pieces pieces(whole, io::divide(mesh, 3, Partitioner::kCurve));
    for (std::uint32_t k = 0; k < 3; ++k) {
      const TetMesh alone = read_mesh(folder / ("split_" + std::to_string(k + 1) + ".msh"));
      elements += alone.tets.size();
      EXPECT_GT(alone.tets.size(), pieces.own_tets(k).size());
      EXPECT_EQ(alone.tets.size(), pieces.own_tets(k).size() + pieces.ghosts_of(k).size());
    }
    EXPECT_GT(elements, mesh.tets.size());
  }
}

TEST(FilesInParts, ReplaceAnEarlierSetAsAWhole) {
  const TemporaryFolder folder;
  const TetMesh mesh = testing::rich_mesh(2);
  const auto pieces = [&] { return std::distance(fs::directory_iterator(folder / "m"), fs::directory_iterator()); };
  write_mesh(folder / "m.pvtu", mesh, {}, {.parts = 5});
  EXPECT_EQ(pieces(), 5);
  write_mesh(folder / "m.pvtu", mesh, {}, {.parts = 2});
  EXPECT_EQ(pieces(), 2);
  // A folder with something else in it is nobody's to replace.
  std::ofstream(folder / "m/notes.txt") << "mine";
  EXPECT_THROW(write_mesh(folder / "m.pvtu", mesh, {}, {.parts = 3}), OutputError);
  EXPECT_EQ(pieces(), 3);
}

/// While it lives, no file can grow beyond so many bytes.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST(FilesInParts, LeaveNothingBehindWhenTheyFail) {
  for (const FormatInfo& info : formats_in_parts()) {
    SCOPED_TRACE(info.name);
    const TemporaryFolder folder;
    const FileSizeLimit limit(3000);  // small files fit, the ones behind them do not
    EXPECT_THROW(write_mesh(folder / target_of(info).string(), testing::rich_mesh(6), {}, {.parts = 3}), OutputError);
    EXPECT_TRUE(fs::is_empty(folder / ""));
  }
}

TEST(FilesInParts, AreRefusedInWords) {
  const TemporaryFolder folder;
  const TetMesh mesh = testing::two_tets();
  EXPECT_THROW(write_mesh(folder / "a.vtu", mesh, {}, {.parts = 2}), OptionError);
  EXPECT_THROW(write_mesh(folder / "a.stl", mesh, {}, {.parts = 2}), OptionError);
  EXPECT_THROW(write_mesh(folder / "a.pvtu", mesh, {}, {.parts = 3}), OptionError);
  EXPECT_THROW(write_mesh(folder / "a.pvtu", mesh, {}, {.parts = 2, .split_files = true}), OptionError);
  if (!has_metis()) {
    EXPECT_THROW(write_mesh(folder / "a.pvtu", mesh, {}, {.parts = 2, .partitioner = Partitioner::kMetis}),
                 OptionError);
  }
  TetMesh surface = mesh;
  surface.tets.clear();
  EXPECT_THROW(write_mesh(folder / "a.pvtu", surface, {}, {.parts = 2}), OptionError);
  EXPECT_TRUE(fs::is_empty(folder / ""));
}

TEST(FilesInParts, KeepProcessorsOfALargerDivision) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "constant");
  const TetMesh mesh = testing::rich_mesh(2);
  write_mesh(folder / "constant/polyMesh", mesh, {}, {.parts = 4});
  std::ofstream(folder / "processor1/field") << "mine";
  write_mesh(folder / "constant/polyMesh", mesh, {}, {.parts = 4});
  EXPECT_TRUE(fs::exists(folder / "processor1/field"));
  EXPECT_THROW(write_mesh(folder / "constant/polyMesh", mesh, {}, {.parts = 2}), OutputError);
  EXPECT_TRUE(fs::exists(folder / "processor3/constant/polyMesh/faces"));
}

/// A mesh with regions, patches and curves.
TetMesh mesh_of_shares() {
  TetMesh mesh = testing::rich_mesh(4);
  mesh.sets.clear(), mesh.interfaces.clear(), mesh.interface_patch.clear();
  return mesh;
}

TEST(Pieces, OfSharesAreThoseOfTheWhole) {
  const TetMesh mesh = mesh_of_shares();
  for (const int ranks : {1, 2, 5}) {
    io::Division division{static_cast<std::uint32_t>(ranks), {}};
    for (const std::size_t t : std::views::iota(std::size_t{0}, mesh.tets.size()))
      division.part.push_back(static_cast<std::uint32_t>(t * static_cast<std::size_t>(ranks) / mesh.tets.size()));
    const MeshParts parts(mesh);
    Pieces pieces(parts, division);
    std::vector<Piece> whole;
    for (std::uint32_t k = 0; k < pieces.count(); ++k) whole.push_back(pieces.piece(k));
    run_virtual_ranks(ranks, [&](Ranks& here) {
      TetMesh share = mesh;
      const auto rank = static_cast<std::uint32_t>(here.rank());
      const auto is_other = [&](std::size_t t) { return division.part[t] != rank; };
      share.tets.clear(), share.region.clear();
      for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        if (is_other(t)) continue;
        share.tets.push_back(mesh.tets[t]);
        if (!mesh.region.empty()) share.region.push_back(mesh.region[t]);
      }
      const Piece made = io::piece_of_share(share, Comm(&here));
      const Piece& there = whole[rank];
      EXPECT_EQ(made.mesh, there.mesh);
      EXPECT_EQ(made.own_tets, there.own_tets);
      EXPECT_EQ(made.point_ids, there.point_ids);
      EXPECT_EQ(made.cell_ids, there.cell_ids);
      EXPECT_EQ(made.face_ids, there.face_ids);
      EXPECT_EQ(made.edge_ids, there.edge_ids);
      EXPECT_EQ(made.tet_part, there.tet_part);
      for (std::size_t v = 0; v < made.point_part.size(); ++v)
        EXPECT_EQ(made.point_part[v] == rank, there.point_part[v] == rank);
    });
  }
}

TEST(Pieces, OfSharesAreWrittenByTheirRanksOrNotAtAll) {
  const TetMesh mesh = mesh_of_shares();
  const TemporaryFolder folder;
  run_virtual_ranks(3, [&](Ranks& here) {
    TetMesh share = mesh;
    keep_share(share, Comm(&here));
    RunContext context;
    context.ranks = &here;
    write_shares((folder / "mesh.pvtu").string(), share, context);
    EXPECT_EQ(read_mesh((folder / ("mesh/mesh_000" + std::to_string(here.rank()) + ".vtu")).string()).points.size(),
              io::piece_of_share(share, Comm(&here)).mesh.points.size());
    EXPECT_THROW(write_shares((folder / "no/folder/mesh.pvtu").string(), share, context), OutputError);
  });
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "mesh"), fs::directory_iterator()), 3);
  EXPECT_FALSE(fs::exists(folder / "no"));
}

}  // namespace
}  // namespace octafront
