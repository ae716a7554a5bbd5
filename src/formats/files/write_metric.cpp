// Metrics on meshes, to look at and for other programs: tensors at the points of a VTU, or MEDIT's .sol.

#include <octafront/error.h>
#include <octafront/io.h>

#include "formats/write/vtu_head.h"

#include <fmt/core.h>

namespace octafront {

namespace {

constexpr std::uint8_t kVtkTriangle = 5, kVtkTetrahedron = 10;

void write_metric_grid(io::AtomicFile& file, const MetricMesh& mesh) {
  const bool has_tets = !mesh.tets.empty();
  const std::uint64_t points = mesh.points.size(), cells = has_tets ? mesh.tets.size() : mesh.triangles.size();
  const std::uint64_t corners = has_tets ? 4 : 3;
  io::TextWriter out(file);
  io::VtuArrays arrays(file);
  io::begin_grid(out);
  io::begin_piece(out, points, cells);
  out << "      <Points>\n";
  arrays.declare<double>("Float64", "Points", 3, 3 * points,
                         [&](std::uint64_t i) { return mesh.points[i / 3][static_cast<int>(i % 3)]; });
  out << "      </Points>\n      <Cells>\n";
  arrays.declare<std::int64_t>("Int64", "connectivity", 1, corners * cells, [&](std::uint64_t i) {
    return static_cast<std::int64_t>(has_tets ? mesh.tets[i / 4][i % 4] : mesh.triangles[i / 3][i % 3]);
  });
  arrays.declare<std::int64_t>("Int64", "offsets", 1, cells,
                               [&](std::uint64_t i) { return static_cast<std::int64_t>(corners * (i + 1)); });
  arrays.declare<std::uint8_t>("UInt8", "types", 1, cells,
                               [&](std::uint64_t) { return has_tets ? kVtkTetrahedron : kVtkTriangle; });
  out << "      </Cells>\n      <PointData Tensors=\"metric\">\n";
  arrays.declare<double>("Float64", "metric", 9, 9 * points, [&](std::uint64_t i) {
    const Metric& m = mesh.metrics[i / 9];
    return std::array{m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz}[i % 9];
  });
  out << "      </PointData>\n";
  io::end_vtu(out, arrays);
}

void write_solution(io::AtomicFile& file, const MetricMesh& mesh) {
  io::TextWriter out(file);
  out << "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n"
      << static_cast<std::uint64_t>(mesh.metrics.size()) << "\n1 3\n";
  for (const Metric& m : mesh.metrics)
    out << m.xx << ' ' << m.xy << ' ' << m.yy << ' ' << m.xz << ' ' << m.yz << ' ' << m.zz << '\n';
  out << "End\n";
}

bool is_sol(const std::string& file) {
  return std::filesystem::path(file).extension() == ".sol";
}

}  // namespace

void check_metric_target(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (ending != ".vtu" && ending != ".sol")
    throw OptionError(fmt::format("{}: a metric is written as .vtu or .sol, not as \"{}\"", file, ending));
  io::check_writable(file);
}

void write_metric(const std::string& file, const MetricMesh& mesh, const RunContext& context) {
  check_metric_target(file);
  io::AtomicFile out(file, context);
  is_sol(file) ? write_solution(out, mesh) : write_metric_grid(out, mesh);
  out.commit();
}

}  // namespace octafront
