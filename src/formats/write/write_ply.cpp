#include <octafront/surface_mesh.h>

#include "formats/containers/text_writer.h"
#include "formats/parts/legal_names.h"
#include "formats/write/writers.h"

#include <array>
#include <cstring>

namespace octafront::io {

void write_ply(AtomicFile& file, const SurfaceMesh& surface) {
  TextWriter out(file);
  const bool has_patches = !surface.patch.empty(), has_sides = !surface.sides.empty();
  out << "ply\nformat binary_little_endian 1.0\n";
  for (std::uint32_t p = 0; p < surface.patch_names.size(); ++p)
    out << "comment patch " << p << ' ' << one_line(surface.patch_names[p]) << '\n';
  for (std::uint32_t r = 0; has_sides && r < surface.region_names.size(); ++r)
    out << "comment region " << r << ' ' << one_line(surface.region_names[r]) << '\n';
  out << "element vertex " << std::uint64_t{surface.points.size()} << '\n';
  out << "property double x\nproperty double y\nproperty double z\n";
  out << "element face " << std::uint64_t{surface.triangles.size()} << '\n';
  out << "property list uchar uint vertex_indices\n";
  if (has_patches) out << "property uint patch\n";
  // Outside is -1, which is kNone in 32 bits.
  if (has_sides) out << "property int front\nproperty int back\n";
  out << "end_header\n";
  for (const Vec3& p : surface.points) {
    const std::array<double, 3> xyz{p.x, p.y, p.z};
    file.write(xyz.data(), sizeof xyz);
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    std::array<char, 25> record{3};
    std::size_t size = 1;
    const auto append = [&](const void* value, std::size_t bytes) {
      std::memcpy(record.data() + size, value, bytes);
      size += bytes;
    };
    append(surface.triangles[t].data(), 12);
    if (has_patches) append(&surface.patch[t], 4);
    if (has_sides) append(surface.sides[t].data(), 8);
    file.write(record.data(), size);
  }
}

}  // namespace octafront::io
