#include <octafront/octafront.h>

#include "carrying.h"
#include "commands.h"
#include "inputs.h"
#include "mesh_in_words.h"
#include "targets.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

namespace octafront::cli {
namespace {

std::vector<Vec3> displacement_asked(Session& session, const TetMesh& mesh) {
  const Arguments& a = session.arguments();
  if (a.displacement.empty())
    throw OptionError(
        "--displacement is required: the field of the input, three numbers at each point, that it moves by");
  FieldsOfFile found = read_fields(a.input.string(), mesh, {a.displacement}, session.context());
  const auto field = std::find_if(found.fields.begin(), found.fields.end(),
                                  [](const MeshField& f) { return !f.of_elements && f.components == 3; });
  if (field == found.fields.end())
    throw InputError(
        fmt::format("{}: the field \"{}\" has not three numbers at each point", a.input.string(), a.displacement));
  std::vector<Vec3> displacement;
  for (std::size_t i = 0; i < field->values.size(); i += 3)
    displacement.push_back({field->values[i], field->values[i + 1], field->values[i + 2]});
  return displacement;
}

void tell_history(Session& session, const std::vector<MoveStep>& history) {
  session.say(fmt::format("{:>8} {:<9} {:>10} {:>8} {:>8} {:>14}\n", "done %", "then", "elements", "least β", "mean β",
                          "volume"));
  for (const MoveStep& step : history)
    session.say(fmt::format("{:>8.2f} {:<9} {:>10} {:>8.3f} {:>8.3f} {:>14.7g}\n", 100 * step.fraction, step.change,
                            step.elements, step.beta_min, step.beta_mean, step.volume));
  session.found({{"history", Json::parse(to_json(history))}});
}

}  // namespace

void run_move(Session& session) {
  const Arguments& a = session.arguments();
  check_mesh_targets(a);
  check_options(a.options);
  const TetMesh mesh = read_mesh_input(session);
  const std::vector<Vec3> displacement = displacement_asked(session, mesh);
  std::vector<MeshField> fields = fields_to_carry(session, mesh);
  // It has been done.
  std::erase_if(fields, [&](const MeshField& f) { return f.name == a.displacement; });
  const MovedMesh moved = move_mesh(mesh, displacement, fields, a.options, session.context());
  tell_history(session, moved.history);
  session.say_notes("move", moved.notes);
  if (!moved.carried.empty()) tell_fields(session, moved.carried);
  write_mesh_targets(session, moved.mesh, moved.fields);
  tell_worst(session, worst_elements(moved.mesh, kWorstListed));
  for (const std::filesystem::path& file : a.meshes) session.say(fmt::format("written: {}\n", file.string()));
}

}  // namespace octafront::cli
