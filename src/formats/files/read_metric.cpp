// Metrics on meshes: MEDIT's .sol and .solb, whose mesh stands in another file, and tensors at the points of VTU and
// VTK.

#include <octafront/io.h>

#include "formats/containers/input.h"
#include "formats/containers/scanner.h"
#include "formats/files/formats.h"
#include "formats/files/size_readers.h"
#include "formats/parts/medit_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

namespace fs = std::filesystem;

bool exists_file(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error);
}

/// What is no size must not become a metric by squaring.
Metric metric_of_size(double h, std::size_t point, const auto& fail) {
  if (!(h > 0)) fail(fmt::format("size {:.6g} at point {}: sizes must be above 0", h, point));
  const Metric metric = Metric::of_size(h);
  const double determinant = metric.determinant();
  if (!(determinant > 0 && std::isfinite(determinant)))
    fail(fmt::format("size {:.6g} at point {} is out of range", h, point));
  return metric;
}

/// One section of values at vertices, of which the first field of tensors counts, or the first of numbers. `Source`
/// yields numbers and knows how to complain.
template <class Source>
std::vector<Metric> metrics_in_section(Source& source) {
  const std::int64_t count = source.integer("the number of values"), fields = source.integer("the number of fields");
  if (count < 0 || fields < 0 || fields > 100)
    source.fail(fmt::format("{} values of {} fields; the file is damaged", count, fields));
  std::vector<int> components;
  for (std::int64_t f = 0; f < fields; ++f) {
    const std::int64_t kind = source.integer("the kind of a field");
    if (kind < 1 || kind > 3) source.fail(fmt::format("a field of the kind {}; 1, 2 and 3 are known", kind));
    components.push_back(kind == 1 ? 1 : kind == 2 ? 3 : 6);
  }
  auto wanted = std::find(components.begin(), components.end(), 6);
  if (wanted == components.end()) wanted = std::find(components.begin(), components.end(), 1);
  if (wanted == components.end()) source.fail("no field of tensors (kind 3) or sizes (kind 1)");
  const auto before = static_cast<std::size_t>(wanted - components.begin());
  std::vector<Metric> metrics;
  for (std::int64_t i = 0; i < count; ++i)
    for (std::size_t f = 0; f < components.size(); ++f) {
      std::array<double, 6> v{};
      for (int k = 0; k < components[f]; ++k) v[static_cast<std::size_t>(k)] = source.real();
      if (f != before) continue;
      // Rows of the lower triangle: xx, xy yy, xz yz zz.
      const auto fail = [&](const std::string& what) { source.fail(what); };
      metrics.push_back(components[f] == 1 ? metric_of_size(v[0], metrics.size(), fail)
                                           : Metric{v[0], v[1], v[3], v[2], v[4], v[5]});
    }
  return metrics;
}

/// A .sol: words, each with its values behind it.
class SolText {
 public:
  explicit SolText(const io::Input& input) : input_(input), scan_(input, '#') {}

  std::vector<Metric> read() {
    while (!scan_.at_end()) {
      const std::string_view word = scan_.word();
      if (word == "Dimension" && integer("the dimension") != 3) fail("values of another dimension than 3");
      if (word == "SolAtVertices") return metrics_in_section(*this);
    }
    input_.fail("has no section SolAtVertices: a metric has its values at vertices");
  }
  std::int64_t integer(std::string_view what) { return scan_.integer(what); }
  double real() { return scan_.number("a value"); }
  [[noreturn]] void fail(const std::string& message) const { scan_.fail(message); }

 private:
  const io::Input& input_;
  io::Scanner scan_;
};

/// A .solb.
class SolBinary {
 public:
  explicit SolBinary(const io::Input& input) : input_(input), file_(input) {}

  std::vector<Metric> read() {
    constexpr std::int32_t kSolAtVertices = 62;
    std::optional<std::vector<Metric>> metrics;
    file_.for_each([&](std::int32_t code) {
      if (code == kSolAtVertices) metrics = metrics_in_section(*this);
      return !metrics;
    });
    if (!metrics) input_.fail("has no section SolAtVertices: a metric has its values at vertices");
    return std::move(*metrics);
  }
  std::int64_t integer(std::string_view what) {
    // The count of values has the words of the version, all else has four bytes.
    return file_.version() < 4 || what != "the number of values" ? file_.get<std::int32_t>()
                                                                 : file_.get<std::int64_t>();
  }
  double real() { return file_.real(); }
  [[noreturn]] void fail(const std::string& message) const { file_.fail(message); }

 private:
  const io::Input& input_;
  io::MeditSections file_;
};

bool is_solution(const fs::path& file) {
  return file.extension() == ".sol" || file.extension() == ".solb";
}

/// The mesh that a .sol belongs to: of its own name, else the one that is adapted.
fs::path mesh_of_solution(const io::Input& input, const std::string& mesh_file) {
  for (const char* ending : {".mesh", ".meshb"}) {
    const fs::path beside = fs::path(input.name).replace_extension(ending);
    if (exists_file(beside)) return beside;
  }
  if (mesh_file.empty()) input.fail("has values of a mesh that is not there: neither .mesh nor .meshb of its name is");
  return mesh_file;
}

MetricMesh on_mesh(io::RawMesh raw, const io::Input& mesh_input) {
  if (raw.tets.empty() && raw.triangles.empty())
    mesh_input.fail("holds no tetrahedra or triangles: there is nothing that a metric could be linear in");
  MetricMesh mesh;
  mesh.points = std::move(raw.points);
  mesh.tets = std::move(raw.tets);
  if (mesh.tets.empty()) mesh.triangles = std::move(raw.triangles);
  return mesh;
}

MetricMesh metric_of_solution(const io::Input& input, const std::string& mesh_file) {
  const bool is_binary = input.bytes.size() >= 4 && input.bytes.substr(0, 4) == std::string_view("\1\0\0\0", 4);
  std::vector<Metric> metrics = is_binary ? SolBinary(input).read() : SolText(input).read();
  const fs::path file = mesh_of_solution(input, mesh_file);
  const io::LoadedFile loaded(file, input.context);
  MetricMesh mesh = on_mesh(io::read_raw_mesh(loaded.input()), loaded.input());
  if (metrics.size() != mesh.points.size())
    input.fail(fmt::format("{} values, but the mesh {} has {} vertices; it belongs to another mesh", metrics.size(),
                           file.string(), mesh.points.size()));
  mesh.metrics = std::move(metrics);
  mesh.name = input.name;
  return mesh;
}

[[noreturn]] void refuse_tensors(const io::Input& input, const io::RawMesh::Field& field) {
  if (field.names.empty())
    input.fail(
        "has no tensors of 6 or 9 numbers at its points; of VTU and VTK such are read, and MEDIT's .sol (a field of "
        "sizes must be named, as FILE:FIELD)");
  if (input.field->empty())
    input.fail(fmt::format("has the fields {}: say which one is the metric, as {}:{}", io::names_in_quotes(field.names),
                           input.name, field.names.front()));
  input.fail(fmt::format("has no field {} of 1, 6 or 9 numbers at all its points; there are {}",
                         io::in_quotes(*input.field), io::names_in_quotes(field.names)));
}

/// Of 6 numbers VTK says xx yy zz xy yz xz, of 9 rows.
Metric metric_of_vtk(const io::Input& input, std::span<const double> v, std::size_t point) {
  if (v.size() == 1) return metric_of_size(v[0], point, [&](const std::string& what) { input.fail(what); });
  if (v.size() == 6) return {v[0], v[3], v[5], v[1], v[4], v[2]};
  const double scale = std::abs(v[0]) + std::abs(v[4]) + std::abs(v[8]);
  constexpr double kRounding = 1e-5;  // of single precision
  constexpr std::array<std::array<std::size_t, 2>, 3> kTwins{{{1, 3}, {2, 6}, {5, 7}}};
  for (const auto& twin : kTwins)
    if (std::abs(v[twin[0]] - v[twin[1]]) > kRounding * scale)
      input.fail(
          fmt::format("the tensor of point {} is not symmetric: {:.6g} and {:.6g}", point, v[twin[0]], v[twin[1]]));
  return {v[0], (v[1] + v[3]) / 2, (v[2] + v[6]) / 2, v[4], (v[5] + v[7]) / 2, v[8]};
}

MetricMesh metric_of_arrays(const io::Input& input) {
  io::RawMesh raw = io::read_raw_mesh(input);
  const bool is_ambiguous = input.field->empty() && raw.field.names.size() != 1;
  const std::uint64_t n = raw.field.components;
  const bool is_metric = n == 1 || n == 6 || n == 9;
  if (is_ambiguous || !is_metric || raw.field.at_points.size() != n * raw.points.size())
    refuse_tensors(input, raw.field);
  const std::vector<double> values = std::move(raw.field.at_points);
  MetricMesh mesh = on_mesh(std::move(raw), input);
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    mesh.metrics.push_back(metric_of_vtk(input, std::span(values).subspan(n * v, n), v));
  mesh.name = input.name + (input.field->empty() ? "" : ":" + *input.field);
  return mesh;
}

/// FILE or FILE:FIELD, where the first one is there.
std::pair<std::string, std::string> file_and_field(const std::string& named) {
  const std::size_t colon = named.rfind(':');
  if (colon == std::string::npos || colon == 0 || exists_file(named) || !exists_file(named.substr(0, colon)))
    return {named, ""};
  return {named.substr(0, colon), named.substr(colon + 1)};
}

}  // namespace

MetricMesh read_metric(const std::string& named, const std::string& mesh_file, const RunContext& context) {
  const auto [file, field] = file_and_field(named);
  const io::LoadedFile loaded(file, context);
  if (is_solution(file)) return metric_of_solution(loaded.input(), mesh_file);
  io::Input asked = loaded.input();
  asked.field = &field;
  asked.wants_tensors = true;
  return metric_of_arrays(asked);
}

std::vector<double> read_point_values(const std::string& file, const std::string& field, const TetMesh& mesh,
                                      const RunContext& context) {
  const io::LoadedFile loaded(file, context);
  io::Input asked = loaded.input();
  asked.field = &field;
  io::RawMesh raw = read_with_field(asked);
  if (raw.field.at_points.size() != raw.points.size()) {
    asked.fail(raw.field.names.empty() ? std::string("has no field of single numbers at its points")
                                       : fmt::format("has no field {} of single numbers at its points; there are {}",
                                                     io::in_quotes(field), io::names_in_quotes(raw.field.names)));
  }
  if (raw.points != mesh.points)
    asked.fail(
        fmt::format("its {} points are not those of the mesh, {}: points of no element, or elements of second "
                    "order (octafront convert --order 1)",
                    raw.points.size(), mesh.points.size()));
  return std::move(raw.field.at_points);
}

}  // namespace octafront
