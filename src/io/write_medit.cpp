#include "io/text_writer.h"
#include "io/writers.h"

namespace octafront::io {

// References count from 1: 0 means "none" to programs that read them.
void write_medit(AtomicFile& file, const TetMesh& mesh) {
  TextWriter out(file);
  out << "MeshVersionFormatted 2\n\nDimension 3\n\nVertices\n" << std::uint64_t{mesh.points.size()} << '\n';
  for (const Vec3& p : mesh.points) out << p.x << ' ' << p.y << ' ' << p.z << " 0\n";
  out << "\nTriangles\n" << std::uint64_t{mesh.boundary.size()} << '\n';
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    const auto& [a, b, c] = mesh.boundary[i];
    const std::uint32_t patch = mesh.patch.empty() ? 0 : mesh.patch[i];
    out << a + 1 << ' ' << b + 1 << ' ' << c + 1 << ' ' << patch + 1 << '\n';
  }
  out << "\nTetrahedra\n" << std::uint64_t{mesh.tets.size()} << '\n';
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    const auto& [a, b, c, d] = mesh.tets[i];
    const std::uint32_t region = mesh.region.empty() ? 0 : mesh.region[i];
    out << a + 1 << ' ' << b + 1 << ' ' << c + 1 << ' ' << d + 1 << ' ' << region + 1 << '\n';
  }
  out << "\nEnd\n";
}

}  // namespace octafront::io
