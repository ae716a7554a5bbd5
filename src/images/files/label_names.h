#pragma once

#include <octafront/image.h>

#include "formats/containers/input.h"

#include <vector>

namespace octafront::image {

/// As read_label_names(), of bytes.
std::vector<LabelName> read_label_names_bytes(const io::Input& input);

}  // namespace octafront::image
