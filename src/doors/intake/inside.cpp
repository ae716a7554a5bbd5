#include <octafront/error.h>
#include <octafront/inside.h>
#include <octafront/io.h>

#include "base/core/utf8.h"
#include "base/core/wording.h"
#include "doors/intake/intake.h"
#include "soup/cells/bodies.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace octafront::intake {
namespace {

struct NamedFile {
  std::string name, file;
};

/// FILE, or NAME=FILE.
NamedFile named_file(const std::string& typed) {
  const std::size_t equals = typed.find('=');
  if (equals == 0 || equals == std::string::npos || std::filesystem::exists(typed))
    return {std::filesystem::path(typed).stem().string(), typed};
  return {typed.substr(0, equals), typed.substr(equals + 1)};
}

class Inside {
 public:
  Inside(Domain& domain, const IntakeOptions& options, const RunContext& context)
      : domain_(domain), options_(options), context_(context), sheets_(options.inside.sheets) {
    domain.wires.insert(domain.wires.end(), options.inside.wires.begin(), options.inside.wires.end());
    domain.points.insert(domain.points.end(), options.inside.points.begin(), options.inside.points.end());
  }

  void read() {
    for (const std::string& typed : options_.inside.sheet_files) {
      const auto [name, file] = named_file(typed);
      SurfaceFile read = read_surface(file, context_);
      say("",
          fmt::format("{}: {}, {}, a sheet", file, read.format, counted(read.surface.triangles.size(), "triangle")));
      note_all(domain_, options_, "reading", read.notes);
      sheets_.push_back({name, std::move(read.surface)});
    }
    for (const std::string& typed : options_.inside.wire_files) {
      const auto [name, file] = named_file(typed);
      LinesFile read = lines_of(file);
      say("", fmt::format("{}: {}, {} of lines", file, read.format, counted(read.edges.size(), "edge")));
      domain_.wires.push_back({name, std::move(read.points), std::move(read.edges)});
    }
    for (const std::string& typed : options_.inside.point_files) {
      const auto [name, file] = named_file(typed);
      LinesFile read = lines_of(file);
      say("", fmt::format("{}: {}, {}", file, read.format, counted(read.points.size(), "point")));
      domain_.points.push_back({name, std::move(read.points)});
    }
  }

  void embed() {
    clean_names();
    if (sheets_.empty() && domain_.wires.empty() && domain_.points.empty()) return;
    if (domain_.geometry) {
      say("regions",
          "with sheets, lines or points inside, nodes stay on the triangles of the CAD faces: they do not move "
          "to the true geometry");
      domain_.geometry = nullptr;
      domain_.true_volumes.clear(), domain_.chord_depths.clear();
    }
    if (sheets_.empty()) return;
    context_.report("sheets", -1);
    domain_.bound.clear();
    domain_.found_clean = 0;
    take_complex(domain_, options_,
                 cells::embed_sheets(domain_.surface, sheets_, options_.complex, elements_to_come(options_), context_));
  }

 private:
  void say(const char* stage, std::string text) { note(domain_, options_, stage, std::move(text)); }

  LinesFile lines_of(const std::string& file) {
    LinesFile read = read_lines(file, context_);
    note_all(domain_, options_, "reading", read.notes);
    return read;
  }

  /// One name each, for they tell parts of the mesh apart.
  void clean_names() {
    std::set<std::string> taken;
    const auto clean = [&](std::string& name, const char* what) {
      NameCleaning().clean(name);
      if (name.empty()) throw OptionError(fmt::format("{} has no name", what));
      if (!taken.insert(name).second)
        throw OptionError(
            fmt::format("two things inside are called \"{}\"; give each a name of its own: NAME=FILE", name));
    };
    for (Sheet& s : sheets_) clean(s.name, "a sheet");
    for (LineNet& w : domain_.wires) clean(w.name, "a line");
    for (PointSet& p : domain_.points) clean(p.name, "a set of points");
  }

  Domain& domain_;
  const IntakeOptions& options_;
  const RunContext& context_;
  std::vector<Sheet> sheets_;
};

}  // namespace

Domain with_inside(Domain domain, const IntakeOptions& options, const RunContext& context) {
  domain = in_tunnel(std::move(domain), options, context);
  Inside inside(domain, options, context);
  inside.read();
  inside.embed();
  if (ContactChoice asked = contacts_asked(options).of_parts; !asked.is_shared()) domain.contacts = std::move(asked);
  return domain;
}

}  // namespace octafront::intake
