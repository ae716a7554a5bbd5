#pragma once

#include "formats/containers/input.h"

#include <filesystem>
#include <string>

namespace octafront::io {

/// The file that another one names, or that goes with it by its name: in the folder of that one or below it, and plain.
/// What came from elsewhere must not lead to other places of this machine, nor to a pipe that nobody writes to. Links
/// that lie in the folder are followed: who put them there chose so. Throws InputError; a file that is not there is
/// left to who opens it.
std::filesystem::path named_file(const Input& by, const std::string& name);

/// The file beside `by` with this ending instead; empty if it is not there. Throws InputError as above.
std::filesystem::path sibling_file(const Input& by, const std::string& ending);

}  // namespace octafront::io
