#include <octafront/error.h>
#include <octafront/formula.h>

#include <cmath>

#include <fmt/core.h>

namespace octafront {

namespace {

Vec3 place_of_item(const TetMesh& mesh, bool of_elements, std::size_t i) {
  if (!of_elements) return mesh.points[i];
  const auto& [a, b, c, d] = mesh.tets[i];
  return (mesh.points[a] + mesh.points[b] + mesh.points[c] + mesh.points[d]) * .25;
}

}  // namespace

MeshField field_by_formula(const TetMesh& mesh, const std::string& name, const std::string& formula,
                           std::span<const MeshField> fields, bool of_elements) {
  std::vector<const MeshField*> used;
  std::vector<std::string> names;
  for (const MeshField& field : fields)
    if (field.of_elements == of_elements && field.components == 1) used.push_back(&field), names.push_back(field.name);
  const Formula law(formula, 1, names);
  MeshField made{name, of_elements, 1, std::vector<double>(of_elements ? mesh.tets.size() : mesh.points.size())};
  std::vector<double> values(used.size());
  for (std::size_t i = 0; i < made.values.size(); ++i) {
    for (std::size_t f = 0; f < used.size(); ++f) values[f] = used[f]->values[i];
    made.values[i] = law.at(place_of_item(mesh, of_elements, i), values);
    if (std::isfinite(made.values[i])) continue;
    std::string where;
    for (std::size_t f = 0; f < used.size(); ++f) where += fmt::format(", {} = {:.6g}", names[f], values[f]);
    throw OptionError(fmt::format("`field`: {} = {} is no number in {} {}{}; max(..., ...) keeps it in its range", name,
                                  formula, of_elements ? "element" : "node", i + 1, where));
  }
  return made;
}

}  // namespace octafront
