// Improvement never makes worse: octafront_never_worse [--generated N] [--seed S] [MESH SURFACE]...
// Runs every level of improvement on N generated meshes and on the meshes given (SURFACE: the one that was meshed, on
// which the boundary may move), and looks at every pass: every element positive by exact sign, the least beta and the
// smallest dihedral angle no smaller, the largest no larger than before it; the result valid. Prints one JSON object.

#include <octafront/octafront.h>

#include "improve/start_meshes.h"
#include "support/nasty_surfaces.h"

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace {

using namespace octafront;
using Level = ImproveOptions::Level;

struct Tally {
  std::uint64_t meshes = 0, skipped = 0, runs = 0, passes = 0;
  std::vector<std::string> failures;
};

// The cosines of angles below 1e-6 degrees are 1 to rounding: no formula by cosines tells such angles apart.
constexpr double kAngle = 2e-6, kBeta = 1e-12;

void run(const TetMesh& mesh, const SurfaceMesh* surface, Level level, const std::string& name, Tally& tally) {
  Options options;
  options.improve.level = level;
  ImproveOptions::Worst before;
  options.improve.after_pass = [&](const std::string& pass, const ImproveOptions::Worst& now) {
    const bool first = pass == "start";  // again where the boundary came to cross itself and the run is repeated
    const bool worse = !first && (now.beta < before.beta - kBeta || now.dihedral_min < before.dihedral_min - kAngle ||
                                  now.dihedral_max > before.dihedral_max + kAngle);
    if (worse || !now.positive)
      tally.failures.push_back(fmt::format(
          "{}, level {}, {}: {}", name, static_cast<int>(level), pass,
          now.positive ? fmt::format("beta {} to {}, angles {} - {} to {} - {}", before.beta, now.beta,
                                     before.dihedral_min, before.dihedral_max, now.dihedral_min, now.dihedral_max)
                       : "an element is not positive"));
    tally.passes += !first;
    before = now;
  };
  ++tally.runs;
  try {
    improve_existing(mesh, options, surface);  // checks the result
  } catch (const Error& e) {
    tally.failures.push_back(name + ": " + e.what());
  }
}

void run_levels(const TetMesh& mesh, const SurfaceMesh* surface, const std::string& name, Tally& tally) {
  ++tally.meshes;
  for (const Level level : {Level::kPaper, Level::kFast, Level::kDefault, Level::kBest})
    run(mesh, surface, level, name, tally);
}

// Half of them shaken grids, half what boundary recovery makes of nasty surfaces: the worst elements there are.
void run_generated(std::uint32_t seed, Tally& tally) {
  if (seed % 2 == 0) {
    const int n = 2 + static_cast<int>(seed / 2 % 6);
    const double amount = 0.1 + 0.1 * (seed / 12 % 10);
    run_levels(testing::perturbed(testing::kuhn_cube(n), amount, seed), nullptr, fmt::format("grid {}", seed), tally);
    return;
  }
  const testing::NastySurface nasty = testing::nasty_surface(seed);
  Options options;
  options.method = Method::kRecover;
  options.improve.level = Level::kOff;
  try {
    const TetMesh mesh = generate(nasty.surface, options).mesh;
    run_levels(mesh, &nasty.surface, nasty.name, tally);
  } catch (const Error&) {
    ++tally.skipped;  // not a matter of improvement
  }
}

}  // namespace

int main(int argc, char** argv) {
  Tally tally;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string(argv[i]) == "--seed") {
      run_generated(static_cast<std::uint32_t>(std::atoi(argv[i + 1])), tally);
      continue;
    }
    if (std::string(argv[i]) == "--generated") {
      for (int seed = 1; seed <= std::atoi(argv[i + 1]); ++seed) run_generated(static_cast<std::uint32_t>(seed), tally);
      continue;
    }
    try {
      const TetMesh mesh = read_mesh(argv[i]);
      const SurfaceMesh surface = repair_surface(read_surface(argv[i + 1]).surface).surface;
      run_levels(mesh, &surface, argv[i + 1], tally);
    } catch (const Error& e) {
      tally.failures.push_back(std::string(argv[i]) + ": " + e.what());
    }
  }
  const nlohmann::ordered_json out{{"meshes", tally.meshes},
                                   {"skipped", tally.skipped},
                                   {"runs", tally.runs},
                                   {"passes", tally.passes},
                                   {"failures", tally.failures}};
  fmt::print("{}\n", out.dump());
  return tally.failures.empty() ? 0 : 1;
}
