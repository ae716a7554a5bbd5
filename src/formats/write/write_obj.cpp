#include <octafront/surface_mesh.h>

#include "formats/containers/text_writer.h"
#include "formats/write/writers.h"

#include <algorithm>
#include <string>

namespace octafront::io {
namespace {

/// Names end with the line.
std::string group_name(const SurfaceMesh& surface, std::uint32_t patch) {
  std::string name = patch < surface.patch_names.size() ? surface.patch_names[patch] : std::string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '\n' || c == '\r' || c == '#'; }, '_');
  return name.empty() ? "patch_" + std::to_string(patch) : name;
}

}  // namespace

void write_obj(AtomicFile& file, const SurfaceMesh& surface) {
  TextWriter out(file);
  for (const Vec3& p : surface.points) out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  const bool grouped = !surface.patch.empty() || !surface.patch_names.empty();
  std::uint32_t group = kNone;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (grouped && surface.patch_of(t) != group) {
      group = surface.patch_of(t);
      out << "g " << group_name(surface, group) << '\n';
    }
    const auto& [a, b, c] = surface.triangles[t];
    out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  }
}

}  // namespace octafront::io
