#pragma once

// base/core: what every room needs and no room owns: run context (progress, cancel), stages and their timers, work on
// several threads (parallel.h), words of messages (wording.h), and the containers of working structures, each in a
// header of its own: groups.h, buckets.h, flat_map.h, disjoint_sets.h, morton.h, random.h, validate.h. Takes nothing,
// knows nothing of meshes.
