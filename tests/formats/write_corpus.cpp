// Writes the small files of the tests into FOLDER/surface and FOLDER/mesh, as seeds for the fuzzers (tests/corpus).

#include "small_files.h"

#include <filesystem>

int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  if (argc != 2) return 2;
  const fs::path folder = argv[1];
  fs::create_directories(folder / "surface");
  fs::create_directories(folder / "mesh");
  for (const auto& file : octafront::testing::small_surface_files())
    octafront::testing::write_bytes(folder / "surface" / file.name, file.bytes);
  for (const auto& files : {octafront::testing::small_mesh_files(), octafront::testing::more_mesh_files()})
    for (const auto& file : files) octafront::testing::write_bytes(folder / "mesh" / file.name, file.bytes);
}
