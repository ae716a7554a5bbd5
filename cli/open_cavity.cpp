#include "open_cavity.h"

#include <octafront/octafront.h>

#include <fmt/core.h>

namespace octafront::cli {

std::filesystem::path cavity_file(std::filesystem::path output) {
  return output.replace_extension(".cavity.off");
}

MeshingError with_cavity_written(const OpenCavityError& error, const std::filesystem::path& output) {
  const std::filesystem::path file = cavity_file(output);
  write_surface(file.string(), error.cavity);
  return MeshingError(
      fmt::format("{}\nThe open cavity is in {}. This is a bug of ours: please report it with that file "
                  "(or the input) and the command line; meanwhile another `size` may succeed.",
                  error.what(), file.string()));
}

}  // namespace octafront::cli
