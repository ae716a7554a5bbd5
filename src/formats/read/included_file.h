#pragma once

#include "formats/containers/input.h"

#include <optional>
#include <string>

namespace octafront::io {

/// A file that `input` names in its text. Looked for in the folder of `input` alone, and those in it: a mesh does not
/// read what lies elsewhere. Empty if it is not there. `name`: as it stands in the text, with either kind of slash.
std::optional<LoadedFile> included_file(const Input& input, std::string name);

}  // namespace octafront::io
