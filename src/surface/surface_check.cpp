#include "surface/surface_check.h"

#include <octafront/repair.h>

#include "surface/repair_steps.h"
#include "surface/wording.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

namespace octafront {
namespace {

std::optional<std::string> first_bad_vertex(const SurfaceMesh& surface) {
  std::vector<char> used(surface.points.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const VertexIndex v : surface.triangles[t]) {
      if (v >= surface.points.size())
        return fmt::format("triangle {} refers to vertex {} of {}", t, v, surface.points.size());
      used[v] = 1;
    }
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!is_finite(surface.points[v])) return fmt::format("vertex {} is not at finite coordinates", v);
    if (!used[v]) return fmt::format("no triangle uses vertex {} at {}", v, at_point(surface.points[v]));
  }
  return std::nullopt;
}

/// What does not change when a shell is triangulated anew.
struct ShellKind {
  std::uint32_t depth = 0;  ///< number of shells around it
  std::int64_t genus = 0;
  int sign = 0;  ///< of the volume it encloses
  Vec3 at;       ///< a vertex of it

  auto key() const { return std::tuple{depth, genus, sign}; }
};

/// Requires a surface that is closed and manifold.
std::vector<ShellKind> shell_kinds(const SurfaceMesh& surface) {
  repair::Draft draft{surface, std::vector<std::uint32_t>(surface.triangles.size())};
  const repair::Pieces pieces = repair::orient_pieces(draft);
  const repair::Nesting nesting = repair::find_nesting(surface, pieces, std::vector<char>(pieces.count(), 1));
  const std::vector<int> sign = repair::volume_signs(surface, pieces);
  std::vector<ShellKind> kinds(pieces.count());
  std::vector<std::int64_t> vertices(pieces.count(), 0), faces(pieces.count(), 0);
  std::vector<char> counted_vertex(surface.points.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const std::uint32_t piece = pieces.piece_of_triangle[t];
    ++faces[piece];
    for (const VertexIndex v : surface.triangles[t]) {
      vertices[piece] += !counted_vertex[v];
      counted_vertex[v] = 1;
      kinds[piece].at = surface.points[v];
    }
  }
  for (std::uint32_t p = 0; p < pieces.count(); ++p) {
    // V - E + F = 2 - 2 g, and a closed surface has three edges for two faces.
    kinds[p].genus = (2 - vertices[p] + faces[p] / 2) / 2;
    kinds[p].depth = nesting.depth[p];
    kinds[p].sign = sign[p];
  }
  std::sort(kinds.begin(), kinds.end(), [](const ShellKind& a, const ShellKind& b) { return a.key() < b.key(); });
  return kinds;
}

std::string words(const ShellKind& kind) {
  return fmt::format("a shell of genus {} inside {}, at {}", kind.genus, counted(kind.depth, "other"),
                     at_point(kind.at));
}

}  // namespace

std::optional<std::string> first_surface_defect(const SurfaceMesh& result, const SurfaceMesh& input) {
  if (auto defect = first_bad_vertex(result)) return defect;
  RepairedSurface as_is;
  as_is.surface = result;
  as_is.face_of_triangle.resize(result.triangles.size());
  std::iota(as_is.face_of_triangle.begin(), as_is.face_of_triangle.end(), 0u);
  const SurfaceDefects defects = find_defects(as_is);
  if (!defects.clean()) {
    const std::string all = defects.describe();
    return all.substr(0, all.find('\n'));
  }

  const std::vector<ShellKind> made = shell_kinds(result), wanted = shell_kinds(input);
  for (const ShellKind& kind : made)
    if (kind.sign != (kind.depth % 2 == 0 ? 1 : -1)) return words(kind) + " is inside out";
  if (made.size() != wanted.size())
    return fmt::format("{} instead of {}", counted(made.size(), "shell"), wanted.size());
  for (std::size_t k = 0; k < made.size(); ++k)
    if (made[k].key() != wanted[k].key()) return words(made[k]) + " instead of " + words(wanted[k]);
  return std::nullopt;
}

}  // namespace octafront
