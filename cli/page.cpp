#include "page.h"

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/repair.h>
#include <octafront/report_page.h>

#include "targets.h"

#include <array>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

constexpr std::size_t kMostPlaces = 20;

using Corners = std::array<Vec3, 3>;

Corners corners_of(const SurfaceMesh& surface, std::size_t t) {
  const Triangle& v = surface.triangles[t];
  return {surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]};
}

bool is_same_point(Vec3 a, Vec3 b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

/// The same three corners the other way round.
bool is_turned(const Corners& a, const Corners& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (is_same_point(a[0], b[k]) && is_same_point(a[1], b[(k + 2) % 3]) && is_same_point(a[2], b[(k + 1) % 3]))
      return true;
  return false;
}

/// A kind of change: how often, and where first.
struct Change {
  const char* what;
  std::uint64_t count = 0;
  std::vector<Vec3> places = {};

  void add(const Corners& face) {
    if (++count <= kMostPlaces) places.push_back((face[0] + face[1] + face[2]) / 3);
  }
};

/// By comparing what went in with what came out: each triangle of the result knows the one it came from.
std::vector<Change> face_changes(const SurfaceMesh& input, const SurfaceMesh& output) {
  Change removed{"faces removed: without area, or there twice"}, turned{"faces turned"};
  Change divided{"faces divided beside one without area"};
  constexpr std::size_t kNothing = ~std::size_t{0};
  std::vector<std::size_t> became(input.triangles.size(), kNothing);
  std::vector<bool> is_divided(input.triangles.size(), false);
  for (std::size_t t = 0; t < output.triangles.size(); ++t) {
    const std::size_t from = output.source_of(t);
    is_divided[from] = became[from] != kNothing;
    became[from] = t;
  }
  for (std::size_t t = 0; t < input.triangles.size(); ++t) {
    const Corners face = corners_of(input, t);
    if (became[t] == kNothing) {
      removed.add(face);
    } else if (is_divided[t]) {
      divided.add(face);
    } else if (is_turned(face, corners_of(output, became[t]))) {
      turned.add(face);
    }
  }
  return {removed, divided, turned};
}

Json json_of_change(const Change& change) {
  Json places = Json::array();
  for (const Vec3& p : change.places) places.push_back({p.x, p.y, p.z});
  return {{"what", change.what}, {"count", change.count}, {"places", places}};
}

}  // namespace

void check_page_target(const std::filesystem::path& page) {
  const std::string ending = CLI::detail::to_lower(page.extension().string());
  if (page.empty() || page == kStandardOutput || ending == ".html" || ending == ".htm") return;
  throw OptionError(fmt::format("{}: a report is a web page: give it the ending .html{}", page.string(),
                                ending == ".json" ? ", or use --json for one that programs read" : ""));
}

void find_repairs(Session& session, const SurfaceMesh& input) {
  SurfaceMesh triangles = input;
  triangles.source.clear();  // triangles, not the polygons of the file
  const RepairedSurface repaired = repair_surface(triangles, session.context());
  Json repairs = Json::array();
  const std::uint64_t merged = has_vertices_of_each_triangle(triangles) ? 0 : repaired.merged_vertices;
  for (const auto& [what, count] : {std::pair{"vertices merged, at the same place", merged},
                                    std::pair{"vertices removed that no face used", repaired.unused_vertices}})
    if (count > 0) repairs.push_back({{"what", what}, {"count", count}, {"places", Json::array()}});
  for (const Change& change : face_changes(triangles, repaired.surface))
    if (change.count > 0) repairs.push_back(json_of_change(change));
  session.found({{"repairs", repairs}});
}

void write_page(const std::filesystem::path& file, const Session& session, const TetMesh& mesh,
                const SizeField* sizes) {
  // Names of files may hold bytes that no text has.
  const std::string json = session.json(nullptr).dump(-1, ' ', false, Json::error_handler_t::replace);
  write_text_target(file, report_page(mesh, sizes, json, session.context()));
}

}  // namespace octafront::cli
