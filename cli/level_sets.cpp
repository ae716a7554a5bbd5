#include "level_sets.h"

#include <octafront/octafront.h>

#include "text.h"

#include <utility>

#include <fmt/core.h>

namespace octafront::cli {

void cut_along_fields(Session& session, TetMesh& mesh, std::vector<MeshField>& fields) {
  const Arguments& a = session.arguments();
  std::vector<LevelSet> level_sets;
  for (const auto& [field, level] : a.level_sets)
    level_sets.push_back({field, read_point_values(a.input.string(), field, mesh, session.context()), level});
  CutMesh cut = cut_along(mesh, level_sets, {a.options.adapt.least_piece}, session.context());
  for (const LevelSetReport& r : cut.level_sets)
    session.say(fmt::format("{}: {} in {}, volume {:.6g}; {} between regions, area {:.6g}\n", r.name,
                            counted(r.elements, "element"), counted(r.pieces, "piece"), r.volume,
                            counted(r.triangles, "triangle"), r.area));
  session.found({{"level_sets", Json::parse(to_json(cut.level_sets))}});
  // All of an element lies in an old one, but where points moved.
  if (!fields.empty()) fields = carry_fields(fields, mesh, cut.mesh, a.options.carry, session.context()).fields;
  mesh = std::move(cut.mesh);
}

}  // namespace octafront::cli
