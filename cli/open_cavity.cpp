#include "open_cavity.h"

#include <octafront/octafront.h>

#include <fmt/format.h>

namespace octafront::cli {

MeshingError with_cavity_written(const OpenCavityError& error, std::filesystem::path output) {
  output.replace_extension(".cavity.off");
  write_surface(output, error.cavity);
  return MeshingError(
      fmt::format("{}\nThe open cavity is in {}. This is a bug of ours: please report it with that file "
                  "(or the input) and the command line; meanwhile another --size may succeed.",
                  error.what(), output.string()));
}

}  // namespace octafront::cli
