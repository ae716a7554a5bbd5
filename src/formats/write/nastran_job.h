#pragma once

#include "formats/containers/text_writer.h"
#include "formats/jobs/job_plan.h"

#include <cstdint>

namespace octafront::io {

/// Of linear statics: what stands before the bulk data. Throws OptionError for what no bulk data of all Nastrans says.
void write_nastran_control(TextWriter& text, const MeshParts& mesh, const JobPlan& plan);
/// Materials, supports and loads as bulk data. `next_element`: a number that no element has.
void write_nastran_job(TextWriter& text, const MeshParts& mesh, const JobPlan& plan, std::uint64_t next_element);
/// The coordinate system of a node's displacements: 0 or that of a cylinder.
std::uint64_t nastran_system_of(const JobPlan& plan, VertexIndex node);

}  // namespace octafront::io
