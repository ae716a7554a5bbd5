#include <octafront/error.h>
#include <octafront/io.h>

#include "base/core/utf8.h"
#include "formats/read/readers.h"
#include "formats/table/formats.h"
#include "formats/table/recognize.h"

#include <fmt/core.h>

namespace octafront {

namespace io {

namespace {

SurfaceFile as_in_file(const Input& input) {
  switch (recognize_surface(input)) {
    case SurfaceKind::kBinaryStl:
      return read_binary_stl(input);
    case SurfaceKind::kAsciiStl:
      return read_ascii_stl(input);
    case SurfaceKind::kObj:
      return read_obj(input);
    case SurfaceKind::kOff:
      return read_off(input);
    case SurfaceKind::kPoly:
      return read_poly(input);
    case SurfaceKind::kMsh:
      return surface_of(read_msh(input), input);
    case SurfaceKind::kMedit:
      return surface_of(read_medit(input), input);
    case SurfaceKind::kMeditBinary:
      return surface_of(read_medit_binary(input), input);
    case SurfaceKind::kOtherMesh:
      return surface_of(read_raw_mesh(input), input);
    default:
      return read_ply(input);
  }
}

}  // namespace

SurfaceFile read_surface_bytes(const Input& input) {
  SurfaceFile file = as_in_file(input);
  NameCleaning names;
  names.clean(file.surface.patch_names);
  names.clean(file.surface.region_names);
  for (RegionSeed& seed : file.regions) names.clean(seed.name);
  names.tell(file.notes);
  return file;
}

}  // namespace io

namespace {

const io::Format& surface_format(const std::filesystem::path& file) {
  const io::Format* format = io::format_of(file);
  if (format == nullptr || format->write_surface == nullptr)
    throw OptionError(fmt::format("{}: the ending \"{}\" names no surface format; use one of {}", file.string(),
                                  file.extension().string(), io::endings_that(&FormatInfo::writes_surface)));
  return *format;
}

}  // namespace

SurfaceFile read_surface(const std::string& file, const RunContext& context) {
  return io::read_surface_bytes(io::LoadedFile(file, context).input());
}

bool holds_tetrahedra(const std::string& file, const RunContext& context) {
  const io::LoadedFile loaded(file, context);
  const io::Input& input = loaded.input();
  switch (io::recognize_mesh(input)) {
    case io::MeshKind::kMsh:
      return !io::read_msh(input).tets.empty();
    case io::MeshKind::kMedit:
      return !io::read_medit(input).tets.empty();
    case io::MeshKind::kMeditBinary:
      return !io::read_medit_binary(input).tets.empty();
    case io::MeshKind::kVtu:
      return !io::read_vtu(input).tets.empty();
    case io::MeshKind::kVtk:
      return !io::read_vtk(input).tets.empty();
    default:
      // Of the other formats only meshes are read.
      return true;
  }
}

void check_surface_target(const std::string& file) {
  surface_format(file);
  io::check_writable(file);
}

void write_surface(const std::string& file, const SurfaceMesh& surface, const RunContext& context) {
  const io::Format& format = surface_format(file);
  io::AtomicFile out(file, context);
  format.write_surface(out, surface);
  out.commit();
}

}  // namespace octafront
