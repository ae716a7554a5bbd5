#pragma once

#include "fill/front/excavation.h"
#include "fill/front/front_task.h"

namespace octafront {

/// How a cavity is to be advanced once more.
struct BacktrackVariant {
  int rings = 1;            ///< of tetrahedra taken out around the cavity first
  double ideal_factor = 1;  ///< shortens the ideal point's distance
  VolumeOptions::Ranking ranking = VolumeOptions::Ranking::kQuality;
};

/// Backtracking: takes rings of tetrahedra out around a cavity and lets a front of its own fill it with other choices.
/// True if that closed it; otherwise nothing has changed. `face_tests` is the work that may be spent; what was spent is
/// taken off it.
bool close_by_front(const OpenCavity& cavity, const BacktrackVariant& variant, const FrontTask& task,
                    std::uint64_t& face_tests);

}  // namespace octafront
