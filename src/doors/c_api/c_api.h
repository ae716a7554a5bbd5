#pragma once

// doors/c_api: the library for other languages (octafront/octafront_c.h): opaque objects, arrays and names by name,
// work as jobs that the caller waits for. Takes and leaves plain pointers and JSON; adds nothing of its own to the
// library.

#include <octafront/domain.h>
#include <octafront/image.h>
#include <octafront/mesh_field.h>
#include <octafront/octafront_c.h>
#include <octafront/options.h>
#include <octafront/size_field.h>
#include <octafront/surface_mesh.h>
#include <octafront/tet_mesh.h>

#include <cstdint>
#include <string>
#include <vector>

struct octafront_surface {
  octafront::Domain domain;
};

struct octafront_mesh {
  octafront::TetMesh mesh;
  /// Of a mesh that was adapted: AdaptedMesh::old_of_new and old_tet_of_new.
  std::vector<std::uint32_t> old_of_new = {}, old_tet_of_new = {};
  /// Of a mesh that was moved: MovedMesh::fields.
  std::vector<octafront::MeshField> fields = {};
};

struct octafront_sizes {
  octafront::SizeField field;
};

struct octafront_image {
  octafront::Image image;
};

struct octafront_options {
  octafront::Options options;
  bool asks_sizes = false, tells_passes = false;
  int rank = 0, ranks = 1;
};

namespace octafront::c_api {

/// What octafront_last_error() returns in this thread.
void remember_error(std::string message);

/// `text` until the next call of this thread.
const char* kept(std::string text);

/// Runs `body`; what it throws is remembered. 0, or 1 if it threw.
template <class Body>
int guarded(const Body& body) {
  try {
    body();
    return 0;
  } catch (const std::exception& error) {
    remember_error(error.what());
    return 1;
  }
}

/// Throw InputError if an index is out of range, or lists that belong together have different lengths.
void require_indices(const SurfaceMesh& surface);
void require_indices(const TetMesh& mesh);

}  // namespace octafront::c_api
