#pragma once

// core: what every room needs and no room owns: run context (progress, cancel), stage timers. Takes nothing, knows
// nothing of meshes.

#include "core/stage_timer.h"
#include <octafront/run_context.h>
