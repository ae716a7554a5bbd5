#pragma once

#include "arguments.h"

namespace octafront::cli {

/// libhdf5 crashes on some damaged files. Those of its formats are therefore read once in a child process, which is
/// forked while there are no threads yet. Throws InputError if that crashes.
void rehearse_reading(const Arguments& arguments);

}  // namespace octafront::cli
