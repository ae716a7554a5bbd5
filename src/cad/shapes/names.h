#pragma once

#include "cad/model/cad_model.h"

#include <string>
#include <vector>

namespace octafront::cad {

/// A name for each face, all different: its own, with "#2" and so on where several share it; else "face N", N from 1.
std::vector<std::string> face_names(const CadModel& model);
/// The same for the solids: "solid N".
std::vector<std::string> solid_names(const CadModel& model);

}  // namespace octafront::cad
