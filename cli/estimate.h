#pragma once

#include <octafront/generate.h>

#include "session.h"

#include <optional>

namespace octafront::cli {

/// What a run would take, from the sizes and the surface that a dry run made.
struct Estimate {
  double tets = 0, boundary_faces = 0;
  std::optional<double> seconds;  ///< of the whole run on an idle machine; only the method octree-aft is known
  double memory_bytes = 0;        ///< at the peak
  double file_bytes = 0;          ///< of a .vtu
};

Estimate estimate_run(const Report& sizes, const Options& options, int threads);

/// The answer to --dry-run, in words and for programs.
void tell_estimate(Session& session, const SizeResult& sizes);

}  // namespace octafront::cli
