#include "schema.h"

#include <octafront/option_table.h>

#include "arguments.h"

#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

/// A value of the report: where it stands, with [] for each of a list and * for any name, what it is, and what it says.
/// Types are those of JSON, and: place (x, y, z), box (two places); "[...]" are lists, "?" also null, "any" whatever.
struct ReportField {
  const char *path, *type, *about;
};

constexpr ReportField kReport[] = {
    {"program", "string", "octafront"},
    {"version", "string", "of the program"},
    {"command", "string", "that ran; empty where none was understood"},
    {"command_line", "string", "quoted for a shell"},
    {"status", "integer", "of the exit: 0 done, 2 usage, 3 input refused, 4 no valid mesh, 5 output not written, ..."},
    {"input", "string", "the first file, or a formula"},
    {"inputs[]", "string", "all files, where there are several"},
    {"error.status", "integer", "of the exit"},
    {"error.kind", "string", "usage, input, meshing, requirement, output, memory, limit, interrupted or internal"},
    {"error.code", "string", "of some, which stays the same in all versions"},
    {"error.message", "string", "in words"},
    // What was read.
    {"kind", "string", "of the input: surface, mesh, CAD, image or size field"},
    {"format", "string", "of the input"},
    {"unit", "string", "of the input's coordinates; empty: the file does not say"},
    {"notes[]", "any", "of a run: code, stage, text and values; of info the words of the reader"},
    {"input_notes[].stage", "string", "which step has something to say"},
    {"input_notes[].text", "string", "in words"},
    {"input_regions[].name", "string", "of a region"},
    {"input_regions[].volume", "number", "unit of the input, cubed"},
    {"dropped_sheet_faces", "integer", "of sheets that lay outside"},
    {"repairs[]", "any", "what was changed in the surface"},
    {"clean", "boolean", "whether the surface can be meshed"},
    {"defects.open_loops", "integer", "borders of holes"},
    {"defects.*.count", "integer", "how many of a kind"},
    {"defects.*.first[].at", "place", "where"},
    {"defects.*.first[].faces[]", "integer", "which triangles"},
    {"defects_of", "string", "which of several files"},
    {"leak", "[place]", "a way from the seed of a void out of its cell"},
    {"triangles", "integer", "of the surface"},
    {"vertices", "integer", "as the file has them"},
    {"box", "box", "around the input"},
    {"area", "number", "of the surface"},
    {"places.regions[]", "string", "names, for options that take a place"},
    {"places.patches[]", "string", "names, or patch_3 of what has none; of CAD the faces"},
    {"places.curves[]", "string", "names; of CAD the edges"},
    {"places.sets[]", "string", "sets of a mesh; of CAD colours and layers"},
    {"patches[]", "string", "names in the file"},
    {"bodies", "integer", "that the surface bounds"},
    {"cavities", "integer", "in them"},
    {"thickness.least", "number", "from a place of a wall to the wall that faces it"},
    {"thickness.at", "place", "the place"},
    {"thickness.tenth", "number?", "a tenth of the area is over walls no thicker"},
    {"thickness.half", "number?", "half of it"},
    {"shortest_edge.length", "number", "of a line between corners, along which faces meet"},
    {"shortest_edge.at", "place", "its middle"},
    // CAD.
    {"to_millimetres", "number", "by which numbers of the file are multiplied"},
    {"lengths", "string", "the unit of lengths here"},
    {"solids[].name", "string", "of the solid"},
    {"solids[].volume", "number", "of the true geometry"},
    {"solids[].area", "number", "of the true geometry"},
    {"solids[].layer", "string", "of the solid"},
    {"solids[].color", "string", "of the solid, #ff8000"},
    {"solids[].product", "string", "that the solid is an occurrence of"},
    {"solids[].material", "string", "of the solid"},
    {"solids[].density", "number", "of the solid, kg/m3"},
    {"faces[]", "string", "what each face is called"},
    {"cad_patches[].name", "string", "of faces that are one patch"},
    {"cad_patches[].faces", "integer", "how many they are"},
    {"cad_patches[].area", "number", "of the true geometry"},
    {"cad_patches[].shape", "string", "plane, cylinder of radius 3, ..., free face"},
    {"cad_patches[].solids[]", "string", "that they bound"},
    {"contacts[].solids[]", "string", "the two that touch, nearly touch or overlap"},
    {"contacts[].patch", "string", "the faces that they share; missing where there are none"},
    {"contacts[].shape", "string", "plane, cylinder of radius 3, ..., free face"},
    {"contacts[].area", "number", "of the faces that they share; beside a gap of what lies face to face, about"},
    {"contacts[].gap", "number", "between planes, or cylinders of one axis, that nearly touch"},
    {"contacts[].overlap", "number", "volume that both fill"},
    {"contacts[].depth", "number", "how thick that is"},
    {"edges[]", "string", "names of the edges"},
    {"shortest_edges[].name", "string", "by the faces that meet in it"},
    {"shortest_edges[].size", "number", "its length; the shortest first, eight at most"},
    {"narrowest_faces[].name", "string", ""},
    {"narrowest_faces[].size", "number", "twice its area over the length of its edges"},
    {"named_faces", "integer", "that have a name in the file"},
    // Images.
    {"size[]", "integer", "voxels along i, j and k"},
    {"spacing[]", "number", "of voxels"},
    {"axes[]", "place", "steps of i, j and k"},
    {"origin", "place", "the middle of the first voxel"},
    {"slices[]", "number", "where slices lie that are not evenly spaced"},
    {"frame", "string", "where x, y and z point, such as LPS"},
    {"voxels", "string", "labels or grey"},
    {"labels[]", "any", "value, name and count of each"},
    {"least", "number", "grey value"},
    {"largest", "number", "grey value"},
    {"histogram[]", "integer", "voxels by grey value"},
    // Sizes.
    {"smallest_size", "number", "of the size field"},
    {"largest_size", "number", "of the size field"},
    {"expected_tets", "number", "that the sizes come to"},
    {"dry_run.expected_tets", "number", "that the sizes come to"},
    {"dry_run.smallest_size", "number", ""},
    {"dry_run.largest_size", "number", ""},
    {"dry_run.boundary_faces", "number", ""},
    {"dry_run.seconds", "number?", "of the processor; null: nothing like it was measured"},
    {"dry_run.memory_bytes", "number", ""},
    {"dry_run.file_bytes", "number", ""},
    // The mesh.
    {"points", "integer", "vertices and mid-side nodes"},
    {"tets", "integer", "elements"},
    {"boundary_faces", "integer", ""},
    {"order", "integer", "1 to 4"},
    {"volume", "number", "of the mesh, or of what was read"},
    {"input_volume", "number", "of the surface"},
    {"true_volume", "number", "of the CAD solids"},
    {"quality.beta_mean", "number", "3 r / R, mean"},
    {"quality.beta_min", "number", "3 r / R, least"},
    {"quality.beta_min_tet", "integer", "its element"},
    {"quality.beta_min_at", "place", "its middle"},
    {"quality.beta_classes[]", "integer", "elements by 3 r / R"},
    {"quality.beta_class_bounds[]", "number", ""},
    {"quality.dihedral_min_degrees", "number", "least dihedral angle"},
    {"quality.dihedral_min_tet", "integer", "its element"},
    {"quality.dihedral_min_at", "place", "its middle"},
    {"quality.dihedral_max_degrees", "number", "largest dihedral angle"},
    {"quality.dihedral_histogram[]", "integer", "by classes of dihedral_class_degrees"},
    {"quality.dihedral_class_degrees", "number", ""},
    {"regions[].number", "integer", "from 0"},
    {"regions[].name", "string", ""},
    {"regions[].tets", "integer", ""},
    {"regions[].volume", "number", "of the mesh"},
    {"regions[].input_volume", "number", "of the surface"},
    {"regions[].needed_tets", "number", "regular tetrahedra of the given size that have its volume"},
    {"regions[].true_volume", "number", "of the CAD solid"},
    {"regions[].layers_volume", "number", "of its boundary layers"},
    {"regions[].quality", "object", "as that of the mesh"},
    {"walls[].regions[]", "string", "on both sides, most triangles over the size first"},
    {"walls[].triangles", "integer", ""},
    {"walls[].area", "number", "unit of the input, squared"},
    {"walls[].needed_triangles", "number", "regular triangles of the given size that have its area"},
    {"opened_contacts[].patches[]", "string", "that lie on each other, with nodes of their own"},
    {"opened_contacts[].triangles[]", "integer", "of both"},
    {"opened_contacts[].areas[]", "number", "unit of the input, squared"},
    {"opened_contacts[].conforming", "boolean", "whether their triangles are the same"},
    {"layers[].patch", "string", "the wall"},
    {"layers[].region", "string", "that they grow in"},
    {"layers[].faces", "integer", ""},
    {"layers[].share_full", "number", "of faces with all layers, 0 to 1"},
    {"layers[].share_with_some", "number", ""},
    {"layers[].mean_layers", "number", ""},
    {"layers[].asked_layers", "number", ""},
    {"layers[].first_height", "object", "min, median, max"},
    {"layers[].share_of_thickness", "number", ""},
    {"layers[].least_scaled_jacobian", "number", ""},
    {"layers[].stopped.*", "number", "share of faces by what stopped their layers"},
    {"second_order.*", "any", "curved edges, least scaled Jacobian"},
    {"volume_edges.edges", "integer", "inside"},
    {"volume_edges.mean_ratio", "number", "of lengths to sizes"},
    {"volume_edges.share_within_0.7_1.4", "number", ""},
    {"surface_edges.edges", "integer", "on the surface"},
    {"surface_edges.mean_ratio", "number", "of lengths to sizes"},
    {"surface_edges.share_within_0.7_1.4", "number", ""},
    {"hash", "string", "of the mesh, the same where the mesh is"},
    {"groups[].origin", "string", "region, patch, curve, or what a set holds; not of CAD"},
    {"groups[].name", "string", ""},
    {"groups[].size", "integer", "members; not of CAD"},
    {"groups[].faces", "integer", "of CAD"},
    {"groups[].solids", "integer", "of CAD"},
    {"worst_element.number", "integer", ""},
    {"worst_element.at", "place", ""},
    {"worst_element.beta", "number", ""},
    {"worst_elements[].number", "integer", ""},
    {"worst_elements[].at", "place", ""},
    {"worst_elements[].beta", "number", ""},
    {"worst_elements[].dihedral_min_degrees", "number", ""},
    {"worst_elements[].dihedral_max_degrees", "number", ""},
    {"wedges", "object", "count and scaled Jacobians"},
    {"pyramids", "object", "count and scaled Jacobians"},
    {"valid", "boolean", "whether the mesh is"},
    {"defect", "string", "what is not valid"},
    {"solver[]", "object", "measure, limit, count and worst elements of what a solver warns of"},
    {"fit", "object", "of adaptation: how lengths fit the metric"},
    {"deviation.bound", "number", "of adaptation: how far walls stray"},
    {"deviation.lower", "number", ""},
    {"deviation.upper", "number", ""},
    {"deviation.at", "place", ""},
    {"history[].fraction", "number", "of a motion that was done after this step"},
    {"history[].change", "string", "moved, improved, adapted or remeshed"},
    {"history[].elements", "integer", ""},
    {"history[].beta_min", "number", "3 r / R, least"},
    {"history[].beta_mean", "number", "3 r / R, mean"},
    {"history[].volume", "number", ""},
    {"level_sets[].name", "string", "of the field, and of the region below its value"},
    {"level_sets[].moved", "integer", "points that went to the surface"},
    {"level_sets[].divided", "integer", "edges that got a point on it"},
    {"level_sets[].on", "integer", "points that were taken for points of it"},
    {"level_sets[].elements", "integer", "below the value, before they were adapted"},
    {"level_sets[].volume", "number", "of them"},
    {"level_sets[].triangles", "integer", "of the surface between regions"},
    {"level_sets[].area", "number", "of them"},
    {"level_sets[].pieces", "integer", "of the region that do not touch in faces"},
    {"level_sets[].dropped", "integer", "of them that were too small"},
    {"carry.nodes", "integer", "of the mesh that fields go to"},
    {"carry.elements", "integer", ""},
    {"carry.copied_nodes", "integer", "that both meshes have"},
    {"carry.copied_elements", "integer", ""},
    {"carry.volume_before", "number", "of the mesh with the fields"},
    {"carry.volume_after", "number", ""},
    {"carry.uncovered", "number", "new volume with no old element of its region"},
    {"carry.lost", "number", "old volume with no new element of its region"},
    {"carry.outside_nodes", "integer", "that lie outside of the old mesh"},
    {"carry.farthest", "number", "how far at most"},
    {"carry.farthest_at", "place", ""},
    {"carry.by_region", "boolean", "false: the regions do not match"},
    {"carry.notes[]", "string", "on what differs"},
    {"carried[].name", "string", "of a field that went along"},
    {"carried[].of", "string", "points or elements"},
    {"carried[].components", "integer", ""},
    {"carried[].before.integral[]", "number", "of each component; of points of the linear interpolant"},
    {"carried[].before.least[]", "number", ""},
    {"carried[].before.greatest[]", "number", ""},
    {"carried[].after.integral[]", "number", ""},
    {"carried[].after.least[]", "number", ""},
    {"carried[].after.greatest[]", "number", ""},
    {"carried[].integral_error", "number", "greatest change of the integral over a region, relative"},
    {"carried[].beyond", "number", "how far values left the range that they had"},
    {"material_bins[].set", "string", "of elements of about one value, by --material-bins"},
    {"material_bins[].mean", "number", "of the field, by volume"},
    {"material_bins[].least", "number", ""},
    {"material_bins[].most", "number", ""},
    {"material_bins[].elements", "integer", ""},
    {"material_bins[].volume", "number", ""},
    {"picture.file", "string", "that was written"},
    {"picture.width", "integer", "pixels"},
    {"picture.height", "integer", "pixels"},
    {"picture.notes[]", "string", "what is not in it; of a close-up which element it shows"},
    // The run.
    {"output", "object", "the first file that was written, its format and notes"},
    {"outputs[]", "object", "all, where there are several"},
    {"stages[].name", "string", ""},
    {"stages[].wall_seconds", "number", ""},
    {"stages[].cpu_seconds", "number", ""},
    {"stages[].counters.*", "number", ""},
    {"stages[].notes[]", "string", ""},
    {"wall_seconds", "number", ""},
    {"cpu_seconds", "number", ""},
    {"peak_memory_bytes", "integer", ""},
    {"ranks[]", "object", "memory and messages of each process"},
};

Json type_in_schema(std::string type) {
  if (type == "any") return Json::object();
  if (type.starts_with('[')) return {{"type", "array"}, {"items", type_in_schema(type.substr(1, type.size() - 2))}};
  if (type == "place") return {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 3}, {"maxItems", 3}};
  if (type == "box") return {{"type", "array"}, {"items", type_in_schema("place")}, {"minItems", 2}, {"maxItems", 2}};
  if (type.ends_with('?')) return {{"type", {type.substr(0, type.size() - 1), "null"}}};
  return {{"type", type}};
}

/// Enters a field into the schema of the object that has it.
void enter(Json& object, std::string_view path, const ReportField& field) {
  const std::size_t dot = path.find('.');
  // Names have points of their own.
  const bool is_last = dot == std::string_view::npos || path.substr(0, dot).ends_with("_0");
  std::string name(is_last ? path : path.substr(0, dot));
  const bool is_list = name.ends_with("[]");
  if (is_list) name.resize(name.size() - 2);
  object["type"] = "object";
  if (name != "*" && !object.contains("additionalProperties")) object["additionalProperties"] = false;
  Json& place = name == "*" ? object["additionalProperties"] : object["properties"][name];
  if (!place.is_object()) place = Json::object();
  if (is_list) place["type"] = "array";
  Json& inner = is_list ? place["items"] : place;
  if (!inner.is_object()) inner = Json::object();
  if (!is_last) return enter(inner, path.substr(dot + 1), field);
  inner.update(type_in_schema(field.type));
  if (*field.about != '\0') place["description"] = field.about;
}

/// An option by its name in the library, its value of its own type.
Json by_name(const OptionInfo& info, const OptionValue& standard) {
  Json row = Json::object();
  switch (info.kind) {
    case OptionInfo::Kind::kNumber:
      row["type"] = "number";
      break;
    case OptionInfo::Kind::kWhole:
      row["type"] = "integer";
      break;
    case OptionInfo::Kind::kFlag:
      row["type"] = "boolean";
      break;
    default:
      row["type"] = "string";
  }
  for (const std::string_view choice : info.choices)
    row["enum"].push_back(info.kind == OptionInfo::Kind::kWhole ? Json::parse(choice) : Json(choice));
  if (info.least) row[info.is_above ? "exclusiveMinimum" : "minimum"] = *info.least;
  if (info.most) row[info.is_below ? "exclusiveMaximum" : "maximum"] = *info.most;
  std::string about(info.help);
  if (!info.unset.empty()) about += fmt::format(". Without a value: {}", info.unset);
  row["description"] = about;
  if (info.is_length) row["$comment"] = "a length, in the unit of the input";
  std::visit(
      [&](const auto& value) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, std::monostate>)
          if (!info.is_length) row["default"] = value;
      },
      standard);
  return row;
}

template <class All>
Json options_by_name(const std::vector<OptionInfo>& table) {
  Json object{{"type", "object"}, {"additionalProperties", false}};
  for (const OptionInfo& info : table)
    object["properties"][std::string(info.name)] = by_name(info, option_value(All{}, info.name));
  return object;
}

/// An option as a command takes it: the text that was typed. Its title is its group.
Json as_typed(const CLI::Option& option, const std::string& group) {
  const bool is_flag = option.get_items_expected_max() == 0;
  const std::string type = option.get_type_name();
  Json row{{"type", "string"}, {"title", group}, {"description", option.get_description()}};
  // Choices are heard in either case.
  if (is_flag)
    row["const"] = "true";
  else if (type.find('|') != std::string::npos && type == CLI::detail::to_lower(type))
    row["anyOf"] = {{{"enum", CLI::detail::split(type, '|')}}, {{"pattern", "[A-Z]"}}};
  else
    row["$comment"] = type;
  return row;
}

Json options_of_command(const CLI::App& command) {
  Json object{{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  const auto add = [&](const CLI::App& group) {
    for (const CLI::Option* option : group.get_options())
      if (!option->get_lnames().empty() && option != group.get_help_ptr())
        object["properties"][option->get_lnames().front()] = as_typed(*option, group.get_group());
  };
  add(command);
  for (const CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; })) add(*group);
  return object;
}

}  // namespace

Json schema_of(const CLI::App& app) {
  Json all{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
           {"title", "What octafront --json writes"},
           {"$comment", "octafront " OCTAFRONT_VERSION}};
  for (const ReportField& field : kReport) enter(all, field.path, field);
  all["required"] = {"program", "version", "command", "command_line", "status"};
  all["properties"]["options"] = {{"type", "object"}, {"description", "those that were given, as typed"}};
  // Of several files, each may have been mended.
  all["patternProperties"]["^repair( |$)"] = {{"type", "object"}, {"description", "what was changed in the surface"}};
  all["$defs"]["options"] = options_by_name<Options>(option_table());
  all["$defs"]["intake"] = options_by_name<IntakeOptions>(intake_table());
  all["$defs"]["writing"] = options_by_name<WriteOptions>(write_table());
  for (const CLI::App* command : commands_of(app)) {
    const std::string name = "options_of_" + command->get_name();
    all["$defs"][name] = options_of_command(*command);
    all["allOf"].push_back({{"if", {{"properties", {{"command", {{"const", command->get_name()}}}}}}},
                            {"then", {{"properties", {{"options", {{"$ref", "#/$defs/" + name}}}}}}}});
  }
  return all;
}

}  // namespace octafront::cli
