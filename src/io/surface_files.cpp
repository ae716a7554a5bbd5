#include <octafront/error.h>
#include <octafront/io.h>

#include "io/formats.h"
#include "io/readers.h"
#include "io/recognize.h"

#include <fmt/core.h>

namespace octafront {

namespace io {

SurfaceFile read_surface_bytes(const Input& input) {
  switch (recognize_surface(input)) {
    case SurfaceKind::kBinaryStl:
      return read_binary_stl(input);
    case SurfaceKind::kAsciiStl:
      return read_ascii_stl(input);
    case SurfaceKind::kObj:
      return read_obj(input);
    case SurfaceKind::kOff:
      return read_off(input);
    default:
      return read_ply(input);
  }
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
