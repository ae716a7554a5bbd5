// Makes a surface in memory, meshes it at a chosen size, looks at the result, and writes it.

#include <octafront/octafront.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

namespace {

// A sphere of radius 1 from rings of latitude.
octafront::SurfaceMesh sphere(unsigned rings, unsigned sectors) {
  octafront::SurfaceMesh s;
  s.points.push_back({0, 0, 1});
  for (unsigned i = 1; i < rings; ++i) {
    for (unsigned j = 0; j < sectors; ++j) {
      const double theta = std::numbers::pi * i / rings, phi = 2 * std::numbers::pi * j / sectors;
      s.points.push_back({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
  }
  s.points.push_back({0, 0, -1});
  const auto at = [&](unsigned ring, unsigned j) { return 1 + (ring - 1) * sectors + j % sectors; };
  const unsigned south = 1 + (rings - 1) * sectors;
  for (unsigned j = 0; j < sectors; ++j) {
    s.triangles.push_back({0, at(1, j), at(1, j + 1)});
    for (unsigned i = 1; i + 1 < rings; ++i) {
      s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    s.triangles.push_back({at(rings - 1, j), south, at(rings - 1, j + 1)});
  }
  return s;
}

}  // namespace

int main(int argc, char** argv) {
  octafront::Options options;
  options.size.size = 0.15;  // edge length, in the units of the surface
  try {
    const octafront::Result result = octafront::generate(sphere(40, 80), options);
    std::printf("%zu tetrahedra, mean beta %.3f, volume %.4f of %.4f\n", result.mesh.tets.size(),
                result.report.quality.beta_mean, result.report.volume, 4.0 / 3.0 * std::numbers::pi);
    octafront::write_mesh(argc > 1 ? argv[1] : "sphere.vtu", result.mesh);
  } catch (const octafront::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
