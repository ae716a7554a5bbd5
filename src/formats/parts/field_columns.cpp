#include "formats/parts/field_columns.h"

#include <algorithm>

namespace octafront::io {
namespace {

std::string ending(const MeshField& field, std::size_t k, ComponentNames style) {
  std::string name = component_name(field.components, k);
  if (name.empty()) return name;
  if (style == ComponentNames::kUnderscored) return "_" + name;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'x' && c <= 'z' ? static_cast<char>(c - 'x' + 'X') : c; });
  return name;
}

}  // namespace

std::string component_name(std::size_t components, std::size_t k) {
  constexpr std::string_view kAxes = "xyz";
  if (components == 1) return {};
  if (components == 3) return std::string(1, kAxes[k]);
  if (components == 9) return {kAxes[k / 3], kAxes[k % 3]};
  return std::to_string(k + 1);
}

std::vector<FieldColumn> field_columns(MeshOutput& out, bool of_elements, const NameRules& rules,
                                       ComponentNames style) {
  // A field's name is cut so that endings fit behind it.
  constexpr std::size_t kEnding = 4;
  NameRules shorter = rules;
  shorter.longest -= kEnding;
  LegalNames of_fields(shorter), of_columns(rules);
  std::vector<FieldColumn> columns;
  for (const MeshField& field : out.fields()) {
    if (field.of_elements != of_elements) continue;
    const std::string base = field.components == 1 ? field.name : of_fields.legal(field.name);
    for (std::size_t k = 0; k < field.components; ++k)
      columns.push_back({&field, k, of_columns.legal(base + ending(field, k, style))});
  }
  out.note(of_fields.note());
  out.note(of_columns.note());
  return columns;
}

}  // namespace octafront::io
