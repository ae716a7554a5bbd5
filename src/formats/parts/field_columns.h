#pragma once

#include <octafront/mesh_field.h>

#include "formats/parts/legal_names.h"
#include "formats/parts/mesh_output.h"

#include <cstddef>
#include <string>
#include <vector>

namespace octafront::io {

/// One number of a field, for formats that have no vectors or tell them by the names of their components.
struct FieldColumn {
  const MeshField* field;
  std::size_t component;
  std::string name;
};

/// "x" of a vector, "xy" of a tensor, else numbers from 1; of single numbers "".
std::string component_name(std::size_t components, std::size_t k);

enum class ComponentNames { kUnderscored, kCapitals };  ///< u_x, or uX
/// The fields of points, or of elements, number by number under legal names; what had to change is noted.
std::vector<FieldColumn> field_columns(MeshOutput& out, bool of_elements, const NameRules& rules, ComponentNames style);

}  // namespace octafront::io
