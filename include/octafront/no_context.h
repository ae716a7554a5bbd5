#pragma once

// RunContext by name, for headers that would otherwise read all of run_context.h, <functional> with it, to hand one on.

namespace octafront {

struct RunContext;

/// What a function takes if it is given no context: nobody is told anything, and nothing is cancelled.
const RunContext& no_context();

}  // namespace octafront
