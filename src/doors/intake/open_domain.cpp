#include <octafront/cad.h>
#include <octafront/complex.h>
#include <octafront/error.h>
#include <octafront/formula.h>
#include <octafront/io.h>
#include <octafront/mend.h>
#include <octafront/options.h>
#include <octafront/surface_mesh.h>

#include "base/core/thread_limit.h"
#include "base/core/wording.h"
#include "doors/intake/cell.h"
#include "doors/intake/intake.h"
#include "sizing/sources/budget.h"
#include "soup/cells/bodies.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace octafront {

IntakeOptions intake_for(const Options& options, IntakeOptions intake) {
  CadIntake& cad = intake.cad;
  if (!cad.size && !cad.elements) {
    cad.elements = options.size.elements;
    if (!cad.elements) cad.size = options.size.size;
  }
  if (!intake.image.size) intake.image.size = options.size.size;
  for (const NamedSize& named : options.size.named) cad.apart.push_back(named.name);
  for (const NearSize& near : options.size.near)
    if (!near.name.empty()) cad.apart.push_back(near.name);
  if (!options.surface.max_deviation)
    intake.image.most_elements = std::min(intake.image.most_elements, most_automatic_budget(options.size));
  // Other maps repeat no bodies; what is no list of axes is refused later, by the name of the option.
  if (!intake.repeat && options.periodic.find_first_of(",@=;") == std::string::npos) intake.repeat = options.periodic;
  return intake;
}

namespace {

using namespace intake;
using Repair = IntakeOptions::Repair;
using Sheets = IntakeOptions::Sheets;
using Overlap = ComplexOptions::Overlap;

/// Keeps what keep[t] says of an array with a value for each triangle, or none.
template <class T>
void keep_marked(std::vector<T>& values, const std::vector<char>& keep) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < values.size(); ++t)
    if (keep[t]) values[kept++] = values[t];
  values.resize(kept);
}

/// Whether duplicates and turned faces were all there was: generate() sees to these and says so, with places.
bool is_tidied_only(const MendReport& r) {
  return r.changes.empty() && r.crossing_pairs == 0 && r.joined_vertices == 0 && r.divided_edges == 0 &&
         r.separated_vertices == 0 && r.largest_move == 0;
}

/// The stems of the files, with numbers behind those that occurred before.
std::vector<std::string> names_of_bodies(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  for (const std::string& file : files) {
    const std::string stem = std::filesystem::path(file).stem().string();
    std::string name = stem;
    for (int n = 2; std::find(names.begin(), names.end(), name) != names.end(); ++n)
      name = fmt::format("{}_{}", stem, n);
    names.push_back(std::move(name));
  }
  return names;
}

/// Runs `work`; what it refuses is said with the name of the input, if it has one.
template <class Work>
auto naming(const std::string& input, const Work& work) {
  try {
    return work();
  } catch (const LeakError& leak) {
    if (input.empty()) throw;
    throw LeakError(fmt::format("{}: {}", input, leak.what()), leak.way);
  } catch (const InputError& error) {
    if (input.empty() || std::string_view(error.what()).starts_with(input)) throw;
    throw InputError(fmt::format("{}: {}", input, error.what()));
  }
}

/// A surface on its way to a domain, and what a file knows beside it.
struct Input {
  std::string name;  ///< of the file; empty: arrays
  Domain read;
  std::vector<RegionSeed> regions = {};
  std::vector<Vec3> voids = {};
};

class Intake {
 public:
  Intake(const IntakeOptions& options, const RunContext& context)
      : options_(options), context_(context), limit_(context.threads), complex_(options.complex) {}

  Input read(const std::string& file) {
    SurfaceFile read = read_surface(file, context_);
    say("", fmt::format("{}: {}, {}", file, read.format, counted(read.surface.triangles.size(), "triangle")));
    note_all(domain_, options_, "reading", read.notes);
    Input input{file, std::move(read.surface), std::move(read.regions), std::move(read.voids)};
    input.read.format = std::move(read.format);
    domain_.sets.insert(domain_.sets.end(), read.sets.begin(), read.sets.end());
    return input;
  }

  Domain surface(Input input) {
    if (input.read.surface.triangles.empty()) throw InputError("there is no triangle, and nothing to mesh");
    add_seeds(input);
    if (complex_.overlap != Overlap::kAuto || asks_for_cell(options_)) return named_parts(std::move(input));
    return plain(std::move(input));
  }

  /// The bodies of several files, or of arrays if there are none.
  Domain bodies(const std::vector<std::string>& files) {
    const std::vector<std::string> names = names_of_bodies(files);
    std::vector<Body> bodies;
    for (std::size_t i = 0; i < files.size(); ++i) {
      Input input = read(files[i]);
      add_seeds(input);
      bodies.push_back({names[i], std::move(input.read.surface)});
      prepare_body(bodies.back(), files[i]);
    }
    domain_.format = "several files";
    return joined(bodies);
  }
  Domain bodies(std::vector<Body> bodies) {
    for (Body& body : bodies) prepare_body(body, body.name);
    domain_.format = "several bodies";
    return joined(bodies);
  }

  Domain cad(const std::string& file) {
    CadTaken taken = naming(file, [&] { return take_cad(domain_, options_, file, context_); });
    if (taken.is_clean) return std::move(domain_);
    if (!taken.bodies.empty()) {
      for (Body& body : taken.bodies) mend_body(body, fmt::format("{} ({})", file, body.name));
      Domain domain = joined(taken.bodies);
      naming(file, [&] { finish_joined_cad(domain, taken, complex_.overlap); });
      return domain;
    }
    if (domain_.surface.triangles.empty()) throw InputError(file + ": there is no triangle, and nothing to mesh");
    Input input{file, std::exchange(domain_, {})};
    return plain(std::move(input));
  }

  Domain image(const Image& image, const std::string& name) {
    if (!name.empty()) say("", fmt::format("{}: {}, {}", name, image.format, in_words(image.grid)));
    take_image(domain_, options_, image, name, context_);
    return std::move(domain_);
  }

 private:
  Domain plain(Input input) {
    const std::string name = input.name;
    return naming(name, [&] { return walls(std::move(input)); });
  }

  void say(const char* stage, std::string text) { note(domain_, options_, stage, std::move(text)); }

  void add_seeds(const Input& input) {
    complex_.regions.insert(complex_.regions.end(), input.regions.begin(), input.regions.end());
    complex_.voids.insert(complex_.voids.end(), input.voids.begin(), input.voids.end());
  }

  void prepare_body(Body& body, const std::string& name) {
    if (!body.surface.sides.empty())
      throw InputError(fmt::format("{}: is a complex of several regions by itself; give it alone", name));
    mend_body(body, name);
  }

  void mend_body(Body& body, const std::string& name) {
    naming(name, [&] { mend(body.surface, name); });
  }

  Domain joined(std::vector<Body> bodies) {
    context_.report("joining", -1);
    if (asks_for_cell(options_)) put_into_cell(bodies);
    take_complex(domain_, options_, cells::join_bodies(bodies, complex_, elements_to_come(options_), context_));
    return std::move(domain_);
  }

  void put_into_cell(std::vector<Body>& bodies) {
    if (complex_.overlap == Overlap::kNew)
      throw OptionError(
          "`overlap` new makes regions of what bodies share with the cell: with `box` give first or later");
    // The cell has no body's way; what it comes before goes to others.
    const auto first = bodies.begin() + (options_.box == "first" ? 1 : 0);
    if (complex_.overlap == Overlap::kFirst) std::reverse(first, bodies.end());
    complex_.overlap = Overlap::kLater;
    complex_.within_first = true;
    // A cell cuts what crosses it: its faces and walls that lie beside copies of themselves were not faceted apart.
    if (!complex_.tolerance) complex_.tolerance = 0;
    std::vector<std::string> notes;
    bodies = bodies_in_cell(std::move(bodies), options_, notes);
    note_all(domain_, options_, "cell", notes);
  }

  /// Parts of one surface that have names of their own; in a cell also one part alone.
  Domain named_parts(Input input) {
    const std::string prefix = input.name.empty() ? "" : input.name + ": ";
    const SurfaceMesh& surface = input.read.surface;
    if (!surface.sides.empty()) throw InputError(prefix + "has regions already; leave out `overlap`");
    std::vector<Body> bodies = bodies_by_name(surface);
    if (bodies.size() < 2 && !asks_for_cell(options_))
      throw InputError(
          fmt::format("{}`overlap` needs parts with names of their own (solids, groups); all of it is \"{}\"", prefix,
                      bodies.empty() ? "" : bodies[0].name));
    for (Body& body : bodies)
      mend_body(body, input.name.empty() ? body.name : fmt::format("{} ({})", input.name, body.name));
    domain_.format = input.read.format;
    return joined(bodies);
  }

  Domain walls(Input input) {
    std::optional<Complex> complex = complex_of(input.read.surface);
    take(std::move(input.read));
    if (complex) {
      take_complex(domain_, options_, std::move(*complex));
      domain_.bound.clear();
      drop_sheets();
    } else {
      mend_all();
    }
    return std::move(domain_);
  }

  /// nullopt for what is to be mended.
  std::optional<Complex> complex_of(const SurfaceMesh& surface) const {
    context_.report("cells", -1);
    if (options_.repair == Repair::kWrap) return std::nullopt;
    std::optional<Complex> complex = cells::complex_of_walls(surface, complex_, elements_to_come(options_), context_);
    if (complex && is_for_repair(*complex)) complex.reset();
    return complex;
  }

  /// A single body with sheets in it, and nobody asked for regions: repair has more to say of what hangs in a body, for
  /// a shell with a hole may be a cavity.
  bool is_for_repair(const Complex& complex) const {
    const auto& sides = complex.surface.sides;
    return options_.repair == Repair::kAuto && options_.sheets == Sheets::kDrop && complex.volumes.size() == 1 &&
           complex_.regions.empty() && complex_.voids.empty() &&
           std::any_of(sides.begin(), sides.end(), [](const Sides& s) { return s[0] == s[1]; });
  }

  /// Keeps what was told so far.
  void take(Domain read) {
    read.notes.insert(read.notes.end(), domain_.notes.begin(), domain_.notes.end());
    read.sets.insert(read.sets.end(), domain_.sets.begin(), domain_.sets.end());
    domain_ = std::move(read);
  }

  /// Drops the walls that have one region on both sides, if the options say so.
  void drop_sheets() {
    if (options_.sheets == Sheets::kKeep || options_.repair == Repair::kOff) return;
    SurfaceMesh& complex = domain_.surface;
    std::vector<char> keep;
    for (const Sides& sides : complex.sides) keep.push_back(sides[0] != sides[1]);
    domain_.dropped_sheet_faces = static_cast<std::uint64_t>(std::count(keep.begin(), keep.end(), 0));
    if (domain_.dropped_sheet_faces == 0) return;
    const double before = area(complex);
    keep_marked(complex.triangles, keep);
    keep_marked(complex.patch, keep);
    keep_marked(complex.source, keep);
    keep_marked(complex.sides, keep);
    say("repair", fmt::format("{} of sheets dropped, area {:.4g}; `sheets` keep keeps them",
                              counted(domain_.dropped_sheet_faces, "face"), before - area(complex)));
  }

  void mend_all() {
    if (!domain_.surface.sides.empty()) return;
    const SurfaceMesh read = domain_.surface;
    if (std::optional<Mended> mended = mend(domain_.surface, "")) domain_.bound = std::move(mended->bound);
    if (complex_.overlap == Overlap::kAuto) tell_united_parts(read);
  }

  /// Mends a surface as the options say; what was done but for the surface, or nullopt if it stays as it is.
  std::optional<Mended> mend(SurfaceMesh& surface, const std::string& of) {
    if (options_.repair == Repair::kOff || !surface.sides.empty()) return std::nullopt;
    MendOptions how{options_.complex.tolerance, MendOptions::Way::kAuto, options_.wrap_distance};
    if (options_.repair == Repair::kWrap) how.way = MendOptions::Way::kWrap;
    Mended mended = mend_surface(surface, how, context_);
    domain_.repairs.push_back({of, mended.report});
    if (mended.report.clean && &surface == &domain_.surface) domain_.found_clean = fingerprint(surface);
    if (mended.report.clean || (!options_.tidies && is_tidied_only(mended.report))) return std::nullopt;
    note_all(domain_, options_, "repair", mended.report.notes);
    surface = std::move(mended.surface);
    return mended;
  }

  /// Parts with names that became one body: there is an option that keeps them apart.
  void tell_united_parts(const SurfaceMesh& read) {
    if (read.patch_names.size() < 2 || domain_.surface.triangles == read.triangles) return;
    const std::vector<Body> parts = bodies_by_name(read);
    const auto is_closed = [](const Body& body) {
      return body.surface.patch.empty() && enclosed_volume(body.surface) > 0;
    };
    if (std::count_if(parts.begin(), parts.end(), is_closed) < 2) return;
    say("repair", fmt::format("the parts \"{}\", \"{}\"{} overlap and are united; `overlap` later makes regions of "
                              "them, by their names",
                              parts[0].name, parts[1].name, parts.size() > 2 ? " ..." : ""));
  }

  const IntakeOptions& options_;
  const RunContext& context_;
  ThreadLimit limit_;
  ComplexOptions complex_;  ///< the user's, and the seeds of the files
  Domain domain_;
};

}  // namespace

namespace intake {

void note(Domain& domain, const IntakeOptions& options, std::string stage, std::string text) {
  domain.notes.push_back({std::move(stage), std::move(text)});
  if (options.tell) options.tell(domain.notes.back());
}

void note_all(Domain& domain, const IntakeOptions& options, const std::string& stage,
              const std::vector<std::string>& texts) {
  for (const std::string& text : texts) note(domain, options, stage, text);
}

void take_complex(Domain& domain, const IntakeOptions& options, Complex complex) {
  note_all(domain, options, "regions", complex.notes);
  domain.surface = std::move(complex.surface);
  domain.volumes = std::move(complex.volumes);
  for (std::size_t r = 0; r < domain.volumes.size(); ++r)
    note(domain, options, "", fmt::format("  region \"{}\": volume {:.6g}", region_name(domain, r), domain.volumes[r]));
}

cells::ElementsToCome elements_to_come(const IntakeOptions& options) {
  return {options.cad.size, options.cad.elements};
}

std::string region_name(const Domain& domain, std::size_t region) {
  const std::vector<std::string>& names = domain.surface.region_names;
  return region < names.size() ? names[region] : "body";
}

}  // namespace intake

Domain open_domain(const std::vector<std::string>& files, const IntakeOptions& options, const RunContext& context) {
  if (files.empty()) throw OptionError("no file is given");
  if (files.size() == 1 && is_formula(files.front()))
    return with_inside(open_formula(files.front(), options, context), options, context);
  refuse_formula_options(options.formula, files.front());
  if (is_image(files.front())) {
    const Image image = read_image(files, options.image.choice, context);
    return with_inside(Intake(options, context).image(image, files.front()), options, context);
  }
  refuse_image_options(options, files.front());
  Intake intake(options, context);
  if (is_cad(files.front())) {
    if (files.size() > 1) throw OptionError(fmt::format("{}: give one CAD file; its solids are the regions", files[0]));
    return with_inside(intake.cad(files.front()), options, context);
  }
  return with_inside(files.size() > 1 ? intake.bodies(files) : intake.surface(intake.read(files.front())), options,
                     context);
}

Domain open_domain(const std::string& file, const IntakeOptions& options, const RunContext& context) {
  return open_domain(std::vector{file}, options, context);
}

Domain open_domain(Domain input, const IntakeOptions& options, const RunContext& context) {
  refuse_image_options(options, "a surface");
  if (input.geometry) return with_inside(std::move(input), options, context);
  return with_inside(Intake(options, context).surface({"", std::move(input), {}, {}}), options, context);
}

Domain open_domain(std::vector<Body> bodies, const IntakeOptions& options, const RunContext& context) {
  refuse_image_options(options, "a surface");
  return with_inside(Intake(options, context).bodies(std::move(bodies)), options, context);
}

Domain open_domain(const Image& image, const IntakeOptions& options, const RunContext& context) {
  return with_inside(Intake(options, context).image(image, ""), options, context);
}

}  // namespace octafront
