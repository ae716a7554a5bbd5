#include "io/legal_names.h"
#include "io/text_writer.h"
#include "io/writers.h"

#include <array>
#include <cstring>

namespace octafront::io {
void write_ply(AtomicFile& file, const SurfaceMesh& surface) {
  TextWriter out(file);
  out << "ply\nformat binary_little_endian 1.0\n";
  for (std::uint32_t p = 0; p < surface.patch_names.size(); ++p)
    out << "comment patch " << p << ' ' << one_line(surface.patch_names[p]) << '\n';
  out << "element vertex " << std::uint64_t{surface.points.size()} << '\n';
  out << "property double x\nproperty double y\nproperty double z\n";
  out << "element face " << std::uint64_t{surface.triangles.size()} << '\n';
  out << "property list uchar uint vertex_indices\n";
  if (!surface.patch.empty()) out << "property uint patch\n";
  out << "end_header\n";
  for (const Vec3& p : surface.points) {
    const std::array<double, 3> xyz{p.x, p.y, p.z};
    file.write(xyz.data(), sizeof xyz);
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    std::array<char, 17> record{3};
    std::memcpy(record.data() + 1, surface.triangles[t].data(), 12);
    if (!surface.patch.empty()) std::memcpy(record.data() + 13, &surface.patch[t], 4);
    file.write(record.data(), surface.patch.empty() ? 13 : 17);
  }
}

}  // namespace octafront::io
