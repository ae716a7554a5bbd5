// From arrays to arrays, by octafront::mesher alone: no files, no images, and neither zlib nor HDF5 to link.

#include <octafront/generate.h>
#include <octafront/mend.h>

#include <cstdio>
#include <cstdlib>

int main() {
  // A cube whose last face is missing: it is mended first.
  octafront::SurfaceMesh cube;
  for (unsigned i = 0; i < 8; ++i) cube.points.push_back({i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0});
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {0, 1, 4}, {1, 5, 4}, {0, 4, 2}, {2, 4, 6},
                    {1, 3, 5}, {3, 7, 5}, {2, 6, 3}, {3, 6, 7}, {4, 5, 6}};
  octafront::Options options;
  options.size.size = 0.2;
  try {
    const octafront::Result result = octafront::generate(octafront::mend_surface(cube), options);
    std::printf("%zu tetrahedra, volume %.12f of 1\n", result.mesh.tets.size(), result.report.volume);
  } catch (const octafront::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
