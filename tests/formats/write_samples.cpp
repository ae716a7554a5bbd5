// Writes a mesh that has everything, bent, in every format that this build has, linear and of second order:
//   write_samples FOLDER
// leaves FOLDER/linear/..., FOLDER/second/..., what is text or binary also as text in FOLDER/linear_text/..., the
// tetrahedra alone in FOLDER/linear_cells/..., one with wedges and pyramids in FOLDER/mixed_linear/... and
// FOLDER/mixed_second/..., and in each expected.json: what a judge must find; of orders 3 and 4 in FOLDER/third/... and
// FOLDER/fourth/..., bent by a map that judges know; with fields in FOLDER/linear_fields/...
// and so on, for field_judges.py.

#include <octafront/field_files.h>
#include <octafront/io.h>

#include "formats/parts/mesh_parts.h"
#include "formats/parts/mixed_cells.h"
#include "support/mixed_mesh.h"
#include "support/rich_mesh.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace {

using namespace octafront;
namespace fs = std::filesystem;

/// Bends the mesh, mid-side nodes like all others, so that their order shows in volumes.
TetMesh bent(TetMesh mesh) {
  for (Vec3& p : mesh.points)
    p = p + Vec3{0.08 * std::sin(1.1 * p.y + 0.3), 0.07 * std::cos(1.3 * p.z), 0.09 * std::sin(0.9 * p.x + p.y)};
  return mesh;
}

/// Bends a mesh of order 3 or 4 by polynomials of degree 3, which its elements hold exactly: the same in judges.py.
TetMesh bent_cubically(TetMesh mesh) {
  for (Vec3& p : mesh.points)
    p = p + Vec3{0.004 * p.y * p.y * p.z, 0.003 * p.z * p.z * p.z - 0.002 * p.x * p.z, 0.005 * p.x * p.x * p.y};
  return mesh;
}

/// Shape functions of a simplex of `corners` corners at barycentric coordinates, and their derivatives after the
/// coordinates 1 ... : corners, then mid-side nodes in VTK's order.
struct Shape {
  std::vector<std::array<double, 3>> gradient;
};
Shape shape(const std::array<double, 4>& l, std::size_t corners, bool second) {
  constexpr std::array<std::array<int, 2>, 6> kMids{{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
  const auto slope = [](std::size_t i, std::size_t axis) { return i == 0 ? -1.0 : i == axis + 1 ? 1.0 : 0.0; };
  Shape s;
  for (std::size_t i = 0; i < corners; ++i) {
    auto& g = s.gradient.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) g[a] = slope(i, a) * (second ? 4 * l[i] - 1 : 1);
  }
  for (std::size_t m = 0; second && m < (corners == 4 ? 6 : 3); ++m) {
    const auto i = static_cast<std::size_t>(kMids[m][0]), j = static_cast<std::size_t>(kMids[m][1]);
    auto& g = s.gradient.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) g[a] = 4 * (l[i] * slope(j, a) + l[j] * slope(i, a));
  }
  return s;
}

constexpr std::array<std::array<double, 2>, 4> kGauss{{{0.0694318442029737, 0.1739274225687269},
                                                       {0.3300094782075719, 0.3260725774312731},
                                                       {0.6699905217924281, 0.3260725774312731},
                                                       {0.9305681557970263, 0.1739274225687269}}};

std::array<Vec3, 3> jacobian(const Shape& s, std::span<const VertexIndex> nodes, const std::vector<Vec3>& points) {
  std::array<Vec3, 3> j{};
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (std::size_t a = 0; a < 3; ++a) j[a] = j[a] + points[nodes[k]] * s.gradient[k][a];
  return j;
}

double volume(std::span<const VertexIndex> nodes, const std::vector<Vec3>& points) {
  double sum = 0;
  for (const auto& [u, wu] : kGauss)
    for (const auto& [v, wv] : kGauss)
      for (const auto& [w, ww] : kGauss) {
        // The cube collapsed to the tetrahedron.
        const double y = v * (1 - u), z = w * (1 - u) * (1 - v);
        const auto j = jacobian(shape({1 - u - y - z, u, y, z}, 4, nodes.size() > 4), nodes, points);
        sum += wu * wv * ww * (1 - u) * (1 - u) * (1 - v) * dot(cross(j[0], j[1]), j[2]);
      }
  return sum;
}

Vec3 vector_area(std::span<const VertexIndex> nodes, const std::vector<Vec3>& points) {
  Vec3 sum{};
  for (const auto& [u, wu] : kGauss)
    for (const auto& [v, wv] : kGauss) {
      const double y = v * (1 - u);
      const auto j = jacobian(shape({1 - u - y, u, y, 0}, 3, nodes.size() > 3), nodes, points);
      sum = sum + cross(j[0], j[1]) * (wu * wv * (1 - u));
    }
  return sum;
}

double area(std::span<const VertexIndex> nodes, const std::vector<Vec3>& points) {
  double sum = 0;
  for (const auto& [u, wu] : kGauss)
    for (const auto& [v, wv] : kGauss) {
      const double y = v * (1 - u);
      const auto j = jacobian(shape({1 - u - y, u, y, 0}, 3, nodes.size() > 3), nodes, points);
      sum += length(cross(j[0], j[1])) * (wu * wv * (1 - u));
    }
  return sum;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + '"';
}

/// Size and measure of each part: volume, or length of the vector area, unsigned face by face.
std::string expected(const TetMesh& mesh) {
  const io::MeshParts parts(mesh);
  io::CellRoom tet;
  io::FaceRoom face;
  double all = 0;
  for (std::size_t t = 0; t < parts.tets(); ++t) all += volume(parts.tet_nodes(t, tet), mesh.points);
  std::string out = fmt::format("{{\"nodes\": {}, \"tets\": {}, \"boundary\": {}, \"volume\": {:.17g}, \"parts\": [\n",
                                mesh.points.size(), mesh.tets.size(), mesh.boundary.size(), all);
  constexpr std::array kOrigins{"region", "patch", "curve", "set"};
  constexpr std::array kKinds{"nodes", "edges", "faces", "elements"};
  for (const io::Part& part : parts.parts()) {
    double measure = 0, curved = 0;
    for (const std::uint32_t m : part.members) {
      if (part.kind == NamedSet::Kind::kElements) measure += volume(parts.tet_nodes(m, tet), mesh.points);
      if (part.kind != NamedSet::Kind::kFaces) continue;
      measure += length(vector_area(parts.face_nodes(m, face), mesh.points));
      curved += area(parts.face_nodes(m, face), mesh.points);
    }
    out += fmt::format(
        "  {{\"origin\": \"{}\", \"kind\": \"{}\", \"name\": {}, \"named\": {}, \"number\": {}, \"size\": {}, "
        "\"nodes\": {}, \"measure\": {:.17g}, \"area\": {:.17g}}}{}\n",
        kOrigins[static_cast<std::size_t>(part.origin)], kKinds[static_cast<std::size_t>(part.kind)], quoted(part.name),
        part.is_named, part.number, part.members.size(), parts.nodes_of(part).size(), measure, curved,
        &part == &parts.parts().back() ? "" : ",");
  }
  return out + "]}\n";
}

/// Of a mesh whose tetrahedra and wedges fill the same space exactly: their volumes and areas are those of the
/// tetrahedra, their numbers those of wedges, pyramids and quadrilaterals.
std::string expected_mixed(const TetMesh& mesh) {
  const io::WithoutDiagonals without = io::without_diagonals(mesh);
  const io::MeshParts parts(mesh);
  const io::MixedCells cells(parts);
  io::CellRoom tet;
  io::FaceRoom face;
  const auto count = [&](io::MixedCells::Kind kind) { return cells.end(kind) - cells.begin(kind); };
  std::string out = fmt::format(
      "{{\"nodes\": {}, \"tetra\": {}, \"pyramid\": {}, \"wedge\": {}, \"triangle\": {}, \"quad\": {}, \"parts\": [\n",
      mesh.points.size() - without.diagonals, count(io::MixedCells::kTet), count(io::MixedCells::kPyramid),
      count(io::MixedCells::kWedge), cells.triangles(), cells.quads());
  std::string comma;
  for (const io::Part& part : parts.parts()) {
    if (part.kind != NamedSet::Kind::kElements && part.kind != NamedSet::Kind::kFaces) continue;
    double measure = 0;
    for (const std::uint32_t m : part.members)
      measure += part.kind == NamedSet::Kind::kElements ? volume(parts.tet_nodes(m, tet), mesh.points)
                                                        : area(parts.face_nodes(m, face), mesh.points);
    const bool is_set = part.origin == io::Part::Origin::kSet;
    out += fmt::format("{}  {{\"kind\": \"{}\", \"set\": {}, \"name\": {}, \"size\": {}, \"measure\": {:.17g}}}", comma,
                       part.kind == NamedSet::Kind::kElements ? "elements" : "faces", is_set, quoted(part.name),
                       cells.members(part).size(), measure);
    comma = ",\n";
  }
  return out + "\n]}\n";
}

/// Values that tell their place: that of a node, or the middle of the corners of an element, tetrahedron or not.
std::vector<MeshField> fields_on(const TetMesh& mesh) {
  std::vector<MeshField> fields{
      {"T", false, 1, {}}, {"flow", false, 3, {}}, {"T", true, 1, {}}, {"heat flux", true, 3, {}}};
  const auto t = [](const Vec3& p) { return 1 + 2 * p.x - 3 * p.y + p.z / 2; };
  for (const Vec3& p : mesh.points) {
    fields[0].values.push_back(t(p));
    for (const double v : {p.x + 1, 2 * p.y - 1, 3 * p.z}) fields[1].values.push_back(v);
  }
  const io::MeshParts parts(mesh);
  const io::MixedCells cells(parts);
  for (TetIndex tet = 0; tet < mesh.tets.size(); ++tet) {
    const std::size_t cell = cells.cell_of(tet), corners = 4 + static_cast<std::size_t>(cells.kind(cell));
    Vec3 middle{};
    for (std::size_t k = 0; k < corners; ++k)
      middle = middle + mesh.points[cells.node(cell, k)] / static_cast<double>(corners);
    fields[2].values.push_back(t(middle));
    for (const double v : {middle.y + 4, 2 - middle.z, middle.x / 2}) fields[3].values.push_back(v);
  }
  return fields;
}

template <class Wanted>
void write_those(const fs::path& folder, const TetMesh& mesh, WriteOptions options, const Wanted& wanted,
                 const std::vector<MeshField>& fields = {}) {
  fs::create_directories(folder);
  if (mesh.high_order == 0)
    write_text(folder / "expected.json", mesh.wide_cells.empty() ? expected(mesh) : expected_mixed(mesh));
  for (const FormatInfo& info : known_formats()) {
    if (!info.writes_mesh || !wanted(info)) continue;
    const std::string ending(info.endings.substr(0, info.endings.find(' ')));
    const fs::path file = info.name == "openfoam"
                              ? folder / "case" / "constant" / "polyMesh"
                              : folder / (std::string(info.name) + (ending.empty() ? ".msh" : ending));
    fs::create_directories(file.parent_path());
    options.format = info.name;
    write_mesh(file, mesh, fields, {}, options);
  }
}

void write_all(const std::string& folder, const TetMesh& mesh) {
  write_those(folder, mesh, {}, [](const FormatInfo&) { return true; });
  write_those(folder + "_text", mesh, {.ascii = true}, [](const FormatInfo& info) { return info.also_text; });
  write_those(folder + "_cells", mesh, {.cells_only = true},
              [](const FormatInfo& info) { return info.name != "openfoam" && !info.writes_surface; });
}

void write_fields(const std::string& folder, const TetMesh& mesh) {
  const bool is_mixed = !mesh.wide_cells.empty();
  write_those(
      folder + "_fields", mesh, {},
      [&](const FormatInfo& info) {
        const bool in_parts_alone = info.name == "pvtu";  // where fields in wedges are lost
        return info.holds.fields && (!is_mixed || (info.holds.curved_wide_cells && !in_parts_alone));
      },
      fields_on(mesh));
  write_those(
      folder + "_fields_cells", mesh, {.cells_only = true}, [](const FormatInfo& info) { return info.name == "med"; },
      fields_on(mesh));
}

/// As polyhedra with fields, for poly_judges.py.
void write_polyhedra(const std::string& folder, const TetMesh& mesh) {
  write_those(
      folder + "_polyhedra", mesh, {.polyhedral = true}, [](const FormatInfo& info) { return info.holds.polyhedra; },
      fields_on(mesh));
}

/// In five parts, for parts_judges.py.
void write_parts(const std::string& folder, const TetMesh& mesh) {
  write_those(folder + "_parts", mesh, {.parts = 5}, [](const FormatInfo& info) { return info.holds.parts; });
  write_those(folder + "_split", mesh, {.parts = 5, .split_files = true},
              [](const FormatInfo& info) { return info.name == "msh"; });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::string folder = argv[1];
  const TetMesh linear = octafront::testing::rich_mesh(4);
  write_all(folder + "/linear", bent(linear));
  write_all(folder + "/second", bent(octafront::testing::with_mid_nodes(linear)));
  for (const auto& [name, order] : {std::pair{"/third", 3}, std::pair{"/fourth", 4}})
    write_those(folder + name, bent_cubically(octafront::testing::with_high_nodes(linear, order)), {},
                [](const FormatInfo& info) { return info.holds.high_order && info.reads_mesh; });
  write_parts(folder + "/linear", bent(linear));
  write_parts(folder + "/second", bent(octafront::testing::with_mid_nodes(linear)));
  const TetMesh mixed = octafront::testing::mixed_mesh(3);
  write_fields(folder + "/linear", bent(linear));
  write_fields(folder + "/second", bent(octafront::testing::with_mid_nodes(linear)));
  write_fields(folder + "/mixed_linear", mixed);
  write_fields(folder + "/mixed_second",
               octafront::testing::bent_quadratically(octafront::testing::with_mid_nodes(mixed)));
  write_polyhedra(folder + "/linear", linear);
  write_polyhedra(folder + "/mixed_linear", mixed);
  const auto write_mixed = [&](const std::string& name, const TetMesh& mesh, bool FormatHolds::*kind) {
    write_those(folder + name, mesh, {}, [&](const FormatInfo& info) { return info.holds.*kind; });
    write_those(folder + name + "_text", mesh, {.ascii = true},
                [&](const FormatInfo& info) { return info.holds.*kind && info.also_text; });
  };
  write_mixed("/mixed_linear", mixed, &FormatHolds::wide_cells);
  write_parts(folder + "/mixed_linear", mixed);
  write_parts(folder + "/mixed_second",
              octafront::testing::bent_quadratically(octafront::testing::with_mid_nodes(mixed)));
  write_mixed("/mixed_second", octafront::testing::bent_quadratically(octafront::testing::with_mid_nodes(mixed)),
              &FormatHolds::curved_wide_cells);
}
