#pragma once

#include <octafront/ranks.h>

#include "session.h"

#include <memory>

namespace octafront::cli {

/// How the program was started, as mpirun and srun tell by variables.
struct Launch {
  int rank = 0, size = 1;

  bool is_first() const { return rank == 0; }
};
Launch launch_of_environment();

/// Whether the ranks share the work of this command; of others the first rank does all, and the rest nothing.
bool shares_work(const Arguments& arguments);

/// MPI, for as long as it lives, in a build that has it.
class MpiSession {
 public:
  virtual ~MpiSession() = default;
  virtual Ranks& ranks() = 0;
  virtual int ranks_here() const = 0;  ///< on this machine
};
/// Throws OptionError if this build has no MPI, or if it knows of other ranks than the launch.
std::unique_ptr<MpiSession> start_mpi(const Launch& launch);

/// What one rank of several needs otherwise than a process alone: threads by ranks on the machine, no output from any
/// but the first. Throws OptionError for what ranks cannot do.
void adapt_to_ranks(Arguments& arguments, const Launch& launch, int ranks_here);

/// What the ranks took: memory, bytes, time. To be called by all.
void tell_ranks(Session& session, const Report& report);

}  // namespace octafront::cli
