#include "carrying.h"

#include <octafront/octafront.h>

#include "commands.h"
#include "inputs.h"
#include "mesh_in_words.h"
#include "targets.h"
#include "text.h"

#include <string>
#include <utility>

#include <fmt/core.h>

namespace octafront::cli {
namespace {

bool carries_all(const Arguments& a) {
  return a.carry.empty() || (a.carry.size() == 1 && a.carry[0] == "all");
}

void say_extent(const Session& session, const FieldReport& field, std::size_t k) {
  const std::string name = field.components == 1 ? field.name : fmt::format("{}[{}]", field.name, k);
  const char* of = field.of_elements ? "elements" : "nodes";
  const auto line = [&](const char* when, const FieldExtent& extent) {
    session.say(fmt::format("{:<16} {:<8} {:<6} {:>22.15g} {:>14.7g} {:>14.7g}\n", name, of, when, extent.integral[k],
                            extent.least[k], extent.greatest[k]));
  };
  line("before", field.before), line("after", field.after);
}

}  // namespace

void tell_fields(Session& session, const std::vector<FieldReport>& fields) {
  session.found({{"carried", Json::parse(to_json(fields))}});
  session.say(
      fmt::format("{:<16} {:<8} {:<6} {:>22} {:>14} {:>14}\n", "field", "of", "", "integral", "least", "greatest"));
  for (const FieldReport& field : fields)
    for (std::size_t k = 0; k < field.components; ++k) say_extent(session, field, k);
}

std::vector<MeshField> fields_to_carry(Session& session, const TetMesh& mesh) {
  const Arguments& a = session.arguments();
  const bool is_default = carries_all(a);
  if (a.carry.size() == 1 && a.carry[0] == "none") return {};
  if (!some_target_holds_fields(a)) {
    if (is_default) return {};
    throw OptionError("--carry: no output holds fields; write .vtu, .vtk, .msh, .med, .exo, .cgns or .xdmf");
  }
  // What was not asked for is no reason to fail.
  if (is_default)
    return mesh.order() == 1 || (mesh.order() == 2 && a.options.carry.quadratic_nodes) ? all_fields(session, mesh)
                                                                                       : std::vector<MeshField>{};
  FieldsOfFile found = read_fields(a.input.string(), mesh, a.carry, session.context());
  session.say_notes("fields", found.notes);
  return std::move(found.fields);
}

std::vector<MeshField> all_fields(Session& session, const TetMesh& mesh) {
  if (!some_target_holds_fields(session.arguments())) return {};
  try {
    FieldsOfFile found = read_fields(session.arguments().input.string(), mesh, {}, session.context());
    session.say_notes("fields", found.notes);
    return std::move(found.fields);
  } catch (const InputError& error) {
    session.say_notes("fields", {fmt::format("no field goes along: {}", error.what())});
    return {};
  }
}

void keep_fields_of_corners(Session& session, std::vector<MeshField>& fields, std::size_t corners, std::size_t nodes) {
  std::string lost;
  for (const MeshField& field : fields)
    if (!field.of_elements && nodes > corners) lost += (lost.empty() ? "" : ", ") + field.name;
  std::erase_if(fields, [&](const MeshField& f) { return !f.of_elements && nodes > corners; });
  for (MeshField& field : fields)
    if (!field.of_elements) field.values.resize(corners * field.components);
  if (!lost.empty())
    session.say_notes("fields",
                      {"nodes in the middle of edges have no values, and these fields are left out: " + lost});
}

std::vector<MeshField> carried_fields(Session& session, const std::vector<MeshField>& fields, const TetMesh& before,
                                      const TetMesh& now, OutsideNodes outside, const KnownItems* same) {
  if (fields.empty()) return {};
  CarriedFields made =
      carry_fields(fields, before, now, session.arguments().options.carry, session.context(), outside, same);
  session.say_notes("fields", made.report.notes);
  session.found({{"carry", Json::parse(to_json(made.report))}});
  tell_fields(session, made.report.fields);
  return std::move(made.fields);
}

void run_carry(Session& session) {
  const Arguments& a = session.arguments();
  check_mesh_targets(a);
  if (!some_target_holds_fields(a))
    throw OptionError("no output holds fields; write .vtu, .vtk, .msh, .med, .exo, .cgns or .xdmf");
  const TetMesh before = read_mesh_input(session), now = read_mesh_file_of(session, a.bodies[1]).mesh;
  if (before.order() > 2 || (before.order() == 2 && !a.options.carry.quadratic_nodes))
    throw InputError(fmt::format("{}: is of order {}, and fields are of linear elements ({})", a.input.string(),
                                 before.order(),
                                 before.order() == 2 ? "--quadratic-nodes" : "octafront convert --order 1"));
  const std::vector<MeshField> fields = fields_to_carry(session, before);
  if (fields.empty())
    throw InputError(fmt::format("{}: has no field that can be carried: at points, or of tetrahedra, one value each",
                                 a.input.string()));
  const std::vector<MeshField> made = carried_fields(session, fields, before, now, OutsideNodes::kNearest);
  write_mesh_targets(session, now, made);
  for (const std::filesystem::path& file : a.meshes) session.say(fmt::format("written: {}\n", file.string()));
}

}  // namespace octafront::cli
