#include "domain.h"

#include <octafront/complex.h>
#include <octafront/error.h>

#include "images.h"
#include "mending.h"
#include "text.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

SurfaceFile read_one(const Session& session, const std::filesystem::path& file) {
  SurfaceFile read = read_surface(file, session.context());
  session.say(
      fmt::format("{}: {}, {}\n", file.string(), read.format, counted(read.surface.triangles.size(), "triangle")));
  session.say_notes("reading", read.notes);
  return read;
}

/// The stems of the files, with numbers behind those that occurred before.
std::vector<std::string> names_of(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : files) {
    const std::string stem = file.stem().string();
    std::string name = stem;
    for (int n = 2; std::find(names.begin(), names.end(), name) != names.end(); ++n)
      name = fmt::format("{}_{}", stem, n);
    names.push_back(std::move(name));
  }
  return names;
}

SurfaceFile joined(Session& session, const std::vector<Body>& bodies, const ComplexOptions& options,
                   const std::string& format) {
  session.context().report("joining", -1);
  Complex complex = join_bodies(bodies, options, session.context());
  tell_regions(session, complex);
  return {std::move(complex.surface), format, {}};
}

/// Says which of several files is at fault.
void mend_body(Session& session, const std::filesystem::path& file, SurfaceMesh& surface) {
  try {
    mend(session, file, surface);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

/// Parts with names that became one body: there is an option that keeps them apart.
void tell_united_parts(const Session& session, const SurfaceMesh& read, const SurfaceMesh& mended) {
  if (read.patch_names.size() < 2 || mended.triangles == read.triangles) return;
  const std::vector<Body> parts = bodies_by_name(read);
  const auto is_closed = [](const Body& body) {
    return body.surface.patch.empty() && enclosed_volume(body.surface) > 0;
  };
  if (std::count_if(parts.begin(), parts.end(), is_closed) < 2) return;
  session.say_notes("repair", {fmt::format("the parts \"{}\", \"{}\"{} overlap and are united; --overlap regions "
                                           "makes regions of them, by their names",
                                           parts[0].name, parts[1].name, parts.size() > 2 ? " ..." : "")});
}

SurfaceFile read_bodies(Session& session, Defects defects) {
  const Arguments& a = session.arguments();
  const std::vector<std::string> names = names_of(a.bodies);
  std::vector<Body> bodies;
  ComplexOptions options = a.complex;
  for (std::size_t i = 0; i < names.size(); ++i) {
    SurfaceFile file = read_one(session, a.bodies[i]);
    if (!file.surface.sides.empty())
      throw InputError(
          fmt::format("{}: is a complex of several regions by itself; give it alone", a.bodies[i].string()));
    options.regions.insert(options.regions.end(), file.regions.begin(), file.regions.end());
    options.voids.insert(options.voids.end(), file.voids.begin(), file.voids.end());
    if (defects == Defects::kMended) mend_body(session, a.bodies[i], file.surface);
    bodies.push_back({names[i], std::move(file.surface)});
  }
  return joined(session, bodies, options, "several files");
}

/// Parts of one file that have names of their own.
SurfaceFile read_parts(Session& session, Defects defects) {
  const Arguments& a = session.arguments();
  const SurfaceFile file = read_one(session, a.input);
  if (!file.surface.sides.empty())
    throw InputError(fmt::format("{}: has regions already; leave out --overlap", a.input.string()));
  std::vector<Body> bodies = bodies_by_name(file.surface);
  if (bodies.size() < 2)
    throw InputError(
        fmt::format("{}: --overlap regions needs parts with names of their own (solids, groups); all of it is \"{}\"",
                    a.input.string(), bodies.empty() ? "" : bodies[0].name));
  if (defects == Defects::kMended)
    for (Body& body : bodies) mend(session, fmt::format("{} ({})", a.input.string(), body.name), body.surface);
  ComplexOptions options = a.complex;
  options.regions.insert(options.regions.end(), file.regions.begin(), file.regions.end());
  options.voids.insert(options.voids.end(), file.voids.begin(), file.voids.end());
  return joined(session, bodies, options, file.format);
}

/// A single body with sheets in it, and nobody asked for regions: repair has more to say of what hangs in a body, for a
/// shell with a hole may be a cavity.
bool is_for_repair(const Arguments& a, const ComplexOptions& options, const Complex& complex) {
  const auto& sides = complex.surface.sides;
  return a.repair == Repair::kAuto && a.sheets == Sheets::kDrop && complex.volumes.size() == 1 &&
         options.regions.empty() && options.voids.empty() &&
         std::any_of(sides.begin(), sides.end(), [](const Sides& s) { return s[0] == s[1]; });
}

SurfaceFile read_walls(Session& session, Defects defects) {
  const Arguments& a = session.arguments();
  SurfaceFile file = read_one(session, a.input);
  ComplexOptions options = a.complex;
  options.regions.insert(options.regions.end(), file.regions.begin(), file.regions.end());
  options.voids.insert(options.voids.end(), file.voids.begin(), file.voids.end());
  try {
    session.context().report("cells", -1);
    const bool wraps = defects == Defects::kMended && a.repair == Repair::kWrap;
    auto complex = wraps ? std::nullopt : complex_of_walls(file.surface, options, session.context());
    if (complex && defects == Defects::kMended && is_for_repair(a, options, *complex)) complex.reset();
    if (complex) {
      tell_regions(session, *complex);
      file.surface = std::move(complex->surface);
      if (defects == Defects::kMended) drop_sheets(session, file.surface);
    } else if (defects == Defects::kMended) {
      const SurfaceMesh read = file.surface;
      mend(session, a.input, file.surface);
      if (a.overlap == Overlap::kUnion) tell_united_parts(session, read, file.surface);
    }
  } catch (const LeakError& leak) {
    throw LeakError(fmt::format("{}: {}", a.input.string(), leak.what()), leak.way);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", a.input.string(), error.what()));
  }
  return file;
}

[[noreturn]] void fail_with_way(Session& session, const LeakError& leak) {
  Json way = Json::array();
  for (const Vec3 p : leak.way) way.push_back({p.x, p.y, p.z});
  session.found({{"leak", way}});
  const std::filesystem::path beside = cavity_neighbour(session.arguments());
  if (beside.empty() || leak.way.size() < 2) throw leak;
  write_surface(leak_file(beside), tube_along(leak.way));
  throw InputError(fmt::format("{}\nThe way through the hole is in {}", leak.what(), leak_file(beside).string()));
}

}  // namespace

void tell_regions(Session& session, const Complex& complex) {
  session.say_notes("regions", complex.notes);
  Json regions = Json::array();
  const std::vector<std::string>& names = complex.surface.region_names;
  for (std::size_t r = 0; r < complex.volumes.size(); ++r) {
    // One region alone needs no name.
    const std::string name = r < names.size() ? names[r] : "body";
    regions.push_back({{"name", name}, {"volume", complex.volumes[r]}});
    session.say(fmt::format("  region \"{}\": volume {:.6g}\n", name, complex.volumes[r]));
  }
  if (!regions.empty()) session.found({{"input_regions", regions}});
}

std::filesystem::path leak_file(std::filesystem::path output) {
  return output.replace_extension(".leak.ply");
}

SurfaceFile read_domain(Session& session, Defects defects) {
  if (is_image_input(session.arguments())) return read_image_domain(session);
  try {
    if (session.arguments().bodies.size() > 1) return read_bodies(session, defects);
    return session.arguments().overlap == Overlap::kRegions ? read_parts(session, defects)
                                                            : read_walls(session, defects);
  } catch (const LeakError& leak) {
    fail_with_way(session, leak);
  }
}

}  // namespace octafront::cli
