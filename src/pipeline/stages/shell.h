#pragma once

// Layers of flat elements through thin walls (VolumeOptions::shell), in a mesh that is done but for its place on the
// true geometry, its order and its names.

#include "pipeline/stages/run.h"

namespace octafront {

struct Filled;
struct Remeshed;

/// Throws OptionError for what layers through walls do not go with.
void check_shell_options(const Options& options);

/// How many elements more so many layers make of the surface, once it is filled: as measured on plates, tubes and
/// brackets, where it is a third off at worst.
double expected_shell_tets(const Remeshed& made, std::uint32_t layers);

/// Puts as many layers as the run asks for through walls that have fewer; nothing if it asks for none.
void layer_walls(Filled& filled, Run& run);

}  // namespace octafront
