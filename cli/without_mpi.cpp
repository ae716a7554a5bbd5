#include <octafront/error.h>

#include "mpi_session.h"

#include <fmt/core.h>

namespace octafront::cli {

std::unique_ptr<MpiSession> start_mpi(const Launch& launch) {
  throw OptionError(
      fmt::format("{} copies were started, and this octafront was built without MPI: they would all make the same mesh "
                  "and write the "
                  "same files. Build it with MPI: scripts/quickstart.sh --mpi, or cmake -DOCTAFRONT_MPI=ON (Debian: "
                  "libopenmpi-dev)",
                  launch.size));
}

}  // namespace octafront::cli
