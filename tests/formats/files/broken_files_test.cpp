#include <octafront/error.h>
#include <octafront/io.h>

#include "formats/small_files.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstring>
#include <random>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <zlib.h>

namespace octafront {
namespace {

using testing::input_error;
using testing::mesh_of;
using testing::surface_of;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

struct BadFile {
  std::string what, bytes;
  std::vector<std::string> fragments;  ///< the message must contain all of them
  std::string name = "model.bin";
};

std::string binary_stl(std::uint32_t claimed, std::size_t records) {
  std::string s(84 + 50 * records, '\0');
  std::memcpy(s.data() + 80, &claimed, 4);
  return s;
}

const std::string kPlyHead =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kVtuHead =
    "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points>"
    "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 "
    "1</DataArray></Points>";

TEST(BadSurfaceFiles, AreNamedForWhatTheyAre) {
  const std::vector<BadFile> files{
      {"image", std::string("\x89PNG\r\n\x1a\n") + std::string(100, 'x'), {"model.bin", "PNG image", "STL"}},
      {"web page", "\n<!DOCTYPE html><html>404</html>", {"web page", "download"}},
      {"gzip", "\x1f\x8b\x08 and so on", {"gzip", "gunzip"}},
      {"zip", std::string("PK\x03\x04", 4) + "...", {"ZIP", "3MF"}},
      // Meshes may be read as surfaces: their readers say what is wrong with them.
      {"vtk", "# vtk DataFile Version 3.0\n", {"ASCII or BINARY"}},
      {"vtu", "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\">", {"no VTU file"}},
      {"step", "ISO-10303-21;\nHEADER;", {"STEP", "octafront mesh"}},
      {"lfs", "version https://git-lfs.github.com/spec/v1\noid sha256:0", {"git lfs pull"}},
      {"iges", std::string(72, ' ') + "S      1\nrest", {"IGES"}},
      {"utf16", std::string("\xff\xfeO\0F\0F\0", 8), {"UTF-16"}},
      {"prose", "Dear reader,\nthis is no model.", {"not a file of a kind that is known here", "Dear reader"}},
      {"blanks", " \n\t \n", {"nothing but blanks"}},
      {"csv", "1,2,3\n4,5,6\n", {"not a file of a kind"}},
  };
  for (const BadFile& f : files) {
    SCOPED_TRACE(f.what);
    const std::string message = input_error([&] { surface_of(f.bytes, f.name); });
    for (const std::string& part : f.fragments) EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST(BadSurfaceFiles, ErrorsSayWhereAndWhat) {
  const std::vector<BadFile> files{
      {"claimed triangles", binary_stl(4000000000U, 2), {"truncated", "4000000000 triangles", "184"}, "a.stl"},
      {"short header", std::string("\1\2\3", 3), {"truncated", "84 bytes"}, "a.stl"},
      {"no triangles", binary_stl(0, 0), {"no triangles"}},
      {"nan in binary",
       [] {
         std::string s = binary_stl(1, 1);
         const std::uint32_t nan = 0x7fc00000;
         std::memcpy(s.data() + 84 + 16, &nan, 4);
         return s;
       }(),
       {"byte 96", "corner 0 of triangle 0", "nan"}},
      {"ascii stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n", {"line 4", "\"zero\"", "coordinate"}},
      {"ascii stl nan", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n", {"line 4", "nan", "not a finite"}},
      {"ascii stl end",
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n",
       {"line 5", "ends here", "truncated"}},
      {"ascii stl word", "solid a\nfacet normal 0 0 1\ninner loop\n", {"line 3", "\"outer\"", "\"inner\""}},
      {"off counts", "OFF\n99999999999 3 0\n0 0 0\n", {"byte", "99999999999 vertices"}},
      {"off vertices", "OFF\n50000000 3 0\n0 0 0\n", {"50000000 vertices", "hold 1 at most", "truncated"}},
      {"off negative", "OFF\n-3 3 0\n0 0 0\n", {"line 2", "-3"}},
      {"off index", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", {"line 6", "corner 3", "3 vertices (0 to 2)"}},
      {"off corners", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4294967295 0 1 2\n", {"4294967295 corners"}},
      {"off infinity", "OFF\n3 1 0\n0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", {"line 4", "inf", "not a finite"}},
      {"off overflow", "OFF\n3 1 0\n0 0 0\n1 0 1e999\n0 1 0\n3 0 1 2\n", {"line 4", "1e999", "not a finite"}},
      {"off binary", "OFF BINARY\n\0\0\0\1", {"binary OFF", "text"}},
      {"off 4d", "4OFF\n1 1 1\n", {"4OFF", "dimensions"}},
      {"obj index", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n", {"line 5", "corner 9", "3 vertices (1 to 3)"}},
      {"obj zero", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", {"line 4", "\"0\"", "counted from 1"}},
      {"obj negative", "v 0 0 0\nv 1 0 0\nf -1 -2 -3\n", {"line 3", "\"-3\"", "does not exist"}},
      {"obj coordinate", "v 0 0 0\nv 1 x 0\nf 1 2 2\n", {"line 2", "\"x\""}},
      {"obj short", "v 0 0 0\nv 1 2\nf 1 2 2\n", {"line 2", "line ends"}},
      {"obj points", "v 0 0 0\nv 1 2 3\n", {"no triangles", "2 vertices"}},
      {"ply type", "ply\nformat ascii 1.0\nelement vertex 3\nproperty quad x\n", {"line 4", "\"quad\""}},
      {"ply format", "ply\nformat morse 1.0\n", {"line 2", "\"morse\""}},
      {"ply no end", kPlyHead, {"end_header", "truncated"}},
      {"ply no faces", kPlyHead + "end_header\n0 0 0 1 0 0 0 1 0\n", {"no faces", "points alone"}},
      {"ply strips", kPlyHead + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n", {"strips"}},
      {"ply no x",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float y\nproperty float z\nelement face 1\n"
       "property list uchar int vertex_indices\nend_header\n1 2 3 4 5 6\n3 0 1 2\n",
       {"line 3", "\"x\""}},
      {"ply claims",
       "ply\nformat binary_little_endian 1.0\nelement vertex 4000000\nproperty float x\nproperty float y\n"
       "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n1234",
       {"4000000", "\"vertex\"", "at most"}},
      {"ply list",
       "ply\nformat binary_big_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
       "property float z\nelement face 1\nproperty list int int vertex_indices\nend_header\n\x7f\xff\xff\xff",
       {"2147483647 values of a list"}},
  };
  for (const BadFile& f : files) {
    SCOPED_TRACE(f.what);
    const std::string message = input_error([&] { surface_of(f.bytes, f.name); });
    EXPECT_TRUE(message.starts_with(f.name)) << message;
    for (const std::string& part : f.fragments) EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST(BadMeshFiles, ErrorsSayWhereAndWhat) {
  const std::string nodes = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n3 1 0 1\n1\n0 0 0\n$EndNodes\n";
  const std::vector<BadFile> files{
      {"old gmsh", "$MeshFormat\n4 0 8\n$EndMeshFormat\n", {"version 4", "4.1"}},
      {"no elements", nodes, {"$Elements", "truncated"}},
      {"bad node", nodes + "$Elements\n1 1 1 1\n3 1 4 1\n1 1 1 1 7\n$EndElements\n", {"line 13", "node 7"}},
      {"unknown type", nodes + "$Elements\n1 1 1 1\n3 1 77 1\n1 1\n$EndElements\n", {"type 77"}},
      {"points only", nodes + "$Elements\n1 1 1 1\n0 1 15 1\n1 1\n$EndElements\n", {"no tetrahedra"}},
      {"big endian", std::string("$MeshFormat\n4.1 1 8\n\0\0\0\1\n$EndMeshFormat\n", 40), {"big-endian"}},
      {"claimed nodes",
       "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n3 1 0 4000000000\n1\n",
       {"4000000000 nodes"}},
      {"medit 2d", "MeshVersionFormatted 2\nDimension 2\n", {"dimension 2"}},
      {"medit index",
       "MeshVersionFormatted 2\nDimension 3\nVertices\n1\n0 0 0 0\nTetrahedra\n1\n1 1 1 2 0\nEnd\n",
       {"line 8", "corner 2"}},
      {"medit end", "MeshVersionFormatted 2\nDimension 3\nVertices\n1\n0 0 0 0\n", {"\"End\"", "truncated"}},
      {"vtk type", "<VTKFile type=\"PolyData\"></VTKFile>", {"VTK XML file", "expected a mesh as VTU"}},
      {"vtu lz4",
       "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkLZ4DataCompressor\">",
       {"vtkLZ4DataCompressor", "zlib"}},
      {"vtu cells", kVtuHead + "</Piece></UnstructuredGrid></VTKFile>", {"\"connectivity\"", "<Cells>"}},
      {"surface", "OFF\n3 1 0\n", {"not a file of a kind that is known here", "VTU"}},
      {"image", "\x89PNG...", {"PNG image"}},
  };
  for (const BadFile& f : files) {
    SCOPED_TRACE(f.what);
    const std::string message = input_error([&] { mesh_of(f.bytes, f.name); });
    for (const std::string& part : f.fragments) EXPECT_TRUE(contains(message, part)) << message;
  }
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// The blocks of a compressed array: `blocks` times the same `bytes`.
std::string packed_array(const std::string& bytes, std::size_t blocks) {
  std::string packed(compressBound(bytes.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  packed.resize(size);
  std::vector<std::uint64_t> header(3 + blocks, size);
  header[0] = blocks;
  header[1] = bytes.size();
  header[2] = 0;
  std::string all = bytes_of(header);
  for (std::size_t b = 0; b < blocks; ++b) all += packed;
  return all;
}

/// One tetrahedron whose array number `bomb` unpacks to half a gigabyte of zeros.
std::string vtu_with_bomb(std::size_t bomb) {
  const std::vector<std::string> tags{
      "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\"",
      "</Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\"",
      "<DataArray type=\"Int64\" Name=\"offsets\"",
      "<DataArray type=\"UInt8\" Name=\"types\"",
      "</Cells><CellData><DataArray type=\"Int32\" Name=\"region\"",
  };
  std::vector<std::string> arrays{packed_array(bytes_of(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}), 1),
                                  packed_array(bytes_of(std::vector<std::int64_t>{0, 1, 2, 3}), 1),
                                  packed_array(bytes_of(std::vector<std::int64_t>{4}), 1), packed_array("\x0a", 1),
                                  packed_array(bytes_of(std::vector<std::int32_t>{0}), 1)};
  if (bomb < arrays.size()) arrays[bomb] = packed_array(std::string(std::size_t{1} << 24, '\0'), 32);
  std::string head =
      "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
      "compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">";
  std::string data;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    head += tags[i] + " format=\"appended\" offset=\"" + std::to_string(data.size()) + "\"/>";
    data += arrays[i];
  }
  return head + "</CellData></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_" + data +
         "</AppendedData></VTKFile>";
}

TEST(BadMeshFiles, NothingIsUnpackedThatCannotBelongToTheMesh) {
  EXPECT_EQ(mesh_of(vtu_with_bomb(99), "a.vtu").tets.size(), 1U);
  for (std::size_t bomb = 0; bomb < 5; ++bomb) {
    rusage before{}, after{};
    const std::string bytes = vtu_with_bomb(bomb);
    getrusage(RUSAGE_SELF, &before);
    const std::string message = input_error([&] { mesh_of(bytes, "a.vtu"); });
    getrusage(RUSAGE_SELF, &after);
    EXPECT_TRUE(contains(message, "its values take at most")) << message;
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 100'000) << "kB";
  }
}

/// A long file with many faces, all the same, and one polygon of many corners.
std::string long_off() {
  constexpr int kPoints = 60000;
  std::string text = "OFF\n" + std::to_string(kPoints) + " " + std::to_string(kPoints + 1) + " 0\n";
  for (int i = 0; i < kPoints; ++i) text += std::to_string(i) + ' ' + std::to_string(i % 2) + " 0\n";
  for (int i = 0; i < kPoints; ++i) text += "3 0 1 2\n";
  text += std::to_string(kPoints);
  for (int i = 0; i < kPoints; ++i) text += ' ' + std::to_string(i);
  return text + '\n';
}

TEST(Reading, TellsHowFarItIsAndCanBeCancelled) {
  const std::string text = long_off();
  std::vector<double> told;
  RunContext context;
  context.progress = [&](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "reading");
    told.push_back(fraction);
  };
  io::read_surface_bytes({"a.off", text, context});
  ASSERT_GE(told.size(), 3U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GT(told.front(), 0);
  EXPECT_LE(told.back(), 1);
  // Between any two of these places no more than some milliseconds pass.
  for (std::size_t at = 0; at < told.size(); ++at) {
    std::atomic<bool> cancel{false};
    std::size_t calls = 0;
    context.cancel = &cancel;
    context.progress = [&](std::string_view, double) { cancel = calls++ == at; };
    EXPECT_THROW(io::read_surface_bytes({"a.off", text, context}), Cancelled) << at;
  }
}

TEST(Reading, FilesOfEveryFormatCanBeCancelled) {
  const testing::TemporaryFolder folder;
  const std::atomic<bool> cancel{true};
  RunContext context;
  context.cancel = &cancel;
  for (const testing::SmallFile& file : testing::small_surface_files()) {
    testing::write_bytes(folder / file.name, file.bytes);
    EXPECT_THROW(read_surface(folder / file.name, context), Cancelled) << file.name;
  }
  for (const testing::SmallFile& file : testing::small_mesh_files()) {
    testing::write_bytes(folder / file.name, file.bytes);
    EXPECT_THROW(read_mesh(folder / file.name, context), Cancelled) << file.name;
  }
}

TEST(Writing, ThatIsCancelledLeavesTheOldFile) {
  const testing::TemporaryFolder folder;
  const std::atomic<bool> cancel{true};
  RunContext context;
  context.cancel = &cancel;
  for (const std::string name : {"a.vtu", "a.msh", "a.mesh"}) {
    testing::write_bytes(folder / name, "old");
    EXPECT_THROW(write_mesh(folder / name, testing::two_tets(), context), Cancelled);
    EXPECT_EQ(testing::file_bytes(folder / name), "old");
  }
}

TEST(BadFiles, MissingEmptyAndFolders) {
  const testing::TemporaryFolder folder;
  EXPECT_TRUE(contains(input_error([&] { read_surface(folder / "none.stl"); }), "no such file"));
  EXPECT_TRUE(contains(input_error([&] { read_surface(folder.path()); }), "directory"));
  EXPECT_TRUE(contains(input_error([&] { read_mesh("/dev/zero"); }), "device"));
  testing::write_bytes(folder / "empty.stl", "");
  EXPECT_TRUE(contains(input_error([&] { read_surface(folder / "empty.stl"); }), "empty"));
}

/// Reading ends in a result or an InputError, whatever the bytes.
template <class Read>
bool is_refused(const Read& read) {
  try {
    read();
  } catch (const InputError&) {
    return true;
  }
  return false;
}

TEST(TruncatedFiles, AreRefusedAtEveryLength) {
  for (const testing::SmallFile& file : testing::small_surface_files()) {
    SCOPED_TRACE(file.name);
    // A line less of OBJ is a file like any other; so is a missing digit, or end of line, at the very end of others.
    const bool is_obj = file.name.ends_with(".obj");
    const std::size_t tail = file.name == "headless.off" || file.name == "glued.off" ? 3 : 2;
    for (std::size_t length = 0; length < file.bytes.size(); ++length) {
      // The first of two solids is a file in itself.
      if (file.name == "text.stl" && length >= file.bytes.find("endsolid") + 8 && length <= file.bytes.find("SOLID"))
        continue;
      const std::string prefix = file.bytes.substr(0, length);
      const bool refused = is_refused([&] { surface_of(prefix, file.name); });
      if (is_obj || length + tail >= file.bytes.size()) continue;
      EXPECT_TRUE(refused) << length << " of " << file.bytes.size();
    }
  }
  for (const testing::SmallFile& file : testing::small_mesh_files()) {
    SCOPED_TRACE(file.name);
    for (std::size_t length = 0; length + 2 < file.bytes.size(); ++length) {
      const std::string prefix = file.bytes.substr(0, length);
      // A text of MEDIT may end behind any of its sections.
      const std::size_t next = file.bytes.find_first_not_of('\n', length);
      if (file.bytes.starts_with("MeshVersion") && prefix.ends_with('\n') && std::isalpha(file.bytes[next])) continue;
      EXPECT_TRUE(is_refused([&] { mesh_of(prefix, file.name); })) << length << " of " << file.bytes.size();
    }
  }
}

TEST(FlippedBytes, NeverCrash) {
  std::mt19937 random(3);
  const auto flip = [&](std::string bytes) {
    for (unsigned k = 0; k <= random() % 4; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    return bytes;
  };
  for (const testing::SmallFile& file : testing::small_surface_files())
    for (int i = 0; i < 2000; ++i) is_refused([&, broken = flip(file.bytes)] { surface_of(broken, file.name); });
  for (const auto& files : {testing::small_mesh_files(), testing::more_mesh_files()})
    for (const testing::SmallFile& file : files)
      for (int i = 0; i < 2000; ++i) is_refused([&, broken = flip(file.bytes)] { mesh_of(broken, file.name); });
}

TEST(TruncatedFiles, OfLinesEndInAMeshOrAnError) {
  for (const testing::SmallFile& file : testing::more_mesh_files())
    for (std::size_t length = 0; length < file.bytes.size(); ++length)
      is_refused([&] { mesh_of(file.bytes.substr(0, length), file.name); });
}

}  // namespace
}  // namespace octafront
