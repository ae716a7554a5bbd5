#include <octafront/generate.h>
#include <octafront/mpi.h>

#include <iostream>

/// A tetrahedron, meshed by all processes.
int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  {
    octafront::SurfaceMesh surface;
    surface.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    surface.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    octafront::Options options;
    options.size.size = 0.05;
    octafront::MpiRanks ranks(MPI_COMM_WORLD);
    octafront::RunContext context;
    context.ranks = &ranks;
    const octafront::Result result = octafront::generate(surface, options, context);
    if (ranks.rank() == 0)
      std::cout << ranks.size() << " ranks, " << result.mesh.tets.size() << " tetrahedra, "
                << (ranks.use.bytes_taken > 0 ? "shared" : "alone") << std::endl;
  }
  MPI_Finalize();
}
