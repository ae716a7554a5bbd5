#include "inputs.h"

#include "text.h"

#include <utility>

#include <fmt/core.h>

namespace octafront::cli {

SurfaceFile read_input(const Session& session) {
  const Arguments& a = session.arguments();
  SurfaceFile file = read_surface(a.input.string(), session.context());
  session.say(
      fmt::format("{}: {}, {}\n", a.input.string(), file.format, counted(file.surface.triangles.size(), "triangle")));
  session.say_notes("reading", file.notes);
  return file;
}

bool is_tet_mesh_file(const std::filesystem::path& file) {
  const std::string ending = CLI::detail::to_lower(file.extension().string());
  for (const FormatInfo& info : known_formats())
    for (const std::string& known : CLI::detail::split(std::string(info.endings), ' '))
      if (info.reads_mesh && !ending.empty() && ending == known) return true;
  return false;
}

TetMesh read_mesh_input(const Session& session) {
  return read_mesh_file_input(session).mesh;
}

MeshFile read_mesh_file_input(const Session& session) {
  const Arguments& a = session.arguments();
  MeshFile file = read_mesh_file(a.input.string(), session.context());
  session.say(fmt::format("{}: {}, {} tetrahedra{}\n", a.input.string(), file.format, file.mesh.tets.size(),
                          file.mesh.is_second_order() ? " of second order" : ""));
  session.say_notes("reading", file.notes);
  return file;
}

}  // namespace octafront::cli
