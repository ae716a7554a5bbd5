#pragma once

#include <octafront/size_field.h>

#include <string>
#include <string_view>

namespace octafront {

/// A size field as bytes, for other processes of this machine: what unpacked_sizes() makes of them answers with the
/// same bits. Throws OptionError for a field that is neither a background grid nor one size everywhere.
std::string packed_sizes(const SizeField& sizes);
/// Throws InputError where the bytes are not such a field.
SizeField unpacked_sizes(std::string_view bytes);

}  // namespace octafront
