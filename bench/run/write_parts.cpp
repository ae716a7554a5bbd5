// A mesh in parts beside the same mesh as one: octafront_write_parts MESH FOLDER PARTS. Prints the tables of
// docs/measured/parts.md: what divisions are worth, and what it costs to write them.

#include <octafront/octafront.h>

#include "formats/parts/division.h"
#include "formats/parts/mesh_parts.h"
#include "formats/parts/pieces.h"

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/core.h>
#include <malloc.h>

namespace {

using namespace octafront;
namespace fs = std::filesystem;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The most memory since the last reset.
class Peak {
 public:
  Peak() {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
  }
  double megabytes() const {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
      if (line.starts_with("VmHWM:")) return std::atof(line.c_str() + 6) / 1024;
    return 0;
  }
};

std::uint64_t bytes_in(const fs::path& folder) {
  std::uint64_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += entry.file_size();
  return bytes;
}

void print_divisions(const TetMesh& mesh) {
  const io::MeshParts parts(mesh);
  const double faces = static_cast<double>(4 * mesh.tets.size() - mesh.boundary.size()) / 2;
  fmt::print(
      "| parts | by | CPU s | least | most | faces between parts | of all faces | ghosts of elements | peak MB |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const std::uint32_t count : {2U, 8U, 64U, 1024U})
    for (const Partitioner by : {Partitioner::kCurve, Partitioner::kMetis}) {
      if (by == Partitioner::kMetis && !has_metis()) continue;
      const Peak peak;
      const double start = cpu_seconds();
      io::Division division = io::divide(mesh, count, by);
      const double seconds = cpu_seconds() - start, megabytes = peak.megabytes();
      const io::DivisionCost cost = io::cost_of(mesh, division);
      io::Pieces pieces(parts, std::move(division));
      std::size_t ghosts = 0;
      for (std::uint32_t k = 0; k < count; ++k) ghosts += pieces.ghosts_of(k).size();
      fmt::print("| {} | {} | {:.2f} | {} | {} | {} | {:.2f} % | {:.1f} % | {:.0f} |\n", count,
                 by == Partitioner::kMetis ? "METIS" : "curve", seconds, cost.least, cost.most, cost.cut,
                 100 * static_cast<double>(cost.cut) / faces,
                 100 * static_cast<double>(ghosts) / static_cast<double>(mesh.tets.size()), megabytes);
      std::fflush(stdout);
    }
}

void print_writing(const TetMesh& mesh, const fs::path& folder, std::uint32_t parts) {
  fmt::print(
      "\n| format | parts | MB | CPU s | M elements/s of CPU | peak MB |\n| --- | --- | --- | --- | --- | --- |\n");
  struct Case {
    const char *format, *file;
    bool split;
  };
  for (const auto& [format, file, split] :
       {Case{"vtu", "m.vtu", false}, Case{"pvtu", "m.pvtu", false}, Case{"vtkhdf", "m.vtkhdf", false},
        Case{"msh", "m.msh", false}, Case{"msh", "m.msh", true}, Case{"openfoam", "polyMesh", false}})
    for (const std::uint32_t count : {0U, parts}) {
      const bool is_whole = std::string(format) == "vtu", is_parts = std::string(format) == "pvtu" || split;
      if ((is_whole && count > 0) || (is_parts && count == 0)) continue;
      fs::remove_all(folder);
      fs::create_directories(folder);
      const Peak peak;
      const double start = cpu_seconds();
      write_mesh((folder / file).string(), mesh, {}, {.format = format, .parts = count, .split_files = split});
      const double seconds = cpu_seconds() - start;
      fmt::print("| {}{} | {} | {:.0f} | {:.2f} | {:.2f} | {:.0f} |\n", format, split ? ", split" : "",
                 count == 0 ? std::string("-") : std::to_string(count), static_cast<double>(bytes_in(folder)) / 1e6,
                 seconds, static_cast<double>(mesh.tets.size()) / 1e6 / seconds, peak.megabytes());
      std::fflush(stdout);
    }
  fs::remove_all(folder);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const TetMesh mesh = read_mesh(argv[1]);
  const Peak peak;
  fmt::print("{:.2f} M elements, {:.2f} M points; {:.0f} MB in memory\n\n", static_cast<double>(mesh.tets.size()) / 1e6,
             static_cast<double>(mesh.points.size()) / 1e6, peak.megabytes());
  print_divisions(mesh);
  print_writing(mesh, argv[2], static_cast<std::uint32_t>(std::atoi(argv[3])));
}
