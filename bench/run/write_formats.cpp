// Speed of the writers of meshes, each beside a plain write of as many bytes to the same disk:
//   octafront_write_formats MILLIONS FOLDER [ORDER [FORMAT ...]]
// A box of about so many million tetrahedra in two regions with six patches; prints a table for
// docs/measured/formats-bench.md.

#include <octafront/octafront.h>

#include "formats/containers/atomic_file.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <sys/resource.h>

namespace {

using namespace octafront;
namespace fs = std::filesystem;

/// n^3 cubes of six tetrahedra, bent so that coordinates have all their digits.
TetMesh box(int n) {
  TetMesh mesh;
  const auto at = [n](const std::array<int, 3>& g) {
    return static_cast<VertexIndex>((static_cast<std::int64_t>(g[0]) * (n + 1) + g[1]) * (n + 1) + g[2]);
  };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k)
        mesh.points.push_back({i + 0.1 * std::sin(0.3 * j), j + 0.1 * std::sin(0.4 * k), k + 0.1 * std::sin(0.5 * i)});
  constexpr int kPaths[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        for (int path = 0; path < 6; ++path) {
          std::array<int, 3> g{i, j, k};
          std::array<std::array<int, 3>, 4> corner{g};
          for (std::size_t step = 1; step < 4; ++step) {
            ++g[static_cast<std::size_t>(kPaths[path][step - 1])];
            corner[step] = g;
          }
          if (path >= 3) std::swap(corner[0], corner[1]);
          mesh.tets.push_back({at(corner[0]), at(corner[1]), at(corner[2]), at(corner[3])});
          mesh.region.push_back(2 * i >= n);
          for (const auto& f : kTetFaces)
            for (std::uint32_t axis = 0; axis < 3; ++axis)
              for (const int side : {0, n}) {
                const auto on = [&](int c) { return corner[static_cast<std::size_t>(c)][axis] == side; };
                if (!on(f[0]) || !on(f[1]) || !on(f[2])) continue;
                mesh.boundary.push_back({at(corner[static_cast<std::size_t>(f[0])]),
                                         at(corner[static_cast<std::size_t>(f[1])]),
                                         at(corner[static_cast<std::size_t>(f[2])])});
                mesh.patch.push_back(2 * axis + (side > 0));
              }
        }
  mesh.patch_names = {"low x", "high x", "low y", "high y", "low z", "high z"};
  mesh.region_names = {"left", "right"};
  return mesh;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::uint64_t bytes_in(const fs::path& folder) {
  std::uint64_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += entry.file_size();
  return bytes;
}

double plain_write(const fs::path& file, std::uint64_t bytes) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<char> block(std::size_t{1} << 20, 'x');
  io::AtomicFile out(file);
  for (std::uint64_t done = 0; done < bytes; done += block.size())
    out.write(block.data(), std::min<std::uint64_t>(block.size(), bytes - done));
  out.commit();
  return seconds_since(start);
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const int n = static_cast<int>(std::cbrt(std::atof(argv[1]) * 1e6 / 6) + 0.5);
  const fs::path folder = argv[2];
  const std::vector<std::string> wanted(argv + std::min(argc, 4), argv + argc);
  TetMesh mesh = box(n);
  if (argc > 3 && std::string(argv[3]) == "2") make_second_order(mesh);
  const double millions = static_cast<double>(mesh.tets.size()) / 1e6;
  fmt::print("{:.2f} M tetrahedra, {:.2f} M nodes; {:.0f} MB in memory\n\n", millions,
             static_cast<double>(mesh.points.size()) / 1e6, peak_megabytes());
  fmt::print(
      "| format | MB | s | MB/s | M elements/s | of a plain write | peak MB |\n| --- | --- | --- | --- | --- | --- | "
      "--- |\n");
  for (const FormatInfo& info : known_formats()) {
    const std::string name(info.name);
    const bool is_wanted = wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
    if (!info.writes_mesh || info.writes_surface || !is_wanted) continue;
    fs::remove_all(folder / name);
    fs::create_directories(folder / name);
    const auto start = std::chrono::steady_clock::now();
    try {
      write_mesh(folder / name / "mesh.x", mesh, {}, {.format = name});
    } catch (const OutputError& error) {
      fmt::print("| {} | {} |\n", name, error.what());
      continue;
    }
    const double seconds = seconds_since(start), megabytes = static_cast<double>(bytes_in(folder / name)) / 1e6;
    const double plain = plain_write(folder / "plain", bytes_in(folder / name));
    fmt::print("| {} | {:.0f} | {:.2f} | {:.0f} | {:.2f} | {:.2f} | {:.0f} |\n", name, megabytes, seconds,
               megabytes / seconds, millions / seconds, plain / seconds, peak_megabytes());
    std::fflush(stdout);
    fs::remove_all(folder / name);
    fs::remove(folder / "plain");
  }
}
