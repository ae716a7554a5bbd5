#include "surface/remeshing/surface_check.h"

#include <octafront/repair.h>

#include "base/core/wording.h"
#include "base/mesh/edge_table.h"
#include "soup/tidy/defect_steps.h"
#include "soup/tidy/steps.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/core.h>

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

RepairedSurface as_it_is(const SurfaceMesh& surface) {
  RepairedSurface as_is;
  as_is.surface = surface;
  as_is.surface.source.clear();
  return as_is;
}

std::optional<std::string> first_line(const SurfaceDefects& defects) {
  if (defects.clean()) return std::nullopt;
  const std::string all = defects.describe();
  return all.substr(0, all.find('\n'));
}

}  // namespace

/// Requires a surface that is closed and manifold.
SurfaceKind::Shells SurfaceKind::shells_of(const SurfaceMesh& surface, const EdgeTable& edges) {
  const RunContext context;
  tidy::Draft draft{surface, std::vector<std::uint32_t>(surface.triangles.size()), context, edges};
  const tidy::Pieces pieces = tidy::orient_pieces(draft);
  const tidy::Nesting nesting = tidy::find_nesting(surface, pieces, std::vector<char>(pieces.count(), 1), context);
  const std::vector<int> sign = tidy::volume_signs(surface, pieces);
  std::vector<Shell> kinds(pieces.count());
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
    kinds[p].piece = p;
  }
  std::sort(kinds.begin(), kinds.end(), [](const Shell& a, const Shell& b) { return a.key() < b.key(); });
  return {std::move(kinds), pieces.piece_of_triangle};
}

std::string SurfaceKind::words(const Shell& shell) {
  return fmt::format("a shell of genus {} inside {}, at {}", shell.genus, counted(shell.depth, "other"),
                     at_point(shell.at));
}

SurfaceKind::SurfaceKind(const SurfaceMesh& input, const EdgeTable& edges) : wanted_(shells_of(input, edges).sorted) {}

/// Per piece whether it faces the wrong way, or is of a kind of which there are more than are wanted.
std::vector<std::uint8_t> SurfaceKind::wrong_pieces(const std::vector<Shell>& made) const {
  const auto by_key = [](const Shell& a, const Shell& b) { return a.key() < b.key(); };
  std::vector<std::uint8_t> is_wrong(made.size(), 0);
  for (const Shell& shell : made) {
    const auto [first, last] = std::equal_range(made.begin(), made.end(), shell, by_key);
    const auto [wanted, end] = std::equal_range(wanted_.begin(), wanted_.end(), shell, by_key);
    is_wrong[shell.piece] = !shell.faces_right() || last - first > end - wanted;
  }
  return is_wrong;
}

std::optional<std::string> SurfaceKind::first_defect_but_crossings(const SurfaceMesh& result, const RunContext& context,
                                                                   std::vector<Vec3>* places) const {
  if (auto defect = first_bad_vertex(result)) return defect;
  const RepairedSurface as_is = as_it_is(result);
  const EdgeTable table = make_edge_table(result.points.size(), result.triangles);
  if (auto defect = first_line(tidy::find_defects_but_crossings(as_is, table, context))) return defect;
  const auto [made, piece_of_triangle] = shells_of(result, table);
  if (places) {
    const std::vector<std::uint8_t> is_wrong = wrong_pieces(made);
    std::vector<char> is_taken(result.points.size(), 0);
    for (std::size_t t = 0; t < result.triangles.size(); ++t) {
      if (!is_wrong[piece_of_triangle[t]]) continue;
      for (const VertexIndex v : result.triangles[t])
        if (!std::exchange(is_taken[v], 1)) places->push_back(result.points[v]);
    }
  }
  for (const Shell& shell : made)
    if (!shell.faces_right()) return words(shell) + " is inside out";
  if (made.size() != wanted_.size())
    return fmt::format("{} instead of {}", counted(made.size(), "shell"), wanted_.size());
  for (std::size_t k = 0; k < made.size(); ++k)
    if (made[k].key() != wanted_[k].key()) return words(made[k]) + " instead of " + words(wanted_[k]);
  return std::nullopt;
}

std::optional<std::string> first_surface_defect(const SurfaceMesh& result, const SurfaceMesh& input,
                                                const RunContext& context) {
  if (auto defect = first_bad_vertex(result)) return defect;
  if (auto defect = first_line(find_defects(as_it_is(result), context))) return defect;
  return SurfaceKind(input, make_edge_table(input.points.size(), input.triangles))
      .first_defect_but_crossings(result, context);
}

std::optional<std::string> first_complex_defect_but_crossings(const SurfaceMesh& complex, const RunContext& context,
                                                              std::vector<Vec3>* places) {
  if (auto bad = first_bad_vertex(complex)) return bad;
  const EdgeTable edges = make_edge_table(complex.points.size(), complex.triangles);
  const SurfaceDefects found = tidy::find_region_defects(as_it_is(complex), edges, context, places);
  return first_line(found);
}

}  // namespace octafront
