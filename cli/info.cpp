#include <octafront/octafront.h>

#include "commands.h"
#include "image_info.h"
#include "inputs.h"
#include "mesh_in_words.h"
#include "text.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

Json json_of_box(const Box3& box) {
  return {place(box.lo), place(box.hi)};
}

std::string box_in_words(const Box3& box) {
  const Vec3 size = box.hi - box.lo;
  return fmt::format(
      "box ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}): {:.6g} x {:.6g} x {:.6g}, diagonal {:.6g}", box.lo.x,
      box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z, size.x, size.y, size.z, length(size));
}

std::string listed(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "\"" : ", \"") + name + "\"";
  return all;
}

/// What there is that options may name, for programs and in words.
void tell_places(Session& session, const PlaceNames& names, bool in_words = true) {
  constexpr std::size_t kListedPlaces = 24;
  Json all = Json::object();
  for (const auto& [kind, list] : {std::pair{"regions", &names.regions}, std::pair{"patches", &names.patches},
                                   std::pair{"curves", &names.curves}, std::pair{"sets", &names.sets}}) {
    all[kind] = *list;
    if (list->empty() || !in_words) continue;
    const bool is_long = list->size() > kListedPlaces;
    const std::vector<std::string> first(list->begin(), list->begin() + (is_long ? kListedPlaces : list->size()));
    session.say(fmt::format(
        "  {}: {}{}\n", kind, listed(first),
        is_long ? fmt::format(" ... and {} more: --json has all of them", list->size() - kListedPlaces) : ""));
  }
  session.found({{"places", all}});
}

// What a surface is, whatever is wrong with it: `check` judges.
void tell_surface_info(Session& session) {
  const Arguments& a = session.arguments();
  const SurfaceFile file = read_input(session);
  const SurfaceMesh& s = file.surface;
  const Box3 box = bounding_box(s.points);
  const std::string unit = a.unit.empty() ? unit_of_file(a.input.string()) : a.unit;
  session.found({{"kind", "surface"},
                 {"format", file.format},
                 {"triangles", s.triangles.size()},
                 {"vertices", s.points.size()},
                 {"box", json_of_box(box)},
                 {"area", area(s)},
                 {"patches", s.patch_names},
                 {"unit", unit},
                 {"notes", file.notes}});
  session.say(fmt::format("  vertices {}, as the file has them\n  {}\n  area {:.6g}\n  unit: {}\n", s.points.size(),
                          box_in_words(box), area(s), unit.empty() ? "the file does not say" : unit));
  // Triangles of STL share no vertices.
  tell_places(session, place_names(repair_surface(s, session.context()).surface));
  session.say("octafront check says whether it can be meshed, octafront mesh --dry-run what that would take\n");
}

/// Says the first of these lines.
void say_first(Session& session, const std::vector<std::string>& lines) {
  constexpr std::size_t kListedLines = 40;
  for (std::size_t k = 0; k < std::min(kListedLines, lines.size()); ++k) session.say("  " + lines[k] + "\n");
  if (lines.size() > kListedLines)
    session.say(fmt::format("  ... and {} more: --json has all of them\n", lines.size() - kListedLines));
}

/// A line for each product: of several occurrences their names.
std::vector<std::string> parts_in_words(const CadInfo& info) {
  constexpr double kSameVolume = 1e-6;  // of occurrences, which are integrated one by one
  std::vector<std::string> lines;
  std::vector<char> is_told(info.solids.size(), 0);
  for (std::size_t s = 0; s < info.solids.size(); ++s) {
    if (is_told[s]) continue;
    const CadInfo::Solid& solid = info.solids[s];
    std::vector<std::string> occurrences;
    for (std::size_t k = s; k < info.solids.size(); ++k) {
      const CadInfo::Solid& other = info.solids[k];
      if (k != s && (solid.product.empty() || other.product != solid.product ||
                     std::abs(other.volume - solid.volume) > kSameVolume * solid.volume))
        continue;
      is_told[k] = 1, occurrences.push_back(other.name);
    }
    std::string line = occurrences.size() == 1 ? fmt::format("solid \"{}\"", solid.name)
                                               : fmt::format("part \"{}\", {} times, {}: each", solid.product,
                                                             occurrences.size(), listed(occurrences));
    line += fmt::format("{} volume {:.6g}, area {:.6g}", occurrences.size() == 1 ? ":" : "", solid.volume, solid.area);
    if (!solid.material.empty()) line += fmt::format(", of {}", solid.material);
    if (solid.density > 0) line += fmt::format(", {:.6g} kg/m3", solid.density);
    if (!solid.color.empty()) line += fmt::format(", color {}", solid.color);
    lines.push_back(std::move(line));
  }
  return lines;
}

/// Those that the file names; contacts have lines of their own.
std::vector<std::string> patches_in_words(const CadInfo& info) {
  std::vector<std::string> lines;
  for (const CadInfo::Patch& patch : info.patches) {
    if (patch.name.starts_with("face ") || patch.solids.size() > 1) continue;
    lines.push_back(fmt::format("patch \"{}\": {}, area {:.6g}{}", patch.name, patch.shape, patch.area,
                                patch.faces > 1 ? fmt::format(", {} faces", patch.faces) : ""));
  }
  return lines;
}

std::vector<std::string> contacts_in_words(const CadInfo& info) {
  std::vector<std::string> lines;
  for (const CadInfo::Contact& contact : info.contacts) {
    std::string line = fmt::format("contact of \"{}\" and \"{}\": ", contact.solids[0], contact.solids[1]);
    if (!contact.shape.empty()) line += fmt::format("{}, area {:.6g}", contact.shape, contact.area);
    if (contact.gap > 0) line += fmt::format(", a gap of {:.4g}", contact.gap);
    if (contact.overlap > 0)
      line += fmt::format("{}overlap of {:.4g}, {:.3g} deep", contact.shape.empty() ? "" : ", ", contact.overlap,
                          contact.depth);
    if (!contact.patch.empty()) line += fmt::format(", patch \"{}\"", contact.patch);
    lines.push_back(std::move(line));
  }
  return lines;
}

/// What small elements must fit into; the files say more.
std::string smallest_in_words(const CadInfo& info) {
  const auto first_of = [](const char* what, const std::vector<CadInfo::Small>& all) {
    return all.empty() ? "" : fmt::format("  {} {:.4g}, \"{}\"\n", what, all.front().size, all.front().name);
  };
  return first_of("shortest edge", info.shortest_edges) + first_of("narrowest face", info.narrowest_faces);
}

void tell_cad_info(Session& session) {
  const Arguments& a = session.arguments();
  const CadInfo info = read_cad_info(a.input.string(), a.intake, session.context());
  session.found(Json::parse(to_json(info)));
  session.say(fmt::format("{}: {}, {}, {}{}\n", a.input.string(), info.format, counted(info.solids.size(), "solid"),
                          counted(info.faces.size(), "face"),
                          info.named_faces > 0 ? fmt::format(", {} with names", info.named_faces) : ""));
  session.say_notes("CAD", info.notes);
  session.say(fmt::format("  {}\n  unit: {}; all lengths here are in {}\n", box_in_words(info.box),
                          info.unit.empty() ? "the file does not say, taken as millimetre" : info.unit, info.lengths));
  say_first(session, parts_in_words(info));
  say_first(session, patches_in_words(info));
  say_first(session, contacts_in_words(info));
  session.say(smallest_in_words(info));
  for (const CadInfo::Group& group : info.groups)
    session.say(fmt::format("  {}: {}\n", group.name,
                            group.faces > 0 ? counted(group.faces, "face") : counted(group.solids, "solid")));
  PlaceNames names;
  for (const CadInfo::Solid& solid : info.solids) names.regions.push_back(solid.name);
  for (const CadInfo::Group& group : info.groups) names.sets.push_back(group.name);
  for (const CadInfo::Patch& patch : info.patches) names.patches.push_back(patch.name);
  names.curves = info.edges;
  tell_places(session, names);
  session.say("octafront mesh --dry-run says what meshing would take\n");
}

void tell_mesh_info(Session& session, const TetMesh& mesh) {
  const Box3 box = bounding_box(mesh.points);
  double volume = 0;
  for (const auto& [i, j, k, l] : mesh.tets) {
    const Vec3 p = mesh.points[i];
    volume += dot(cross(mesh.points[j] - p, mesh.points[k] - p), mesh.points[l] - p) / 6;
  }
  session.found({{"kind", "mesh"}, {"order", mesh.order()}, {"box", json_of_box(box)}, {"volume", volume}});
  session.say(fmt::format("  {}\n  volume {:.6g}, order {}\n", box_in_words(box), volume, mesh.order()));
  tell_mesh(session, mesh, "a mesh");
  tell_places(session, place_names(mesh), false);  // its groups are told, with how large they are
}

/// Whether the input is a background grid.
bool tell_size_field_info(Session& session) {
  const std::string name = session.arguments().input.string();
  try {
    const SizeField field = read_size_field(name, 1, session.context());
    session.found({{"kind", "size field"}, {"smallest_size", field.min_size()}, {"largest_size", field.max_size()}});
    session.say(fmt::format("{}: a size field, for --size-field: sizes {:.6g} to {:.6g}\n", name, field.min_size(),
                            field.max_size()));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

void run_info(Session& session) {
  const std::filesystem::path& file = session.arguments().input;
  if (is_image(file.string())) return tell_image_info(session);
  if (is_cad(file.string())) return tell_cad_info(session);
  if (session.arguments().intake.image.choice.series > 0)
    throw OptionError(fmt::format("--series is for images, and {} is none that is known here", file.string()));
  if (session.arguments().bodies.size() > 1) throw OptionError("info tells of one file at a time");
  if (!is_tet_mesh_file(file)) return tell_surface_info(session);
  // A background grid is a VTU file too, whose hexahedra could be read as a mesh.
  const bool is_grid = file.extension() == ".vtu" && tell_size_field_info(session);
  if (!is_grid) tell_mesh_info(session, read_mesh_input(session));
}

}  // namespace octafront::cli
