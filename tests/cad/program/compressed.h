#pragma once

#include <string>

namespace octafront::testing {

void write_gzip(const std::string& content, const std::string& file);
/// A zip archive with one file in a folder, deflated.
void write_zip(const std::string& content, const std::string& name, const std::string& file);

}  // namespace octafront::testing
