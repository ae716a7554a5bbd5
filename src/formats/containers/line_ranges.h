#pragma once

#include "formats/containers/input.h"

#include <cstddef>
#include <string_view>
#include <vector>

namespace octafront::io {

/// A text in ranges of whole lines, in their order, each for a thread of its own. Lines that end with CR alone are not
/// told apart: they are all in one range.
///
/// Readers go through ranges as far as a text is as nearly all are. Where it is not, or anything is wrong with it, they
/// read it once more from its begin to its end: who reads all knows the line, and says what has always been said.
std::vector<std::string_view> line_ranges(std::string_view text);

/// Whether it is worth it: several threads, and a text of some size.
bool reads_in_ranges(std::string_view text);

/// A range of the lines of an input as one by itself: it shows no progress and never ends the run.
Input input_of_range(const Input& input, std::string_view range);

}  // namespace octafront::io
