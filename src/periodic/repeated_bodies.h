#pragma once

#include <octafront/complex.h>

#include "periodic/periodic_cell.h"

#include <string>
#include <vector>

namespace octafront {

/// The body with all its copies, moved by periods of a box, that reach into this. What goes through the whole box and
/// on is not repeated that way, which is noted. Throws InputError for a body that does not reach into it, or is far
/// longer.
Body repeated_in_cell(Body body, PeriodicCell cell, std::vector<std::string>& notes);

}  // namespace octafront
