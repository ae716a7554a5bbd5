// Meshes with a field of sizes, in the formats whose readers know of fields, and in files beside those of the others.

#include <octafront/io.h>

#include "formats/containers/input.h"
#include "formats/containers/named_file.h"
#include "formats/containers/scanner.h"
#include "formats/files/formats.h"
#include "formats/files/size_readers.h"

#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error);
}

/// MEDIT's .sol as text: fields of vertices or tetrahedra, each section with a count, the number of fields and the kind
/// of each (1: a number, 2: a vector, 3: a tensor), then their values. Fields have numbers and no names.
class MeditSolution {
 public:
  MeditSolution(const io::Input& asked, const io::Input& input, io::RawMesh& raw)
      : asked_(asked), scan_(input, '#'), raw_(raw) {}

  void read() {
    while (!scan_.at_end()) {
      const std::string_view word = scan_.word();
      if (word == "SolAtVertices") read_section(raw_.field.at_points, raw_.points.size());
      if (word == "SolAtTetrahedra") read_section(raw_.field.at_tets, raw_.tets.size());
      if (word == "SolAtTriangles") read_section(raw_.field.at_triangles, raw_.triangles.size());
    }
  }

 private:
  void read_section(std::vector<double>& to, std::size_t expected) {
    const std::int64_t count = scan_.integer("the number of values"), fields = scan_.integer("the number of fields");
    if (count != static_cast<std::int64_t>(expected))
      scan_.fail(fmt::format("{} values, but the mesh beside it has {} places for them; it belongs to another mesh",
                             count, expected));
    std::vector<int> components;
    for (std::int64_t f = 0; f < fields && f < 100; ++f) {
      const std::int64_t kind = scan_.integer("the kind of a field");
      if (kind < 1 || kind > 3) scan_.fail(fmt::format("a field of the kind {}; 1, 2 and 3 are known", kind));
      components.push_back(kind == 1 ? 1 : kind == 2 ? 3 : 6);
    }
    std::optional<std::size_t> wanted;
    for (std::size_t f = 0; f < components.size(); ++f)
      if (components[f] == 1 && raw_.field.offer(asked_, fmt::format("solution_{}", f + 1))) wanted = f;
    for (std::int64_t i = 0; i < count; ++i)
      for (std::size_t f = 0; f < components.size(); ++f)
        for (int k = 0; k < components[f]; ++k) {
          const double value = scan_.number("a value");
          if (f == wanted) to.push_back(value);
        }
  }

  const io::Input& asked_;
  io::Scanner scan_;
  io::RawMesh& raw_;
};

/// TetGen's .mtr: "nodes values", then the values of each node.
void read_mtr(const io::Input& asked, const io::Input& input, io::RawMesh& raw) {
  io::Scanner scan(input, '#');
  const std::int64_t nodes = scan.integer("the number of nodes"), columns = scan.integer("the number of values each");
  if (nodes != static_cast<std::int64_t>(raw.points.size()))
    scan.fail(fmt::format("{} nodes, but the mesh has {}; it belongs to another mesh", nodes, raw.points.size()));
  if (columns != 1 || !raw.field.offer(asked, "mtr")) return;
  for (std::int64_t i = 0; i < nodes; ++i) raw.field.at_points.push_back(scan.number("a size"));
}

/// Values that stand in a file beside the mesh.
void read_beside(const io::Input& input, io::RawMesh& raw) {
  const bool is_medit = raw.format.starts_with("MEDIT");
  if (!is_medit && raw.format != "TetGen") return;
  const fs::path values = io::sibling_file(input, is_medit ? ".sol" : ".mtr");
  if (values.empty()) return;
  const io::LoadedFile file(values, input.context);
  is_medit ? MeditSolution(input, file.input(), raw).read() : read_mtr(input, file.input(), raw);
}

/// Sizes that are above 0; `what` has them.
const std::vector<double>& checked(const io::Input& input, const std::vector<double>& sizes, const char* what) {
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (!std::isfinite(sizes[i]) || sizes[i] <= 0)
      input.fail(fmt::format("{} {} has size {}: sizes must be above 0", what, i, sizes[i]));
  return sizes;
}

[[noreturn]] void refuse_field(const io::Input& input, const io::RawMesh& raw) {
  const std::vector<std::string>& names = raw.field.names;
  const std::string& wanted = *input.field;
  if (names.empty())
    input.fail(fmt::format(
        "has no field of single numbers that are sizes{}; of {} such are read: VTU and VTK arrays, Gmsh's $NodeData "
        "and $ElementData, the .sol beside a MEDIT mesh, the .mtr beside TetGen's files, attributes of XDMF, MED's "
        "fields",
        wanted.empty() ? "" : ", not " + io::in_quotes(wanted), raw.format));
  if (wanted.empty())
    input.fail(fmt::format("has the fields {}: say which one has the sizes, as {}:{}", io::names_in_quotes(names),
                           input.name, names.front()));
  input.fail(fmt::format("has no field {} of single numbers for all its points or elements; there are {}",
                         io::in_quotes(wanted), io::names_in_quotes(names)));
}

SizeMesh size_mesh_of(const io::Input& input, io::RawMesh raw) {
  if (raw.points.empty() || (raw.tets.empty() && raw.triangles.empty()))
    input.fail("holds no tetrahedra or triangles: there is nothing that its values could be linear in");
  const bool is_ambiguous = input.field->empty() && raw.field.names.size() != 1;
  const bool has_tets = !raw.tets.empty();
  const std::vector<double>& of_elements = has_tets ? raw.field.at_tets : raw.field.at_triangles;
  const bool at_points = raw.field.at_points.size() == raw.points.size();
  const bool at_elements = of_elements.size() == (has_tets ? raw.tets.size() : raw.triangles.size());
  if (is_ambiguous || !(at_points || at_elements)) refuse_field(input, raw);
  SizeMesh mesh;
  if (at_points) mesh.point_sizes = checked(input, raw.field.at_points, "point");
  if (!at_points) mesh.element_sizes = checked(input, of_elements, "element");
  mesh.name = input.name + (input.field->empty() ? "" : ":" + *input.field);
  mesh.points = std::move(raw.points);
  mesh.tets = std::move(raw.tets);
  if (!has_tets) mesh.triangles = std::move(raw.triangles);
  return mesh;
}

/// Cells that are none of ours: a background grid's.
bool looks_like_grid(const io::RawMesh& raw) {
  const bool has_cubes_alone = raw.tets.size() <= 6 * raw.hexahedra && raw.wide_cells.empty() && raw.triangles.empty();
  return raw.format == "VTU" && has_cubes_alone && raw.hexahedra + raw.other_elements > 0;
}

}  // namespace

io::RawMesh read_with_field(const io::Input& input) {
  io::RawMesh raw = io::read_raw_mesh(input);
  read_beside(input, raw);
  return raw;
}

SizeMesh read_size_mesh_bytes(const io::Input& input, const std::string& field) {
  io::Input asked = input;
  asked.field = &field;
  return size_mesh_of(asked, read_with_field(asked));
}

std::shared_ptr<const SizeMesh> read_size_mesh(const std::string& file, const std::string& field,
                                               const RunContext& context) {
  return std::make_shared<const SizeMesh>(read_size_mesh_bytes(io::LoadedFile(file, context).input(), field));
}

void read_sizes_into(SizeOptions& options, const std::string& named, const RunContext& context) {
  const std::size_t colon = named.rfind(':');
  const bool has_field =
      colon != std::string::npos && colon > 0 && !is_there(named) && is_there(named.substr(0, colon));
  const io::LoadedFile file(has_field ? named.substr(0, colon) : named, context);
  const std::string field = has_field ? named.substr(colon + 1) : "";
  io::Input asked = file.input();
  asked.field = &field;
  io::RawMesh raw = read_with_field(asked);
  if (!looks_like_grid(raw)) {
    options.mesh = std::make_shared<const SizeMesh>(size_mesh_of(asked, std::move(raw)));
  } else if (has_field) {
    asked.fail("is a background grid, which is given without the name of a field");
  } else {
    // A field that was written comes back as it was, unless it was edited: sizes change no faster by themselves.
    options.field = read_size_field(asked.name, options.gradation.value_or(kSteepestGradation), context);
  }
}

}  // namespace octafront
