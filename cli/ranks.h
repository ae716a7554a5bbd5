#pragma once

#include "mpi_session.h"
#include "session.h"

namespace octafront::cli {

Launch launch_of_environment();

/// Whether the ranks share the work of this command; of others the first rank does all, and the rest nothing.
bool shares_work(const Arguments& arguments);

/// What one rank of several needs otherwise than a process alone: threads by ranks on the machine, no output from any
/// but the first. Throws OptionError for what ranks cannot do.
void adapt_to_ranks(Arguments& arguments, const Launch& launch, int ranks_here);

/// What the ranks took: memory, bytes, time. To be called by all.
void tell_ranks(Session& session, const Report& report);

}  // namespace octafront::cli
