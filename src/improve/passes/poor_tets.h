#pragma once

#include <octafront/run_context.h>

#include "improve/passes/mesh_editor.h"
#include "improve/passes/passes.h"

#include <vector>

namespace octafront::improve {

/// The tets with a score below the threshold, by slot.
std::vector<TetIndex> tets_below(const EditMesh& mesh, float threshold);

/// Lets `editor` improve(t) each of the tets with a score below the threshold, and those in its created().
template <typename Editor>
PassResult improve_each(Editor& editor, const EditMesh& mesh, float threshold, const RunContext& context) {
  PassResult result;
  std::vector<TetIndex> queue = tets_below(mesh, threshold);
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const TetIndex t = queue[k];
    if (!mesh.alive(t) || mesh.shape(t).score >= threshold) continue;
    if (++result.tried % kBetweenChecks == 0) context.check();
    if (!editor.improve(t)) continue;
    ++result.done;
    for (const TetIndex made : editor.created())
      if (mesh.shape(made).score < threshold) queue.push_back(made);
  }
  return result;
}

}  // namespace octafront::improve
