#pragma once

#include "formats/containers/text_writer.h"
#include "formats/jobs/job_plan.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace octafront::io {

/// What the lines of a job call what is in the file.
struct AbaqusNames {
  std::vector<std::string> parts;                       ///< as MeshParts has them
  std::function<std::string(const std::string&)> more;  ///< a legal name that nothing else has
  std::uint64_t first_node = 0;                         ///< that nothing has
};

/// Sections, supports, contacts and steps behind a mesh.
void write_abaqus_job(TextWriter& text, const MeshParts& mesh, const JobPlan& plan, const AbaqusNames& names,
                      bool has_sections);

}  // namespace octafront::io
