#include <octafront/octafront.h>
#include <octafront/picture.h>

#include "commands.h"
#include "domain.h"
#include "inputs.h"
#include "targets.h"
#include "text.h"

#include <algorithm>
#include <vector>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

void check_picture_target(const std::filesystem::path& file) {
  if (file == kStandardOutput || CLI::detail::to_lower(file.extension().string()) == ".png") return;
  throw OptionError(fmt::format("{}: a picture is written as PNG: give it the ending .png", file.string()));
}

PictureOptions titled(const Session& session, PictureOptions options) {
  const Arguments& a = session.arguments();
  const auto name_of = [](const std::filesystem::path& file) {
    return is_formula(file.string()) && !std::filesystem::exists(file) ? file.string() : file.filename().string();
  };
  options.title = name_of(a.input);
  if (a.bodies.size() > 1) options.title += fmt::format(" and {}", counted(a.bodies.size() - 1, "other"));
  options.unit = session.unit.empty() ? a.unit : session.unit;
  return options;
}

bool is_mesh(const Arguments& a) {
  return a.bodies.size() == 1 && is_tet_mesh_file(a.input) && holds_tetrahedra(a.input.string());
}

/// As it is, whatever is wrong with it.
Picture picture_of_surface(Session& session) {
  const Arguments& a = session.arguments();
  IntakeOptions as_it_is = a.intake;
  as_it_is.repair = IntakeOptions::Repair::kOff;
  as_it_is.cad.keep_edges = true;
  const Domain domain = open_input(session, as_it_is);
  PictureOptions options = titled(session, a.picture);
  // Their triangles are ours, not the file's.
  if (options.edges == PictureOptions::Edges::kAuto && (is_cad(a.input.string()) || is_image(a.input.string())))
    options.edges = PictureOptions::Edges::kFeatures;
  return draw_picture(domain.surface, options, session.context());
}

}  // namespace

void run_picture(Session& session) {
  const Arguments& a = session.arguments();
  check_picture_target(a.output);
  const Picture picture = is_mesh(a)
                              ? draw_picture(read_mesh_input(session), titled(session, a.picture), session.context())
                              : picture_of_surface(session);
  write_text_target(a.output, to_png(picture));
  session.say_notes("picture", picture.notes);
  session.found({{"picture",
                  {{"file", a.output.string()},
                   {"width", picture.width},
                   {"height", picture.height},
                   {"notes", picture.notes}}}});
  session.say(fmt::format("written: {}\n", a.output.string()));
}

}  // namespace octafront::cli
