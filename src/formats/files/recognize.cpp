#include "base/core/utf8.h"
#include "formats/containers/scanner.h"
#include "formats/files/formats.h"

#include <fmt/core.h>

namespace octafront::io {
namespace {

std::string wanted(bool surfaces) {
  std::string titles;
  for (const Format& format : formats())
    if (surfaces ? format.read_surface != nullptr : format.read_mesh != nullptr)
      titles += (titles.empty() ? "" : ", ") + std::string(format.info.title);
  return surfaces ? fmt::format("a surface as {}, or a mesh of one of the formats that are read", titles)
                  : "a mesh as " + titles;
}

const Format& recognize(const Input& input, bool surfaces) {
  const FileHead head(input);
  const Format* format = nullptr;
  Told most = Told::kNot;
  for (const Format& f : formats()) {
    const bool is_of_meshes = f.read_mesh != nullptr;
    if (f.told == nullptr || (!surfaces && !is_of_meshes)) continue;
    const Told told = f.told(head);
    // Of bytes that are no text surfaces are told, and meshes that are sure.
    if (told <= most || (surfaces && is_of_meshes && head.is_binary && told < Told::kMagic)) continue;
    most = told;
    format = &f;
  }
  if (!head.kind.empty() && (surfaces ? most < Told::kMagic : most == Told::kNot))
    input.fail(fmt::format("{}{}; expected {}", head.kind.starts_with("compressed") ? "is " : "looks like ", head.kind,
                           wanted(surfaces)));
  if (format != nullptr) return *format;
  if (head.first.empty()) input.fail("holds nothing but blanks and comments; export it again");
  input.fail(fmt::format("is not a file of a kind that is known here ({}); it begins with {}", wanted(surfaces),
                         in_quotes(input.bytes.substr(0, 24))));
}

}  // namespace

const Format& recognize_surface(const Input& input) {
  return recognize(input, true);
}

const Format& recognize_mesh(const Input& input) {
  return recognize(input, false);
}

SurfaceFile read_surface_bytes(const Input& input) {
  const Format& format = recognize_surface(input);
  SurfaceFile file =
      format.read_surface != nullptr ? format.read_surface(input) : surface_of(format.read_mesh(input), input);
  NameCleaning names;
  names.clean(file.surface.patch_names);
  names.clean(file.surface.region_names);
  for (RegionSeed& seed : file.regions) names.clean(seed.name);
  names.tell(file.notes);
  return file;
}

RawMesh read_raw_mesh(const Input& input) {
  return recognize_mesh(input).read_mesh(input);
}

MeshFile read_mesh_bytes(const Input& input) {
  MeshFile file = ordered_mesh(read_raw_mesh(input), input);
  NameCleaning names;
  for (auto* list : {&file.mesh.region_names, &file.mesh.patch_names, &file.mesh.curve_names}) names.clean(*list);
  for (NamedSet& set : file.mesh.sets) names.clean(set.name);
  names.tell(file.notes);
  return file;
}

}  // namespace octafront::io
