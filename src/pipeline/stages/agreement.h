#pragma once

// What is the same on all ranks is compared after each stage, by its hash: ranks that drift apart would find out late,
// or not at all. Nothing is done by a process alone.

#include <octafront/run_context.h>
#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>

#include <vector>

namespace octafront {

struct Filled;
struct Options;

/// Throws OptionError for what hangs on the time that a machine takes.
void refuse_for_ranks(const Options& options, const RunContext& context);

/// Each throws a RankFailure on all ranks if they have different ones.
void agree_on(const SurfaceMesh& surface, const char* what, const RunContext& context);
/// By what it is at these points.
void agree_on(const SizeField& sizes, const std::vector<Vec3>& points, const char* what, const RunContext& context);
void agree_on(const Filled& filled, const char* what, const RunContext& context);

}  // namespace octafront
