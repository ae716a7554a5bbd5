#pragma once

#include <octafront/tet_mesh.h>

#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

/// Per tet 1 if it is in one of the places, which have semicolons between them (AdaptOptions::only), else 0. Throws
/// OptionError for what is no place, for names that the mesh has not (with those that it has), and if a place holds no
/// element.
std::vector<std::uint8_t> chosen_tets(const TetMesh& mesh, const std::string& places);

}  // namespace octafront
