#pragma once

// core: what every room needs and no room owns: run context (progress, cancel), stage timers, the limit on threads. Takes
// nothing, knows nothing of meshes.

#include <octafront/run_context.h>

#include "core/stage_timer.h"
#include "core/thread_limit.h"
