#include <octafront/error.h>
#include <octafront/io.h>

#include "formats/files/formats.h"

#include <fmt/core.h>

namespace octafront {

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
  const io::Format& format = io::recognize_mesh(input);
  // Of the other formats only meshes are read.
  return !format.info.holds.surfaces_alone || !format.read_mesh(input).tets.empty();
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
