#pragma once

#include <octafront/vec.h>

#include "formats/jobs/job_plan.h"
#include "formats/parts/mesh_output.h"
#include "formats/parts/mesh_parts.h"

#include <string>
#include <vector>

namespace octafront::io {

/// What groups of a MED file are called that a job names, no two alike.
struct AsterNames {
  struct Point {
    std::string name;
    Vec3 at;
  };
  std::vector<std::string> parts;  ///< as MeshParts has them
  std::vector<Point> points;       ///< reference points: nodes behind the others, each a group
  std::vector<std::string> ties;   ///< of JobPlan::contacts: for nodes of the slave that nothing else holds
};
AsterNames aster_names(MeshOutput& out, const MeshParts& mesh, const JobPlan& plan);

/// Commands of code_aster for linear statics beside a MED file, and the .export that says which file is which. Throws
/// OptionError for what they do not say.
void write_aster_job(MeshOutput& out, const MeshParts& mesh, const JobPlan& plan, const AsterNames& names);

}  // namespace octafront::io
