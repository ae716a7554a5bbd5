#pragma once

#include "formats/jobs/job_places.h"
#include "formats/jobs/job_plan.h"

namespace octafront::io {

/// Young's modulus where nothing is said: of steel in N, mm and t.
inline constexpr double kSteelYoung = 210000;

/// Plans the materials of a job and which of them each region is of, with a density for each that the input knows one
/// of; regions that have none get steel, with a note. Throws OptionError for a place that there is not.
void plan_materials(MeshOutput& out, const MeshParts& mesh, const SolverJob& job, const JobPlaces& places,
                    JobPlan& plan);

}  // namespace octafront::io
