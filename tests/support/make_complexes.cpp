// Writes complexes with known answers as PLY files, NAME.ply, and NAME.volumes with a line "region volume" each:
//   make_complexes FOLDER                      all of known_complexes(), and parts as NAME/PART.ply
//   make_complexes FOLDER FIRST_SEED COUNT     foams and plane cuts by seed

#include <octafront/io.h>

#include "support/complexes.h"
#include "support/random.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>

#include <fmt/core.h>

namespace {

namespace fs = std::filesystem;
using namespace octafront;
using namespace octafront::testing;

void write_volumes(const fs::path& file, const std::vector<std::string>& names, const std::vector<double>& volumes) {
  std::string text;
  for (std::size_t r = 0; r < volumes.size(); ++r) text += fmt::format("{} {:.17g}\n", names[r], volumes[r]);
  write_text(file, text);
}

void write_complex(const fs::path& folder, const KnownComplex& known) {
  write_surface(folder / (known.name + ".ply"), known.surface);
  write_volumes(folder / (known.name + ".volumes"), known.surface.region_names, known.volumes);
}

void write_parts(const fs::path& folder, const KnownParts& known) {
  fs::create_directories(folder / known.name);
  for (std::size_t i = 0; i < known.parts.size(); ++i)
    write_surface(folder / known.name / (known.names[i] + ".ply"), known.parts[i]);
  write_volumes(folder / (known.name + ".volumes"), known.names, known.volumes);
}

void write_random(const fs::path& folder, std::uint64_t seed) {
  Random random(seed);
  write_complex(folder, seed % 2 == 0 ? foam(random.integer(2, 120), seed) : plane_cuts(random.integer(1, 16), seed));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 4) {
    fmt::print(stderr, "usage: make_complexes FOLDER [FIRST_SEED COUNT]\n");
    return 2;
  }
  try {
    const fs::path folder = argv[1];
    fs::create_directories(folder);
    if (argc == 2) {
      for (const KnownComplex& known : known_complexes()) write_complex(folder, known);
      for (const KnownParts& known : known_parts()) write_parts(folder, known);
    } else {
      const std::uint64_t first = std::strtoull(argv[2], nullptr, 10), count = std::strtoull(argv[3], nullptr, 10);
      for (std::uint64_t seed = first; seed < first + count; ++seed) write_random(folder, seed);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "make_complexes: {}\n", error.what());
    return 1;
  }
  return 0;
}
