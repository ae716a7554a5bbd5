#pragma once

#include "arguments.h"

namespace octafront::cli {

/// The options as given, with what the preset says of those that were not.
Options with_preset(const Arguments& arguments);

/// Of the preset for heads: what it says of this domain's regions, by their labels or names.
void add_sizes_of_head(const Arguments& arguments, const Domain& domain, Options& options);

}  // namespace octafront::cli
