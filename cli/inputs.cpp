#include "inputs.h"

#include <octafront/limits.h>

#include "text.h"

#include <fmt/core.h>

namespace octafront::cli {
namespace {

/// What a reader has to say, in words and for programs.
void tell_reading(Session& session, const std::vector<std::string>& notes) {
  session.say_notes("reading", notes);
  Json all = Json::array();
  for (const std::string& note : notes) all.push_back({{"stage", "reading"}, {"text", note}});
  if (!all.empty()) session.found({{"input_notes", all}});
}

}  // namespace

SurfaceFile read_input(Session& session) {
  const Arguments& a = session.arguments();
  SurfaceFile file = read_surface(a.input.string(), session.context());
  session.say(
      fmt::format("{}: {}, {}\n", a.input.string(), file.format, counted(file.surface.triangles.size(), "triangle")));
  tell_reading(session, file.notes);
  return file;
}

bool is_tet_mesh_file(const std::filesystem::path& file) {
  const std::string ending = CLI::detail::to_lower(file.extension().string());
  for (const FormatInfo& info : known_formats())
    for (const std::string& known : CLI::detail::split(std::string(info.endings), ' '))
      if (info.reads_mesh && !ending.empty() && ending == known) return true;
  return false;
}

TetMesh read_mesh_input(Session& session) {
  return read_mesh_file_input(session).mesh;
}

MeshFile read_mesh_file_input(Session& session) {
  return read_mesh_file_of(session, session.arguments().input);
}

MeshFile read_mesh_file_of(Session& session, const std::filesystem::path& path) {
  MeshFile file = read_mesh_file(path.string(), session.context());
  require_elements(static_cast<double>(file.mesh.tets.size()), path.string());
  session.say(fmt::format("{}: {}, {} tetrahedra{}\n", path.string(), file.format, file.mesh.tets.size(),
                          file.mesh.order() > 1 ? fmt::format(" of order {}", file.mesh.order()) : ""));
  tell_reading(session, file.notes);
  return file;
}

}  // namespace octafront::cli
