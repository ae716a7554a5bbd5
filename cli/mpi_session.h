#pragma once

#include <octafront/ranks.h>

#include <memory>

namespace octafront::cli {

/// How the program was started, as mpirun and srun tell by variables.
struct Launch {
  int rank = 0, size = 1;

  bool is_first() const { return rank == 0; }
};

/// MPI, for as long as it lives, in a build that has it.
class MpiSession {
 public:
  virtual ~MpiSession() = default;
  virtual Ranks& ranks() = 0;
  virtual int ranks_here() const = 0;  ///< on this machine
};
/// Throws OptionError if this build has no MPI, or if it knows of other ranks than the launch.
std::unique_ptr<MpiSession> start_mpi(const Launch& launch);

}  // namespace octafront::cli
