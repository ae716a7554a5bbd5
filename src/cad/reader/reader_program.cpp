#include <octafront/error.h>

#include "cad/reader/cad_reader.h"

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <dlfcn.h>
#include <unistd.h>

namespace octafront::cad {

namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "octafront-cad";

bool can_run(const fs::path& program) {
  return access(program.c_str(), X_OK) == 0 && fs::is_regular_file(program);
}

/// Where it lies beside a program or library of ours: in the same folder, installed, in a build tree.
std::vector<fs::path> places_beside(const fs::path& ours) {
  const fs::path folder = ours.parent_path();
  return {folder / kProgram, folder / "../libexec/octafront" / kProgram, folder / "../../libexec/octafront" / kProgram,
          folder / "../cad" / kProgram, folder / "../../cad" / kProgram};
}

/// The file that holds this very code.
fs::path own_file() {
  Dl_info found{};
  std::error_code ignored;
  if (dladdr(reinterpret_cast<const void*>(&can_run), &found) == 0 || found.dli_fname == nullptr) return {};
  return fs::weakly_canonical(found.dli_fname, ignored);
}

}  // namespace

std::string reader_program() {
  if (const char* named = std::getenv("OCTAFRONT_CAD")) return named;
  std::error_code ignored;
  for (const fs::path& ours : {fs::read_symlink("/proc/self/exe", ignored), own_file()})
    for (const fs::path& place : places_beside(ours))
      if (can_run(place)) return fs::weakly_canonical(place, ignored).string();
  std::istringstream path(std::getenv("PATH") ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(path, folder, ':');)
    if (can_run(fs::path(folder) / kProgram)) return (fs::path(folder) / kProgram).string();
  throw InputError(
      "CAD files (STEP, IGES, BREP) are read by the program octafront-cad, which is not here: it is built where "
      "OpenCASCADE is. On Debian: apt-get install libocct-data-exchange-dev libocct-ocaf-dev, then build Octafront "
      "again (scripts/quickstart.sh PART.step does both; the Python package: pip install . again); or name the program "
      "of "
      "another build by the variable OCTAFRONT_CAD");
}

}  // namespace octafront::cad
