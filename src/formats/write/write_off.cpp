#include <octafront/surface_mesh.h>

#include "formats/containers/text_writer.h"
#include "formats/write/writers.h"

namespace octafront::io {

void write_off(AtomicFile& file, const SurfaceMesh& surface) {
  TextWriter out(file);
  out << "OFF\n" << std::uint64_t{surface.points.size()} << ' ' << std::uint64_t{surface.triangles.size()} << " 0\n";
  for (const Vec3& p : surface.points) out << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const auto& [a, b, c] : surface.triangles) out << "3 " << a << ' ' << b << ' ' << c << '\n';
}

}  // namespace octafront::io
