#include "small_files.h"

#include <octafront/error.h>
#include <octafront/io.h>

#include "support/named_surfaces.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

namespace octafront::testing {
namespace {

template <class T>
void append(std::string& bytes, T value, bool big_endian) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// Vertices with a confidence before and a list behind the coordinates, an element of no use, then the faces.
std::string ply(const std::string& format, bool big_endian) {
  std::string s = "ply\nformat ";
  s += format;
  s += " 1.0\ncomment made by a test\nelement vertex 4\nproperty uchar confidence\nproperty float z\n"
       "property double y\nproperty short x\nproperty list uchar short marks\nelement edge 1\n"
       "property int a\nelement face 4\nproperty float weight\nproperty list int ushort vertex_index\n"
       "end_header\n";
  const SurfaceMesh tet = unit_tetrahedron();
  if (format == "ascii") {
    std::ostringstream text;
    for (const Vec3& p : tet.points) text << "7 " << p.z << ' ' << p.y << ' ' << p.x << " 2 5 6\n";
    text << "3\n";
    for (const auto& [a, b, c] : tet.triangles) text << "0.5 3 " << a << ' ' << b << ' ' << c << '\n';
    return s + text.str();
  }
  for (const Vec3& p : tet.points) {
    append<std::uint8_t>(s, 7, big_endian);
    append(s, static_cast<float>(p.z), big_endian);
    append(s, p.y, big_endian);
    append(s, static_cast<std::int16_t>(p.x), big_endian);
    append<std::uint8_t>(s, 2, big_endian);
    append<std::int16_t>(s, 5, big_endian);
    append<std::int16_t>(s, 6, big_endian);
  }
  append<std::int32_t>(s, 3, big_endian);
  for (const Triangle& t : tet.triangles) {
    append(s, 0.5F, big_endian);
    append<std::int32_t>(s, 3, big_endian);
    for (const VertexIndex v : t) append(s, static_cast<std::uint16_t>(v), big_endian);
  }
  return s;
}

std::string ascii_stl() {
  const SurfaceMesh tet = unit_tetrahedron();
  std::ostringstream s;
  s << "solid first part\n";
  for (std::size_t t = 0; t < 4; ++t) {
    if (t == 2) s << "endsolid first part\nSOLID second\r\n";
    s << " facet normal 0 nan -1.#IND\n  outer loop\n";
    for (const VertexIndex v : tet.triangles[t])
      s << "\tVERTEX   " << tet.points[v].x << ' ' << tet.points[v].y << " +" << tet.points[v].z << "e0\n";
    s << "  endloop endfacet\n";
  }
  s << "endsolid\n";
  return s.str();
}

std::string written(const std::string& ending, const TetMesh& mesh) {
  const TemporaryFolder folder;
  write_mesh(folder / ("mesh" + ending), mesh);
  return file_bytes(folder / ("mesh" + ending));
}

std::string written(const std::string& ending, const SurfaceMesh& surface) {
  const TemporaryFolder folder;
  write_surface(folder / ("surface" + ending), surface);
  return file_bytes(folder / ("surface" + ending));
}

constexpr const char* kMsh41 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
2 1 "inlet"
2 2 "walls"
3 1 "left"
$EndPhysicalNames
$Comments
anything
$EndComments
$Entities
1 0 2 2
5 0 0 0 0
1 0 0 0 1 1 0 1 1 0
2 0 0 0 1 1 0 1 2 0
1 0 0 0 1 1 0 1 1 1 1
2 0 0 0 1 1 1 1 2 2 1 2
$EndEntities
$Nodes
2 5 1 9
2 1 1 3
1
2
3
0 0 0 0.1 0.2
1 0 0 0.1 0.2
0 1 0 0.1 0.2
3 1 0 2
4
9
0 0 1
1 1 1
$EndNodes
$Elements
5 9 1 9
0 5 15 1
9 1
2 1 2 1
1 1 3 2
2 2 2 5
2 1 2 4
3 1 4 3
5 2 3 9
6 2 9 4
7 3 4 9
3 1 4 1
8 1 2 3 4
3 2 4 1
10 2 3 4 9
$EndElements
)";

constexpr const char* kMsh22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "inlet"
2 2 "walls"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
9 1 1 1
$EndNodes
$Elements
9
1 15 2 0 1 1
2 2 2 1 1 1 3 2
3 2 2 2 2 1 2 4
4 2 2 2 2 1 4 3
5 2 2 2 2 2 3 9
6 2 2 2 2 2 9 4
7 2 2 2 2 3 4 9
8 4 2 1 1 1 2 3 4
9 4 2 2 2 2 3 4 9
$EndElements
)";

/// The second tetrahedron stands upside down.
constexpr const char* kMedit = R"(MeshVersionFormatted 2
# a comment
Dimension
3
Vertices
6
0 0 0 0
1 0 0 0
0 1 0 0
0 0 1 0
7 7 7 0
1 1 1 0
Edges
1
1 2 0
Triangles
6
1 3 2 1
1 2 4 2
1 4 3 2
2 3 6 2
2 6 4 2
3 4 6 2
Tetrahedra
2
1 2 3 4 1
2 3 6 4 2
RequiredVertices 1
1
End
)";

/// Inline text; cells in mixed order with a line among them.
constexpr const char* kVtuText = R"(<?xml version="1.0"?>
<!-- a comment with <tags> -->
<VTKFile type='UnstructuredGrid' version="0.1">
<UnstructuredGrid><FieldData>
<DataArray type="Int32" Name="patch in &amp; out" NumberOfTuples="1" format="ascii">0</DataArray>
<DataArray type="Int32" Name="patch walls" NumberOfTuples="1" format="ascii">1</DataArray>
</FieldData><Piece NumberOfPoints="5" NumberOfCells="9">
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray></Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 0 2 1 0 1 2 3 0 1 3 0 3 2 1 2 4 1 4 3 2 3 4 1 2 3 4</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">2 5 9 12 15 18 21 24 28</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">3 5 10 5 5 5 5 5 10</DataArray>
</Cells>
<CellData>
<DataArray type="Int32" Name="region" format="ascii">0 0 0 0 0 0 0 0 1</DataArray>
<DataArray type="Int32" Name="patch" format="ascii">-1 0 -1 1 1 1 1 1 -1</DataArray>
</CellData>
</Piece></UnstructuredGrid></VTKFile>
)";

/// Sets with GENERATE, sets of sets, a surface of sets of elements, lines that go on.
constexpr const char* kAbaqus = R"(*Heading
** a comment
*Node, nset=ALL
 10, 0., 0., 0.
 20, 1., 0.,
 30, 0., 1., 0.
 40, 0, 0, 1.0E+00
 50, 1, 1, 1
*Element, type=C3D4, elset=left
 7, 10, 20, 30,
 40
*ELEMENT,TYPE=C3D4,ELSET="Right part"
 9, 20, 30, 40, 50
*Nset, nset=some, generate
 10, 30, 10
*Elset, elset=S_1
 7,
*Elset, elset=outer
 S_1
*Surface, type=ELEMENT, name=in
 outer, S1
*Surface, type=ELEMENT, name=out
 7, S2
 7, S4
 9, S2
 9, S3
 9, S4
*Material, name=steel
*Elastic
 210000., .3
)";

/// Small, large and free fields; Nastran's own reals.
constexpr const char* kNastran = R"(SOL 101
CEND
BEGIN BULK
$ a comment
GRID    1               0.0     0.0     0.0
GRID,2,,1.,0.,0.
GRID*                  3                              0.            1.+0
*                     0.
GRID    4               0.0     0.0     10.-1
GRID*                  5                             1.0             1.0+
*                  1.0D0
CTETRA  1       1       1       2       3       4
CTETRA,2,2,2,3,4,5
CTRIA3  11      3       1       3       2
CTRIA3  12      4       1       2       4
CTRIA3  13      4       1       4       3
CTRIA3  14      4       2       3       5
CTRIA3  15      4       2       5       4
CTRIA3  16      4       3       4       5
ENDDATA
)";

constexpr const char* kVtk5 = R"(# vtk DataFile Version 5.1
by another program
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 float
0 0 0 1 0 0 0 1 0
0 0 1 1 1 1
METADATA
INFORMATION 0

CELLS 9 26
OFFSETS vtktypeint64
0 4 8 11 14 17 20 23 26
CONNECTIVITY vtktypeint64
0 1 2 3 1 2 3 4
0 2 1 0 1 3 0 3 2 1 2 4 1 4 3 2 3 4

CELL_TYPES 8
10 10 5 5 5 5 5 5
CELL_DATA 8
SCALARS region int 1
LOOKUP_TABLE default
0 1 0 0 0 0 0 0
FIELD FieldData 1
patch 1 8 int
-1 -1 0 1 1 1 1 1
)";

constexpr const char* kXdmf = R"(<?xml version="1.0"?>
<Xdmf Version="3.0"><Domain><Grid Name="Grid">
<Geometry GeometryType="XYZ"><DataItem DataType="Float" Dimensions="5 3" Format="XML">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataItem></Geometry>
<Topology TopologyType="Mixed" NumberOfElements="8"><DataItem Dimensions="34" Format="XML">
6 0 1 2 3 6 1 2 3 4 4 0 2 1 4 0 1 3 4 0 3 2 4 1 2 4 4 1 4 3 4 2 3 4</DataItem></Topology>
<Attribute Name="region" Center="Cell"><DataItem Format="XML" Dimensions="8">1 2 0 0 0 0 0 0</DataItem></Attribute>
<Attribute Name="patch" Center="Cell"><DataItem Format="XML" Dimensions="8">0 0 1 2 2 2 2 2</DataItem></Attribute>
</Grid></Domain></Xdmf>
)";

std::string written_as(const std::string& format, const std::string& ending) {
  const TemporaryFolder folder;
  write_mesh(folder / ("mesh" + ending), two_tets(), {}, {.format = format});
  return file_bytes(folder / ("mesh" + ending));
}

}  // namespace

std::vector<SmallFile> small_surface_files() {
  const SurfaceMesh tet = unit_tetrahedron();
  std::vector<SmallFile> files{
      {"text.stl", ascii_stl()},
      {"binary.stl", written(".stl", tet)},
      {"plain.off",
       "OFF # comment\n4 4 6\n0 0 0\n1 0 0 # corner\n\n0 1 0\n0 0 1\n3 1 2 3\n3 0 3 2\n3 0 1 3 255 0 0\n3 0 2 1\n"},
      {"free.off", "OFF 4 4 6 0 0 0 1 0 0 0 1 0 0 0 1 3 1 2 3 3 0 3 2 3 0 1 3 3 0 2 1\n"},
      {"glued.off", "OFF4 4 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n0 0 1\r\n3 1 2 3\r\n3 0 3 2\r\n3 0 1 3\r\n3 0 2 1\r\n"},
      {"headless.off", "4 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 1 2 3\n3 0 3 2\n3 0 1 3\n3 0 2 1\n"},
      {"colour.off",
       "COFF\n4 4 6\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 255 0 0\n0 0 1 4\n3 1 2 3\n3 0 3 2\n3 0 1 3\n3 0 2 1\n"},
      {"all.off",
       "STCNOFF\n4 4 6\n0 0 0 0 0 1 1 0 0 1 .5 .5\n1 0 0 0 0 1 1 0 0 1 0 0\n0 1 0 0 0 1 1 0 0 1 0 0\n"
       "0 0 1 0 0 1 1 0 0 1 0 0\n3 1 2 3\n3 0 3 2\n3 0 1 3\n3 0 2 1\n"},
      {"plain.obj",
       "# comment\nmtllib a.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0 .5 .5 .5\nv 0 0 1\nvt 0 0\nvn 0 0 1\n"
       "g side\ns off\nf 2/1/1 3//1 4/1\nusemtl red\nf -4 \\\n -1 -2\nf 1 2 4\nf 1 3 2 # last\nl 1 2\n"},
      {"text.ply", ply("ascii", false)},
      {"little.ply", ply("binary_little_endian", false)},
      {"big.ply", ply("binary_big_endian", true)},
      {"ours.ply", written(".ply", tet)},
      {"ours.obj", written(".obj", tet)},
      {"ours.off", written(".off", tet)},
  };
  return files;
}

TetMesh two_tets() {
  TetMesh m;
  m.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  m.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  m.region = {0, 1};
  m.boundary = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 4}, {1, 4, 3}, {2, 3, 4}};
  m.patch = {0, 1, 1, 1, 1, 1};
  m.patch_names = {"in & out", "walls"};
  return m;
}

std::vector<SmallFile> small_mesh_files() {
  return {{"ours.vtu", written(".vtu", two_tets())},
          {"ours.msh", written(".msh", two_tets())},
          {"ours.mesh", written(".mesh", two_tets())},
          {"text41.msh", kMsh41},
          {"text22.msh", kMsh22},
          {"other.mesh", kMedit},
          {"text.vtu", kVtuText}};
}

std::vector<SmallFile> more_mesh_files() {
  const auto all = known_formats();
  const bool has_hdf5 =
      std::any_of(all.begin(), all.end(), [](const auto& i) { return i.name == "xdmf" && i.writes_mesh; });
  std::vector<SmallFile> files{{"ours22.msh", written_as("msh22", ".msh")},
                               {"ours.inp", written_as("abaqus", ".inp")},
                               {"ours.bdf", written_as("nastran", ".bdf")},
                               {"ours.unv", written_as("unv", ".unv")},
                               {"ours.vol", written_as("netgen", ".vol")},
                               {"ours_mfem.mesh", written_as("mfem", ".mesh")},
                               {"ours.vtk", written_as("vtk", ".vtk")},
                               {"ours.meshb", written_as("meditb", ".meshb")},
                               {"other.inp", kAbaqus},
                               {"other.bdf", kNastran},
                               {"text.vtk", kVtk5}};
  if (has_hdf5) files.push_back({"text.xdmf", kXdmf});
  return files;
}

std::string file_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string input_error(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError was thrown";
  return {};
}

}  // namespace octafront::testing
