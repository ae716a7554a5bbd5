#pragma once

#include <octafront/octafront.h>

#include "session.h"

#include <optional>

namespace octafront::cli {

/// The metric that --metric reads or --from makes of a field, graded, bounded and scaled as is asked for, for `mesh`,
/// which is the input; none if neither was given. Where
/// the mesh is cut along level sets and nothing asks for sizes those that it has. Written where --save-metric says.
/// Throws OptionError for options of sizes beside it, InputError.
std::optional<MetricMesh> metric_asked_for(const Session& session, const TetMesh& mesh);

/// Throws OptionError for what metric_asked_for() would refuse before it reads anything.
void check_metric_options(const Arguments& arguments);

}  // namespace octafront::cli
