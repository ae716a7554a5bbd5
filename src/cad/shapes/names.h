#pragma once

#include "cad/model/cad_model.h"

#include <cstdint>
#include <string>
#include <vector>

namespace octafront::cad {

/// A name for each face, all different: its own, with "#2" and so on where several share it; else "face N", N from 1.
std::vector<std::string> face_names(const CadModel& model);
/// The same for the solids: "solid N".
std::vector<std::string> solid_names(const CadModel& model);

/// A colour or a layer of the file, and the faces or solids that have it.
struct LabelGroup {
  std::string name;  ///< of faces "color #ff8000", "layer NAME"; of solids "solids of color #ff8000", ...
  std::vector<std::uint32_t> faces, solids;
};
/// In the order of their names.
std::vector<LabelGroup> label_groups(const CadModel& model);

}  // namespace octafront::cad
