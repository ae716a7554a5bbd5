#pragma once

#include "cad/model/cad_model.h"

#include <cstdint>
#include <string>
#include <vector>

namespace octafront::cad {

/// What each face is called: faces of one name are one patch. Its own name, followed by its solids where others of that
/// name lie at other ones, "head (bolt)"; between two solids these, "plate|bolt", of the second piece of that contact
/// "plate|bolt#2"; else "face N", N from 1.
std::vector<std::string> face_names(const CadModel& model);
/// The faces between two solids, whatever they are called: "plate|bolt" or "bolt|plate".
std::vector<std::uint32_t> faces_between(const CadModel& model, const std::string& pair);
/// A name for each solid, all different: its own, or "solid N".
std::vector<std::string> solid_names(const CadModel& model);
/// The second of equal names gets "#2", and so on.
std::vector<std::string> all_different(std::vector<std::string> names);

/// A colour or a layer of the file, and the faces or solids that have it; a contact none of whose faces is called by
/// it.
struct LabelGroup {
  std::string name;  ///< of faces "color #ff8000", "layer NAME"; of solids "solids of color #ff8000", ...
  std::vector<std::uint32_t> faces, solids;
};
/// In the order of their names.
std::vector<LabelGroup> label_groups(const CadModel& model);

}  // namespace octafront::cad
