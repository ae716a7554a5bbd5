#include "domain.h"

#include <octafront/cad.h>
#include <octafront/error.h>
#include <octafront/image.h>
#include <octafront/io.h>
#include <octafront/repair.h>

#include "text.h"

#include <vector>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

/// Adds an octahedron at each change, large enough to be seen beside the model, in the patch of its kind.
void add_marks(const MendReport& report, SurfaceMesh& marks) {
  constexpr double kRadius = 0.004;  // of the diagonal
  const double r = kRadius * report.diagonal;
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
}

/// The changes of all repairs; a patch for each kind.
SurfaceMesh marks_of(const std::vector<IntakeRepair>& repairs) {
  SurfaceMesh marks;
  for (const IntakeRepair& repair : repairs) add_marks(repair.report, marks);
  for (int k = 0; k <= static_cast<int>(MendChange::Kind::kLaidFlat); ++k)
    marks.patch_names.emplace_back(name_of(static_cast<MendChange::Kind>(k)));
  return marks;
}

/// Of files that were refused on the way in: of the first one that has any.
void tell_defects_of_files(Session& session) {
  for (const std::filesystem::path& file : session.arguments().bodies) {
    try {
      if (is_cad(file.string()) || is_image(file.string())) continue;
      if (tell_defects(session, read_surface(file.string()).surface))
        return session.found({{"defects_of", file.string()}});
    } catch (const InputError&) {  // It is no surface, and the run has said so.
    }
  }
}

[[noreturn]] void fail_with_way(Session& session, const LeakError& leak) {
  Json way = Json::array();
  for (const Vec3 p : leak.way) way.push_back({p.x, p.y, p.z});
  session.found({{"leak", way}});
  const std::filesystem::path beside = cavity_neighbour(session.arguments());
  if (!session.is_first() || beside.empty() || leak.way.size() < 2) throw leak;
  write_surface(leak_file(beside).string(), tube_along(leak.way));
  throw InputError(fmt::format("{}\nThe way through the hole is in {}", leak.what(), leak_file(beside).string()));
}

}  // namespace

bool tell_defects(Session& session, const SurfaceMesh& surface) {
  if (session.arguments().json.empty() || surface.triangles.empty()) return false;
  const SurfaceDefects defects = find_defects(repair_surface(surface));
  if (!defects.clean()) session.found({{"clean", false}, {"defects", Json::parse(to_json(defects))}});
  return !defects.clean();
}

std::filesystem::path leak_file(std::filesystem::path output) {
  return output.replace_extension(".leak.ply");
}

Domain open_input(Session& session, const IntakeOptions& options) {
  const Arguments& a = session.arguments();
  IntakeOptions told = options;
  told.tell = [&](const IntakeNote& note) {
    note.stage.empty() ? session.say(note.text + "\n") : session.say_notes(note.stage, {note.text});
  };
  try {
    Domain domain = open_domain(in_utf8(a.bodies), told, session.context());
    if (domain.unit.empty()) domain.unit = a.unit;
    session.found(Json::parse(to_json(domain)));
    session.frame = domain.frame, session.unit = domain.unit, session.densities = domain.densities;
    if (!a.defects.empty() && !domain.repairs.empty())
      write_surface(a.defects.string(), marks_of(domain.repairs), session.context());
    return domain;
  } catch (const LeakError& leak) {
    fail_with_way(session, leak);
  } catch (const InputError&) {
    if (!a.json.empty()) tell_defects_of_files(session);
    throw;
  }
}

std::optional<Domain> open_ground(Session& session) {
  const Arguments& a = session.arguments();
  if (a.surface.empty()) return std::nullopt;
  IntakeOptions as_it_is = a.intake;
  as_it_is.repair = IntakeOptions::Repair::kOff;
  as_it_is.cad.keep_edges = true;
  as_it_is.tell = [&](const IntakeNote& note) {
    if (!note.stage.empty()) session.say_notes(note.stage, {note.text});
  };
  return open_domain(in_utf8({a.surface}), as_it_is, session.context());
}

}  // namespace octafront::cli
