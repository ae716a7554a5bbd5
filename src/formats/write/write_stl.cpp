#include <octafront/error.h>
#include <octafront/surface_mesh.h>

#include "formats/write/writers.h"

#include <array>
#include <cmath>
#include <cstring>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// Rounded to single precision, which binary STL has.
std::array<float, 3> rounded(Vec3 p, const std::string& name) {
  const std::array<float, 3> f{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  if (!std::isfinite(f[0]) || !std::isfinite(f[1]) || !std::isfinite(f[2]))
    throw OutputError(
        fmt::format("{}: the point ({}, {}, {}) is too large for STL; write .off, .obj or .ply", name, p.x, p.y, p.z));
  return f;
}

}  // namespace

void write_stl(AtomicFile& file, const SurfaceMesh& surface) {
  if (surface.triangles.size() >= kNone)
    throw OutputError(fmt::format("{}: STL cannot hold {} triangles", file.name(), surface.triangles.size()));
  // The header must not begin with "solid", which would make it look like text.
  std::array<char, 80> header{};
  constexpr std::string_view kTitle = "binary STL by octafront";
  std::memcpy(header.data(), kTitle.data(), kTitle.size());
  file.write(header.data(), header.size());
  const auto count = static_cast<std::uint32_t>(surface.triangles.size());
  file.write(&count, 4);
  for (const Triangle& t : surface.triangles) {
    const Vec3 a = surface.points[t[0]], b = surface.points[t[1]], c = surface.points[t[2]];
    std::array<char, 50> record{};
    std::size_t at = 0;
    for (const Vec3& v : {normalized(cross(b - a, c - a)), a, b, c}) {
      const std::array<float, 3> f = rounded(v, file.name());
      std::memcpy(record.data() + at, f.data(), sizeof f);
      at += sizeof f;
    }
    file.write(record.data(), record.size());
  }
}

}  // namespace octafront::io
