#pragma once

// What is called by a name in a mesh.

#include <octafront/tet_mesh.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace octafront {

/// Members as of a NamedSet of each kind, in no order.
struct NamedItems {
  std::vector<std::uint32_t> nodes, edges, faces, tets;
};
/// The elements of the region, the faces of the patch, the edges of the curve and the members of the sets of this name,
/// else of the patch of this number, from 1; none: nothing is called so.
std::optional<NamedItems> items_called(const TetMesh& mesh, const std::string& name);

/// Throws OptionError: option `option` names what is not there; `other` is what could be meant beside names.
[[noreturn]] void refuse_name(const TetMesh& mesh, const char* option, const std::string& name, const char* other = "");

/// The words between separators; one at least.
std::vector<std::string> split_at(std::string_view text, char separator);

}  // namespace octafront
