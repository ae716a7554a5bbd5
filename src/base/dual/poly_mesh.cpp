#include <octafront/poly_mesh.h>
#include <octafront/run_context.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/core/wording.h"
#include "base/dual/poly_measures.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront {
namespace {

class DefectFinder {
 public:
  DefectFinder(const PolyMesh& mesh, const RunContext& context) : mesh_(mesh), context_(context) {}

  std::optional<std::string> first_defect() const {
    if (auto defect = defect_of_lists()) return defect;
    if (auto defect = defect_of_points()) return defect;
    if (const std::size_t f = parallel_find(mesh_.faces(), [&](std::size_t i) { return is_bad_face(i); });
        f < mesh_.faces())
      return fmt::format("face {} has fewer than three points, one twice, or cells out of order", f);
    context_.check();
    const Groups<> faces = dual::faces_of_cells(mesh_);
    const auto is_bad = [&](std::size_t c) {
      return faces[c].empty() || !dual::is_closed(mesh_, static_cast<std::uint32_t>(c), faces[c]) ||
             !(volume(c, faces[c]) > 0);
    };
    const std::size_t c = parallel_find(mesh_.cells(), is_bad);
    if (c == mesh_.cells()) return std::nullopt;
    if (faces[c].empty()) return fmt::format("cell {} has no faces", c);
    const std::string at = at_point(dual::mean_of(mesh_, faces[c].front()));
    if (!dual::is_closed(mesh_, static_cast<std::uint32_t>(c), faces[c]))
      return fmt::format("cell {} at {} is not closed", c, at);
    return fmt::format("cell {} at {} has the volume {}", c, at, volume(c, faces[c]));
  }

 private:
  std::optional<std::string> defect_of_lists() const {
    const std::size_t faces = mesh_.owner.size();
    if (mesh_.face_begin.size() != faces + 1 || mesh_.patch.size() != faces || mesh_.neighbour.size() > faces ||
        mesh_.vertex.size() != mesh_.cells() || mesh_.face_begin.front() != 0 ||
        mesh_.face_begin.back() != mesh_.face_points.size() || !std::ranges::is_sorted(mesh_.face_begin))
      return "its lists do not fit each other";
    const auto is_cell = [&](std::uint32_t c) { return c < mesh_.cells(); };
    if (!std::ranges::all_of(mesh_.owner, is_cell) || !std::ranges::all_of(mesh_.neighbour, is_cell))
      return "a face names a cell that is not there";
    if (!std::ranges::all_of(mesh_.face_points, [&](VertexIndex p) { return p < mesh_.points.size(); }))
      return "a face names a point that is not there";
    return std::nullopt;
  }

  std::optional<std::string> defect_of_points() const {
    std::vector<bool> is_used(mesh_.points.size(), false);
    for (const VertexIndex p : mesh_.face_points) is_used[p] = true;
    for (std::size_t p = 0; p < is_used.size(); ++p) {
      if (!is_used[p]) return fmt::format("point {} is in no face", p);
      if (!is_finite(mesh_.points[p])) return fmt::format("point {} is not finite", p);
    }
    return std::nullopt;
  }

  bool is_bad_face(std::size_t f) const {
    const auto points = mesh_.face(f);
    if (points.size() < 3) return true;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (std::ranges::count(points, points[i]) > 1) return true;
    const std::size_t inner = mesh_.inner_faces();
    if (f < inner && mesh_.owner[f] >= mesh_.neighbour[f]) return true;
    if (f == 0 || f == inner) return false;
    if (f < inner)
      return std::pair(mesh_.owner[f], mesh_.neighbour[f]) < std::pair(mesh_.owner[f - 1], mesh_.neighbour[f - 1]);
    return std::pair(mesh_.patch[f], mesh_.owner[f]) < std::pair(mesh_.patch[f - 1], mesh_.owner[f - 1]);
  }

  double volume(std::size_t c, std::span<const std::uint32_t> faces) const {
    return dual::volume_of(mesh_, static_cast<std::uint32_t>(c), faces);
  }

  const PolyMesh& mesh_;
  const RunContext& context_;
};

}  // namespace

std::optional<std::string> first_defect(const PolyMesh& mesh, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  return DefectFinder(mesh, context).first_defect();
}

}  // namespace octafront
