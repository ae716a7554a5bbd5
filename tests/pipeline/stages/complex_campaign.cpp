// Random complexes with known volumes, meshed with their triangles kept and triangulated anew. Not a unit test:
// bench/campaigns/complex-campaign.sh runs it over as many seeds as wanted.

#include <octafront/generate.h>
#include <octafront/validity.h>

#include "support/complexes.h"
#include "support/labelled_walls.h"

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>

namespace octafront {
namespace {

using testing::KnownComplex;

struct Tally {
  int runs = 0, failures = 0;
};

/// What is wrong with a mesh of the complex; planar walls keep their volumes to rounding.
std::optional<std::string> wrong_with(const Result& r, const KnownComplex& complex, bool kept, bool is_planar) {
  if (auto defect = kept ? first_defect(r.mesh, complex.surface) : first_defect(r.mesh)) return defect;
  if (!kept && !is_planar) return std::nullopt;
  for (std::size_t region = 0; region < complex.volumes.size(); ++region)
    if (const double off = r.report.regions[region].volume - complex.volumes[region]; std::abs(off) > 1e-9)
      return "the volume of region " + std::to_string(region) + " is off by " + std::to_string(off) + " of " +
             std::to_string(complex.volumes[region]);
  return std::nullopt;
}

void run(const KnownComplex& complex, const Options& options, bool is_planar, Tally& tally) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const bool kept = options.surface.keep;
  std::optional<std::string> wrong;
  std::string said;
  ++tally.runs;
  try {
    const Result r = generate(complex.surface, options);
    wrong = wrong_with(r, complex, kept, is_planar);
    said = std::to_string(r.mesh.tets.size()) + " tets, " + std::to_string(r.report.regions.size()) +
           " regions, mean beta " + std::to_string(r.report.quality.beta_mean) + ", least dihedral " +
           std::to_string(r.report.quality.dihedral_min);
    for (const StageReport& stage : r.report.stages)
      for (const std::string& note : stage.notes) said += "\n    " + note;
  } catch (const std::exception& error) {
    wrong = error.what();
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  std::printf("%s %s %s: %.2f s, %s%s%s\n", wrong ? "FAILED" : "ok", complex.name.c_str(), kept ? "kept" : "anew",
              seconds, said.c_str(), wrong ? ": " : "", wrong ? wrong->c_str() : "");
  std::fflush(stdout);
  tally.failures += wrong.has_value();
}

/// How large complexes are.
struct Extent {
  int planes, cells;  ///< besides the least: so many different numbers of them
  double size;
};
constexpr Extent kUsual{6, 30, 0.15}, kSmall{2, 5, 0.25};

/// Both ways; `size`: of elements where the surface is made anew.
void run_both(const KnownComplex& complex, double size, bool is_planar, Tally& tally) {
  Options options;
  options.surface.keep = true;
  run(complex, options, is_planar, tally);
  options.surface.keep = false;
  options.size.size = size;
  run(complex, options, is_planar, tally);
}

KnownComplex rough_cells(std::uint64_t seed) {
  const auto number = static_cast<unsigned>(seed);
  const int cells = 2 + static_cast<int>(seed % 40);
  SurfaceMesh walls = testing::rough_walls(3 + static_cast<int>(seed % 4), testing::nearest_of(cells, number), number);
  std::vector<double> volumes = testing::region_volumes(walls);
  return {"rough cells " + std::to_string(seed), std::move(walls), std::move(volumes)};
}

}  // namespace
}  // namespace octafront

int main(int argc, char** argv) {
  using namespace octafront;
  const std::uint64_t first = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const std::uint64_t count = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 5;
  const bool is_small = argc > 3 && std::string(argv[3]) == "small";
  const Extent e = is_small ? kSmall : kUsual;
  const auto number = [](std::uint64_t seed, int least, int numbers) {
    return least + static_cast<int>(seed % static_cast<unsigned>(numbers));
  };
  Tally tally;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    run_both(testing::plane_cuts(number(seed, 3, e.planes), seed), e.size, true, tally);
    run_both(testing::foam(number(seed, is_small ? 3 : 5, e.cells), seed), e.size, true, tally);
    if (!is_small) run_both(rough_cells(seed), e.size, false, tally);
  }
  std::printf("%d runs, %d failures\n", tally.runs, tally.failures);
  return tally.failures == 0 ? 0 : 1;
}
