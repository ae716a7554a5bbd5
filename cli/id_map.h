#pragma once

#include <octafront/adapt.h>

#include <filesystem>

namespace octafront::cli {

/// Throws OptionError or OutputError if no map can be written there; an empty name is none.
void check_map_target(const std::filesystem::path& file);

/// Where vertices and elements of the old mesh are in the new one, by numbers from 0, -1 where they have gone. JSON:
/// {"vertices": [...], "elements": [...]}, an entry for each old one. CSV: lines kind,old,new. Throws OutputError.
void write_map(const std::filesystem::path& file, const TetMesh& before, const AdaptedMesh& adapted);

}  // namespace octafront::cli
