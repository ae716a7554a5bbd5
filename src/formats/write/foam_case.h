#pragma once

// What a polyMesh becomes a case by: WriteOptions::deck.

#include "formats/parts/mesh_output.h"
#include "formats/parts/mesh_parts.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace octafront::io {

/// The type of a patch in a case, by its name.
std::string_view foam_type_of(std::string_view name);

/// Throws OptionError if no case can be written around this polyMesh, OutputError where files of another one are.
void check_foam_case(const std::filesystem::path& target, const WriteOptions& options);

/// What coordinates count where a case is written: 1 without.
double metres_of_case(const WriteOptions& options);

/// Writes the rest of a case for simpleFoam. `names`: legal ones of MeshParts::parts().
void write_foam_case(MeshOutput& out, const MeshParts& mesh, std::span<const std::string> names);

}  // namespace octafront::io
