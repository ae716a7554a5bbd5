#include <octafront/error.h>
#include <octafront/options.h>
#include <octafront/repair.h>
#include <octafront/units.h>

#include "base/core/renumber.h"
#include "base/core/wording.h"
#include "cad/reader/cad_reader.h"
#include "cad/shapes/collapse_tiny.h"
#include "cad/shapes/face_groups.h"
#include "cad/shapes/names.h"
#include "cad/shapes/part_contacts.h"
#include "cad/shapes/shapes.h"
#include "doors/intake/intake.h"
#include "sizing/field/affordable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace octafront::intake {

namespace {

using namespace cad;

/// Without a size elements are thought to be a fortieth of the diagonal.
constexpr double kSizeOfDiagonal = 1.0 / 40;
/// Triangles lie nearer to the true faces than this part of an element, and of what the thinnest solid is thick (twice
/// its volume over its area); but no finer than this part of the diagonal.
constexpr double kDeflectionOfSize = 0.05, kDeflectionOfThickness = 0.04, kLeastDeflection = 2e-5;
constexpr double kAngle = 0.25;
/// Neither finer nor coarser triangles are safer from crossing each other, where faces meet at flat angles: these are
/// tried, as multiples of deflection and angle, until there are clean ones.
constexpr std::array<std::array<double, 2>, 5> kLadder{{{1, 1}, {0.5, 1}, {2, 2}, {0.25, 0.5}, {4, 2}}};
/// Faces end where they grow tiny; where the solid would not be clean then, or its volume off, where they are tinier,
/// by these parts.
constexpr std::array kTinyTried{1.0, 0.5, 0.25};
/// Triangles whose volume is off by more are tried finer.
constexpr double kVolumeOff = 0.003;
/// Chords of elements may lie so deep, in parts of the volume of a solid over its area: what they cut off then is well
/// below a percent of it. Flat faces lose nothing: where those that do have less than this part of the area, chords lie
/// deeper by as much, but by no more than this factor.
constexpr double kDepthOfThickness = 0.025, kMuchCurved = 0.6, kMostDeeper = 4;
/// A part of its volume that a solid may lose where solids are joined by their triangles: these stray about as much.
constexpr double kMostLost = 0.01;
/// Elements that are asked to be so many times as large as all of the part were meant for another unit.
constexpr double kFarLarger = 10;

std::string unit_in_words(const CadModel& model, const CadIntake& asked) {
  const std::string of_file = model.unit.empty() ? "unit not said, taken as millimetre" : "unit " + model.unit;
  const double factor = model.to_millimetres / millimetres_of(asked);
  if (factor == 1) return of_file;
  return fmt::format("{}: numbers times {:g} are lengths in \"{}\", as all here", of_file, factor, asked.unit);
}

/// The edge length that elements will have, in the model's unit, as far as that is asked for.
std::optional<double> asked_size(const CadIntake& asked, const CadModel& model) {
  if (asked.size) return *asked.size * unit_of(model, asked);
  if (!asked.elements) return std::nullopt;
  double volume = 0;
  for (const Solid& solid : model.solids) volume += std::max(0.0, solid.volume);
  if (volume == 0) return std::nullopt;
  return size_of_elements(volume, *asked.elements);
}

/// The thickness of the thinnest solid; infinite if there is none.
double least_thickness(const CadModel& model) {
  double least = HUGE_VAL;
  for (const Solid& solid : model.solids)
    if (solid.area > 0 && solid.volume > 0) least = std::min(least, 2 * solid.volume / solid.area);
  return least;
}

/// The triangles of the solids, or of all faces where there are no solids.
SurfaceMesh surface_of(const CadModel& model, const FaceGroups& groups) {
  SurfaceMesh surface;
  surface.points = model.points;
  surface.patch_names = groups.names;
  const bool has_solids = !model.solids.empty();
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const std::uint32_t f = model.face_of[t];
    const Sides& sides = model.faces[f].sides;
    if (has_solids && sides[0] == kNone && sides[1] == kNone) continue;
    surface.triangles.push_back(model.triangles[t]);
    surface.patch.push_back(groups.group_of[f]);
    if (model.solids.size() > 1) surface.sides.push_back(sides);
  }
  if (has_solids) surface.region_names = solid_names(model);
  return surface;
}

/// What the triangles of each solid enclose.
std::vector<double> volumes_of(const CadModel& model) {
  std::vector<double> volumes(model.solids.size(), 0);
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const auto& [a, b, c] = model.triangles[t];
    const double v = dot(cross(model.points[a], model.points[b]), model.points[c]) / 6;
    const Sides& sides = model.faces[model.face_of[t]].sides;
    if (sides[0] != kNone) volumes[sides[0]] -= v;
    if (sides[1] != kNone) volumes[sides[1]] += v;
  }
  return volumes;
}

/// By which part the volume of triangles is off, at the worst of the solids.
double worst_volume(const CadModel& model) {
  const std::vector<double> volumes = volumes_of(model);
  double worst = 0;
  for (std::size_t s = 0; s < volumes.size(); ++s)
    worst = std::max(worst, std::abs(volumes[s] / model.solids[s].volume - 1));
  return worst;
}

/// Triangles, and what is wrong with them.
struct Triangulated {
  CadModel model;
  FaceGroups groups;
  SurfaceMesh surface;
  std::string defects = {};  ///< in words; empty: none
  SurfaceDefects::Kind crossings = {};
  double off = 0;  ///< worst_volume()
  Collapsed collapsed = {};

  bool is_good() const { return defects.empty() && off <= kVolumeOff; }
  bool is_better_than(const Triangulated& other) const {
    if (defects.empty() != other.defects.empty()) return defects.empty();
    // What is not clean is mended, and that takes the longer the more there is.
    if (!defects.empty() && std::max(off, other.off) <= kVolumeOff)
      return surface.triangles.size() < other.surface.triangles.size();
    return off < other.off;
  }
};

/// More pairs of triangles that cross than this part of all are no accident of the triangles: the solid passes through
/// itself, and what could be mended of it is another solid.
constexpr double kMostCrossings = 0.05;

void refuse_crossing_solid(const Triangulated& made) {
  const SurfaceMesh& surface = made.surface;
  if (static_cast<double>(made.crossings.count) <= kMostCrossings * static_cast<double>(surface.triangles.size()))
    return;
  const SurfaceDefects::Place& first = made.crossings.first[0];
  const auto name = [&](std::size_t k) { return surface.patch_names[surface.patch_of(first.faces[k])]; };
  throw InputError(fmt::format(
      "the solid passes through itself: {} pairs of triangles cross, the first near ({:.6g}, {:.6g}, {:.6g}) of \"{}\" "
      "and \"{}\". OpenCASCADE may have read a face as the part of its surface that was cut away; mend the solid in "
      "the CAD system, or write the file anew",
      made.crossings.count, first.at.x, first.at.y, first.at.z, name(0), name(1)));
}

/// Names of the first few faces, in brackets.
std::string listed(const CadModel& model, const std::vector<std::uint32_t>& faces) {
  constexpr std::size_t kFew = 5;
  if (faces.empty()) return "";
  const std::vector<std::string> names = face_names(model);
  std::string all;
  for (std::size_t k = 0; k < std::min(kFew, faces.size()); ++k) all += (k > 0 ? ", " : " (") + names[faces[k]];
  return all + (faces.size() > kFew ? ", ...)" : ")");
}

class CadIn {
 public:
  CadIn(const std::string& file, Domain& domain, const IntakeOptions& options, const RunContext& context)
      : domain_(domain),
        options_(options),
        context_(context),
        reader_(
            file, reader_options(options), [&](const std::string& text) { note(domain, options, "CAD", text); },
            context) {
    say_what_it_is(file);
    const Opened& opened = reader_.opened();
    const double diagonal = distance(opened.lo, opened.hi);
    asked_ = asked_size(options.cad, opened.model);
    size_ = asked_.value_or(kSizeOfDiagonal * diagonal);
    judge_size(opened.hi - opened.lo);
    deflection_ = std::max(kLeastDeflection * diagonal,
                           std::min(kDeflectionOfSize * size_, kDeflectionOfThickness * least_thickness(opened.model)));
  }

  Triangulated triangulate() {
    Triangulated best = attempt(kLadder[0]);
    for (std::size_t k = 1; k < kLadder.size() && !best.is_good() && !best.model.solids.empty(); ++k)
      if (Triangulated other = attempt(kLadder[k]); other.is_better_than(best)) best = std::move(other);
    tell(best);
    return best;
  }

 private:
  Triangulated attempt(const std::array<double, 2>& by) {
    CadModel model = reader_.triangulate({deflection_ * by[0], kAngle * by[1]});
    if (options_.cad.keep_edges) return judged(std::move(model));
    const std::vector<std::uint32_t> spared = faces_at(model, options_.cad.apart, unit_of(model, options_.cad));
    return with_parts_ended(without_tiny(std::move(model), spared), spared);
  }

  Triangulated without_tiny(CadModel model, const std::vector<std::uint32_t>& spared) const {
    CadModel simpler = model;
    const Collapsed collapsed = collapse_tiny(simpler, kTinyOfSize * size_, spared);
    if (collapsed.edges + collapsed.faces.size() == 0) return judged(std::move(model));
    Triangulated without = judged(std::move(simpler));
    without.collapsed = collapsed;
    if (without.is_good()) return without;
    Triangulated with = judged(std::move(model));
    return without.is_better_than(with) ? without : with;
  }

  /// Of several solids, whose lines the surface front cannot merge.
  Triangulated with_parts_ended(Triangulated made, const std::vector<std::uint32_t>& spared) const {
    if (made.model.solids.size() < 2) return made;
    for (const double part : kTinyTried) {
      CadModel simpler = made.model;
      const Collapsed ended = end_narrow_parts(simpler, part * kTinyOfSize * size_, spared);
      if (ended.faces.empty() && ended.narrowed.empty()) break;
      Triangulated without = judged(std::move(simpler));
      without.collapsed = made.collapsed;
      std::ranges::copy(ended.faces, std::back_inserter(without.collapsed.faces));
      without.collapsed.narrowed = ended.narrowed;
      if (without.is_good() || (!made.is_good() && without.is_better_than(made))) return without;
    }
    return made;
  }

  Triangulated judged(CadModel model) const {
    Triangulated made{std::move(model), {}, {}};
    made.groups = options_.cad.keep_edges
                      ? faces_as_they_are(made.model)
                      : group_faces(made.model, asked_, options_.cad.apart, unit_of(made.model, options_.cad));
    made.surface = surface_of(made.model, made.groups);
    if (made.model.solids.empty()) return made;
    context_.report("checking", -1);
    const SurfaceDefects found = find_defects(repair_surface(made.surface, context_), context_);
    if (!found.clean()) made.defects = found.describe(), made.crossings = found.self_intersections;
    made.off = worst_volume(made.model);
    return made;
  }

  void say_what_it_is(const std::string& file) {
    const CadModel& model = reader_.opened().model;
    domain_.format = model.format;
    note(domain_, options_, "",
         fmt::format("{}: {}, {}, {}, {}", file, model.format, counted(model.solids.size(), "solid"),
                     counted(model.faces.size(), "face"), unit_in_words(model, options_.cad)));
    note_all(domain_, options_, "CAD", model.notes);
  }

  void tell(const Triangulated& made) {
    const std::vector<std::string>& notes = made.model.notes;
    const std::size_t told = std::min(notes.size(), reader_.opened().model.notes.size());
    note_all(domain_, options_, "CAD", {notes.begin() + static_cast<std::ptrdiff_t>(told), notes.end()});
    std::size_t loose = 0;
    for (const Face& face : made.model.faces) loose += !made.model.solids.empty() && face.sides == Sides{kNone, kNone};
    if (loose > 0) note(domain_, options_, "CAD", fmt::format("{} of no solid left out", counted(loose, "face")));
    if (made.groups.names.size() < made.model.faces.size())
      note(domain_, options_, "CAD",
           fmt::format("{} faces are meshed as {}, where narrow ones go on smoothly; each keeps its name. `keep_edges` "
                       "keeps every line",
                       made.model.faces.size(), counted(made.groups.names.size(), "patch", "patches")));
    const auto& [faces, narrowed, edges] = made.collapsed;
    if (edges + faces.size() > 0)
      note(domain_, options_, "CAD",
           fmt::format(
               "{} and {} that are tiny against elements of {:.4g} have none of their own{}; `keep_edges` keeps "
               "them",
               counted(faces.size(), "face"), counted(edges, "edge"), in_unit(size_), listed(made.model, faces)));
    if (!narrowed.empty())
      note(domain_, options_, "CAD",
           fmt::format("{} that grow narrow against elements of {:.4g}, as wedges and cusps do, end there{}; "
                       "`keep_edges` keeps them",
                       counted(narrowed.size(), "face"), in_unit(size_), listed(made.model, narrowed)));
    const TinyThings tiny = tiny_things(made.model, size_);
    if (tiny.edges + tiny.faces + tiny.narrow_faces > 0)
      note(domain_, options_, "CAD",
           fmt::format("against elements of {:.4g}: {} of {} edges, {} faces and {} narrow ones are tiny (below a "
                       "tenth); the shortest edge is {:.3g}",
                       in_unit(size_), tiny.edges, made.model.edges.size(), tiny.faces, tiny.narrow_faces,
                       in_unit(tiny.shortest_edge)));
  }

  /// A length of the model in the unit that is asked for.
  double in_unit(double length) const { return length / unit_of(reader_.opened().model, options_.cad); }

  /// A size far larger than the part is one of another unit.
  void judge_size(Vec3 extent) const {
    const double part = std::max({extent.x, extent.y, extent.z});
    if (!asked_ || !options_.cad.size || !(size_ > kFarLarger * part)) return;
    const CadModel& model = reader_.opened().model;
    const std::string found =
        fmt::format("the size, {:.4g} {}, is {:.3g} times the part, which is {:.4g} {} long", in_unit(size_),
                    options_.cad.unit, size_ / part, in_unit(part), options_.cad.unit);
    if (model.unit.empty() && model.format == "BREP" && options_.cad.unit != "mm")
      throw OptionError(fmt::format(
          "{}: BREP says no unit, and its numbers are taken as millimetres. `unit` mm and lengths in the unit of the "
          "file mesh it by its own numbers",
          found));
    note(domain_, options_, "CAD", found);
  }

  Domain& domain_;
  const IntakeOptions& options_;
  const RunContext& context_;
  CadReader reader_;
  std::optional<double> asked_;  ///< edge length
  double size_ = 0, deflection_ = 0;
};

/// The triangles of each solid, facing away from it.
std::vector<Body> bodies_of(const Triangulated& made) {
  const std::vector<std::string> names = solid_names(made.model);
  std::vector<Body> bodies;
  for (std::uint32_t s = 0; s < names.size(); ++s) {
    Body body{names[s], {{}, {}, {}, made.groups.names, {}}};
    PointsTaken taken(made.model.points);
    for (std::size_t t = 0; t < made.model.triangles.size(); ++t) {
      const std::uint32_t f = made.model.face_of[t];
      const auto& [front, behind] = made.model.faces[f].sides;
      if (front != s && behind != s) continue;
      auto [a, b, c] = made.model.triangles[t];
      if (front == s) std::swap(b, c);
      body.surface.triangles.push_back(taken.take(Triangle{a, b, c}, body.surface.points));
      body.surface.patch.push_back(made.groups.group_of[f]);
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

/// The area of what is not flat of each solid.
std::vector<double> curved_areas(const CadModel& model) {
  std::vector<double> areas(model.solids.size(), 0);
  for (const Face& face : model.faces) {
    if (face.surface.kind == SurfaceRecord::Kind::kPlane) continue;
    for (const std::uint32_t s : face.sides)
      if (s != kNone) areas[s] += face.area;
  }
  return areas;
}

/// Domain::chord_depths, in the model's unit: by what a solid is thick.
std::vector<double> depths_of_solids(const CadModel& model) {
  std::vector<double> bound;
  const std::vector<double> curved = curved_areas(model);
  for (std::size_t s = 0; s < curved.size(); ++s) {
    const Solid& solid = model.solids[s];
    const bool known = solid.area > 0 && solid.volume > 0;
    const double deeper = std::clamp(kMuchCurved * solid.area / curved[s], 1.0, kMostDeeper);
    bound.push_back(known ? deeper * kDepthOfThickness * solid.volume / solid.area : HUGE_VAL);
  }
  return bound;
}

std::vector<std::pair<std::string, double>> densities_of_solids(const CadModel& model) {
  std::vector<std::pair<std::string, double>> all;
  const std::vector<std::string> names = cad::solid_names(model);
  for (std::size_t s = 0; s < names.size(); ++s)
    if (model.solids[s].density > 0) all.emplace_back(names[s], model.solids[s].density);
  return all;
}

/// From the model's unit to the one that is asked for.
void convert(std::vector<Vec3>& points, double unit) {
  for (Vec3& p : points) p = p / unit;
}

/// Patches of joined solids have names of the solids too: back to those of the faces, unless mending made faces that
/// are of none.
void take_patches_of_faces(SurfaceMesh& joined, const std::vector<Body>& bodies) {
  std::vector<std::uint32_t> patch_of_source;
  for (const Body& body : bodies) {
    if (body.surface.patch_names != bodies[0].surface.patch_names) return;
    for (std::size_t t = 0; t < body.surface.triangles.size(); ++t) patch_of_source.push_back(body.surface.patch_of(t));
  }
  for (std::size_t t = 0; t < joined.triangles.size(); ++t)
    if (joined.source_of(t) >= patch_of_source.size()) return;
  for (std::size_t t = 0; t < joined.triangles.size(); ++t) joined.patch[t] = patch_of_source[joined.source_of(t)];
  joined.patch_names = bodies[0].surface.patch_names;
}

/// Nobody said who gets what solids share: a region that lost more than triangles lose did overlap.
void refuse_overlaps(const Domain& domain) {
  for (std::size_t r = 0; r < domain.true_volumes.size() && r < domain.volumes.size(); ++r) {
    const double lost = domain.true_volumes[r] - domain.volumes[r];
    if (lost > kMostLost * domain.true_volumes[r])
      throw InputError(
          fmt::format("\"{}\" overlaps other solids in {:.3g} (its volume: {:.6g}). `overlap` first or later gives "
                      "what they share to one of them, new makes regions of it",
                      region_name(domain, r), lost, domain.true_volumes[r]));
  }
}

/// Whether solids lie apart by no more than what is to close: OpenCASCADE does not, but their triangles can be joined.
bool has_gaps_to_close(const CadModel& model, const IntakeOptions& options) {
  const double closes = options.complex.tolerance.value_or(0) * unit_of(model, options.cad);
  return closes > 0 && std::ranges::any_of(cad::contacts_of(model), [&](const cad::Contact& contact) {
           return contact.gap > 0 && contact.gap <= closes;
         });
}

}  // namespace

CadTaken take_cad(Domain& domain, const IntakeOptions& options, const std::string& file, const RunContext& context) {
  check_cad_intake(options.cad);
  Triangulated made = CadIn(file, domain, options, context).triangulate();
  CadTaken taken;
  const bool has_solids = !made.model.solids.empty();
  taken.closes_gaps = has_solids && made.defects.empty() && has_gaps_to_close(made.model, options);
  taken.is_clean = has_solids && made.defects.empty() && !taken.closes_gaps;
  if (made.model.solids.size() == 1) refuse_crossing_solid(made);
  if (!made.defects.empty()) note(domain, options, "CAD", "the triangles are mended: " + made.defects);
  if (!taken.is_clean && made.model.solids.size() > 1) taken.bodies = bodies_of(made);
  const double unit = unit_of(made.model, options.cad);
  for (const double d : depths_of_solids(made.model)) domain.chord_depths.push_back(d / unit);
  for (const Solid& solid : made.model.solids) domain.true_volumes.push_back(solid.volume / (unit * unit * unit));
  domain.densities = densities_of_solids(made.model);
  domain.surface = std::move(made.surface), domain.unit = options.cad.unit;
  convert(domain.surface.points, unit);
  for (Body& body : taken.bodies) convert(body.surface.points, unit);
  if (!taken.is_clean) domain.surface.sides.clear();
  domain.geometry = std::make_shared<Shapes>(std::move(made.model), std::move(made.groups), unit);
  for (std::size_t r = 0; taken.is_clean && r < domain.true_volumes.size(); ++r) {
    if (domain.true_volumes.size() > 1) domain.volumes.push_back(domain.true_volumes[r]);
    note(domain, options, "",
         fmt::format("  region \"{}\": volume {:.6g}", region_name(domain, r), domain.true_volumes[r]));
  }
  return taken;
}

void finish_joined_cad(Domain& domain, const CadTaken& taken, ComplexOptions::Overlap overlap) {
  take_patches_of_faces(domain.surface, taken.bodies);
  if (taken.closes_gaps)
    domain.true_volumes.clear();  // whoever got a gap is larger than in the file; it is said by how much
  else if (overlap == ComplexOptions::Overlap::kAuto)
    refuse_overlaps(domain);
  else
    domain.true_volumes = domain.volumes;
}

}  // namespace octafront::intake
