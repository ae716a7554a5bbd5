#include "mending.h"

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/mend.h>

#include "text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

MendOptions options_of(const Arguments& a) {
  MendOptions options = a.mend;
  options.tolerance = a.complex.tolerance;
  options.way = a.repair == Repair::kWrap ? MendOptions::Way::kWrap : MendOptions::Way::kAuto;
  return options;
}

/// An octahedron at each change, large enough to be seen beside the model; a patch for each kind.
SurfaceMesh marks_of(const MendReport& report) {
  constexpr double kRadius = 0.004;  // of the diagonal
  const double r = kRadius * report.diagonal;
  SurfaceMesh marks;
  for (const MendChange& change : report.changes) {
    const auto first = static_cast<VertexIndex>(marks.points.size());
    for (const Vec3 off : {Vec3{r, 0, 0}, Vec3{-r, 0, 0}, Vec3{0, r, 0}, Vec3{0, -r, 0}, Vec3{0, 0, r}, Vec3{0, 0, -r}})
      marks.points.push_back(change.at + off);
    for (const VertexIndex x : {0u, 1u})
      for (const VertexIndex y : {2u, 3u})
        for (const VertexIndex z : {4u, 5u}) {
          const bool even = (x + y + z) % 2 == 0;
          marks.triangles.push_back({first + x, first + (even ? y : z), first + (even ? z : y)});
          marks.patch.push_back(static_cast<std::uint32_t>(change.kind));
        }
  }
  for (int k = 0; k <= static_cast<int>(MendChange::Kind::kRebuilt); ++k)
    marks.patch_names.emplace_back(name_of(static_cast<MendChange::Kind>(k)));
  return marks;
}

/// Whether duplicates and turned faces were all there was: the mesher's own repair sees to these and says so, with
/// places.
bool is_tidied_only(const MendReport& r) {
  return r.changes.empty() && r.crossing_pairs == 0 && r.joined_vertices == 0 && r.divided_edges == 0 &&
         r.separated_vertices == 0 && r.largest_move == 0;
}

/// Keeps what keep[t] says of an array with a value for each triangle, or none.
template <class T>
void keep_marked(std::vector<T>& values, const std::vector<char>& keep) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < values.size(); ++t)
    if (keep[t]) values[kept++] = values[t];
  values.resize(kept);
}

}  // namespace

void drop_sheets(Session& session, SurfaceMesh& complex) {
  if (session.arguments().sheets == Sheets::kKeep || session.arguments().repair == Repair::kNone) return;
  std::vector<char> keep;
  for (const Sides& sides : complex.sides) keep.push_back(sides[0] != sides[1]);
  const auto dropped = std::count(keep.begin(), keep.end(), 0);
  if (dropped == 0) return;
  const double before = area(complex);
  keep_marked(complex.triangles, keep);
  keep_marked(complex.patch, keep);
  keep_marked(complex.source, keep);
  keep_marked(complex.sides, keep);
  session.say_notes("repair",
                    {fmt::format("{} of sheets dropped, area {:.4g}; --sheets keep keeps them",
                                 counted(static_cast<std::uint64_t>(dropped), "face"), before - area(complex))});
  session.found({{"dropped_sheet_faces", dropped}});
}

void mend(Session& session, const std::filesystem::path& file, SurfaceMesh& surface) {
  const Arguments& a = session.arguments();
  if (a.repair == Repair::kNone || !surface.sides.empty()) return;
  Mended mended = mend_surface(surface, options_of(a), session.context());
  const Json report = Json::parse(to_json(mended.report));
  const bool is_one_of_several = a.bodies.size() > 1 || file != a.input;
  session.found({{is_one_of_several ? "repair " + file.string() : "repair", report}});
  if (!a.defects.empty()) write_surface(a.defects, marks_of(mended.report), session.context());
  if (mended.report.clean || (a.command != "repair" && is_tidied_only(mended.report))) return;
  if (!is_one_of_several) session.mended_with(std::move(mended.bound));
  session.say_notes("repair", mended.report.notes);
  surface = std::move(mended.surface);
}

}  // namespace octafront::cli
