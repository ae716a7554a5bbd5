#pragma once

#include "formats/containers/input.h"

#include <cstdint>
#include <string_view>

namespace octafront::io {

enum class SurfaceKind { kBinaryStl, kAsciiStl, kObj, kOff, kPly, kPoly, kMsh, kMedit, kMeditBinary, kOtherMesh };
enum class MeshKind { kVtu, kVtk, kMsh, kMedit, kMeditBinary, kAbaqus, kNastran, kUnv, kNetgen, kTetgen, kXdmf, kHdf5 };

/// What the bytes are (kOtherMesh: what recognize_mesh() knows), whatever the name; the name decides only where the
/// bytes leave a choice. Throws InputError with what the file looks like instead.
SurfaceKind recognize_surface(const Input& input);
MeshKind recognize_mesh(const Input& input);

/// Whether a file of that size is binary STL, by its first bytes; the size settles it.
bool is_binary_stl(std::string_view head, std::uint64_t size);

/// "a PNG image" and the like, or empty if it is no well-known kind of file.
std::string_view well_known_kind(std::string_view bytes);

/// True if there is a byte among the first few thousand that no text has.
bool looks_binary(std::string_view bytes);

}  // namespace octafront::io
