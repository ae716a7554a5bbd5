#include <octafront/error.h>
#include <octafront/mpi.h>

#include "mpi_session.h"

#include <optional>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

class RunningMpi : public MpiSession {
 public:
  RunningMpi() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    ranks_.emplace(MPI_COMM_WORLD);
  }
  ~RunningMpi() override {
    ranks_.reset();
    MPI_Finalize();
  }
  RunningMpi(const RunningMpi&) = delete;
  RunningMpi& operator=(const RunningMpi&) = delete;

  Ranks& ranks() override { return *ranks_; }
  int ranks_here() const override { return ranks_->ranks_here(); }

 private:
  std::optional<MpiRanks> ranks_;
};

}  // namespace

std::unique_ptr<MpiSession> start_mpi(const Launch& launch) {
  auto mpi = std::make_unique<RunningMpi>();
  if (mpi->ranks().size() == launch.size) return mpi;
  throw OptionError(
      fmt::format("{} copies were started, and MPI knows of {}: they would all make the same mesh. Start it by the "
                  "mpirun of the MPI "
                  "that octafront was built with, or by `srun --mpi=pmix`",
                  launch.size, mpi->ranks().size()));
}

}  // namespace octafront::cli
