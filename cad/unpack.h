#pragma once

#include <string>

namespace octafront::cad {

/// What a compressed file holds, gzip or a zip archive, of that its first file: in memory, under a path that is gone
/// when the process is; the file's own path where it is not compressed. Throws Refusal where it is damaged, or larger
/// than `most_bytes` (0: no limit).
std::string unpacked(const std::string& file, double most_bytes);

}  // namespace octafront::cad
