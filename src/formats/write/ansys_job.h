#pragma once

#include "formats/containers/text_writer.h"
#include "formats/jobs/job_plan.h"
#include "formats/parts/mixed_cells.h"

#include <string>
#include <vector>

namespace octafront::io {

/// Materials, contacts, supports and loads of a static analysis behind a mesh, then its solution and reactions.
/// `names`: of the components, as MeshParts has the parts. Throws OptionError for what is not written.
void write_ansys_job(TextWriter& text, const MeshParts& mesh, const MixedCells& cells, const JobPlan& plan,
                     const std::vector<std::string>& names);

}  // namespace octafront::io
