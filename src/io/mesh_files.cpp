#include <octafront/error.h>
#include <octafront/io.h>

#include "io/formats.h"
#include "io/readers.h"
#include "io/recognize.h"

#include <fmt/core.h>

namespace octafront {

namespace io {

TetMesh read_mesh_bytes(const Input& input) {
  switch (recognize_mesh(input)) {
    case MeshKind::kVtu:
      return read_vtu(input);
    case MeshKind::kMsh:
      return read_msh(input);
    default:
      return read_medit(input);
  }
}

}  // namespace io

namespace {

const io::Format& mesh_format(const std::filesystem::path& file) {
  const io::Format* format = io::format_of(file);
  if (format == nullptr || format->write_mesh == nullptr)
    throw OptionError(fmt::format("{}: the ending \"{}\" names no mesh format; use one of {}", file.string(),
                                  file.extension().string(), io::endings_that(&FormatInfo::writes_mesh)));
  return *format;
}

}  // namespace

TetMesh read_mesh(const std::string& file, const RunContext& context) {
  return io::read_mesh_bytes(io::LoadedFile(file, context).input());
}

void check_mesh_target(const std::string& file) {
  mesh_format(file);
  io::check_writable(file);
}

void write_mesh(const std::string& file, const TetMesh& mesh, const RunContext& context) {
  const io::Format& format = mesh_format(file);
  io::AtomicFile out(file, context);
  format.write_mesh(out, mesh);
  out.commit();
}

}  // namespace octafront
