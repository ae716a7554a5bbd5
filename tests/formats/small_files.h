#pragma once

// Small files of every kind, as bytes in memory, for tests of the readers.

#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include "formats/files/formats.h"
#include "support/temporary_folder.h"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::testing {

struct SmallFile {
  std::string name;  ///< with the ending of its format
  std::string bytes;
};

/// The surface of a tetrahedron in every surface format and variant.
std::vector<SmallFile> small_surface_files();
/// Two tetrahedra with a common face, in two regions, in every mesh format and variant.
std::vector<SmallFile> small_mesh_files();

/// The same in formats whose files are whole wherever a line ends, and as others write them.
std::vector<SmallFile> more_mesh_files();

TetMesh two_tets();

std::string file_bytes(const std::filesystem::path& file);
void write_bytes(const std::filesystem::path& file, std::string_view bytes);

inline SurfaceFile surface_of(const std::string& bytes, const std::string& name = "x") {
  return io::read_surface_bytes({name, bytes});
}
inline TetMesh mesh_of(const std::string& bytes, const std::string& name = "x") {
  return io::read_mesh_bytes({name, bytes}).mesh;
}

/// The message of the InputError that `read` throws; fails the test if it throws none or another one.
std::string input_error(const std::function<void()>& read);

}  // namespace octafront::testing
