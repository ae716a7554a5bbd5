
#include "formats/jobs/job_plan.h"

#include <octafront/error.h>

#include "base/places/places.h"
#include "formats/jobs/job_places.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using Origin = Part::Origin;

/// Of each opened contact of a mesh what is asked for it; null: nothing.
using ContactLaws = std::vector<const JobContact*>;

void take_law(const TetMesh& mesh, const JobContact& asked, ContactLaws& laws) {
  const std::vector<OpenedContact>& opened = mesh.opened_contacts;
  const std::vector<std::uint32_t> meant = named_so(mesh.patch_names, asked.place);
  bool found = asked.place.empty();
  for (std::size_t i = 0; i < opened.size(); ++i) {
    const auto means = [&](std::uint32_t patch) { return std::ranges::find(meant, patch) != meant.end(); };
    if (asked.place.empty() || means(opened[i].first) || means(opened[i].second)) laws[i] = &asked, found = true;
  }
  if (found) return;
  std::vector<std::string> there;
  for (const OpenedContact& o : opened) there.push_back(patch_label(mesh.patch_names, o.first));
  throw OptionError(fmt::format("`friction`: {}; open them by `contacts` split",
                                no_such_place(asked.place, {{"opened contact", there}})));
}

ContactLaws laws_of(const TetMesh& mesh, const SolverJob& job) {
  ContactLaws laws(mesh.opened_contacts.size(), nullptr);
  for (const bool default_first : {true, false})
    for (const JobContact& asked : job.contacts)
      if (asked.place.empty() == default_first) take_law(mesh, asked, laws);
  return laws;
}

/// The patches of the contacts that hold nodes of both sides together.
std::vector<std::uint32_t> tied_patches(const TetMesh& mesh, const SolverJob& job) {
  const ContactLaws laws = laws_of(mesh, job);
  std::vector<std::uint32_t> tied;
  for (std::size_t i = 0; i < laws.size(); ++i)
    if (laws[i] == nullptr || !laws[i]->friction)
      tied.insert(tied.end(), {mesh.opened_contacts[i].first, mesh.opened_contacts[i].second});
  return tied;
}

class Planner {
 public:
  Planner(MeshOutput& out, const MeshParts& mesh, const SolverJob& job, const std::vector<BoltSection>& sections)
      : out_(out), mesh_(mesh), job_(job), sections_(sections), places_(mesh.mesh(), mesh, job) {}

  JobPlan plan() {
    plan_materials(out_, mesh_, job_, places_, plan_);
    plan_couplings();
    plan_fixes();
    plan_systems();
    plan_loads();
    plan_pressures();
    plan_contacts();
    plan_bolts();
    refuse_what_follows_twice();
    if (job_.gravity) plan_gravity();
    note_what_lacks();
    if (const std::string loose = loose_parts(mesh_, plan_); !loose.empty())
      out_.note(
          fmt::format("nothing joins {} to what is held: join them (`tolerance` closes gaps), hold them, or leave them "
                      "out; solvers stop there, or answer with zeros",
                      loose));
    note_what_reactions_lack();
    return std::move(plan_);
  }

 private:
  std::size_t part_of(const PlaceSet& wanted) const { return places_.part(wanted).value(); }
  std::span<const Part> regions() const { return mesh_.parts(Origin::kRegion); }

  void plan_couplings() {
    std::set<std::string> names;
    for (const JobCoupling& c : job_.couplings) {
      if (!names.insert(c.name).second) throw OptionError(fmt::format("`couple`: there are two \"{}\"", c.name));
      JobPlan::Coupling planned{
          .name = c.name, .part = part_of(places_.faces("couple", c.place)), .is_rigid = c.is_rigid};
      for (const auto& [node, share] : shares_of(mesh_, mesh_.parts()[planned.part]))
        planned.at += mesh_.mesh().points[node] * share;
      if (c.at) planned.at = *c.at;
      plan_.couplings.push_back(std::move(planned));
    }
  }

  void plan_fixes() {
    for (const JobFix& fix : job_.fixes) {
      const auto holds = [&](char axis) { return fix.axes.empty() || fix.axes.find(axis) != std::string::npos; };
      if (const auto point = places_.point(fix.place)) {
        if (!fix.of_cylinder.empty())
          throw OptionError(fmt::format("`fix`: \"{}\" is a point, and no cylinder", fix.place));
        JobPlan::Coupling& c = plan_.couplings[*point];
        if (!c.is_rigid)
          throw OptionError(
              fmt::format("`fix`: \"{}\" is distributing, and bears loads; hold a rigid point", fix.place));
        for (std::size_t i = 0; i < 6; ++i) c.holds[i] = i < 3 ? holds("xyz"[i]) : holds('r');
        continue;
      }
      if (fix.axes.find('r') != std::string::npos)
        throw OptionError(
            fmt::format("`fix`: \"{}\" has no rotations to hold: those of solids follow from \"xyz\"", fix.place));
      if (!fix.of_cylinder.empty()) {
        plan_.fixes.push_back(fix_of_cylinder(fix));
        continue;
      }
      plan_.fixes.push_back({part_of(places_.anything("fix", fix.place)), {holds('x'), holds('y'), holds('z')}, {}});
    }
  }

  JobPlan::Fix fix_of_cylinder(const JobFix& fix) const {
    JobPlan::Fix planned{part_of(places_.faces("fix", fix.place)), {}, {}};
    planned.cylinder = cylinder_of(triangles_of(mesh_, mesh_.parts()[planned.part]));
    if (!planned.cylinder)
      throw OptionError(fmt::format(
          "`fix`: \"{}\" is no cylinder: \"radial\", \"tangential\", \"axial\" mean nothing there", fix.place));
    constexpr std::array<std::string_view, 3> kWords{"radial", "tangential", "axial"};
    for (std::size_t i = 0; i < kWords.size(); ++i)
      planned.holds[i] = std::ranges::find(fix.of_cylinder, kWords[i]) != fix.of_cylinder.end();
    return planned;
  }

  const std::string& name_of(const JobPlan::Fix& fix) const { return mesh_.parts()[fix.part].name; }

  void plan_systems() {
    std::vector<JobPlan::Fix>& fixes = plan_.fixes;
    for (std::size_t f = 0; f < fixes.size(); ++f) {
      if (!fixes[f].cylinder) continue;
      for (const VertexIndex v : mesh_.nodes_of(mesh_.parts()[fixes[f].part])) {
        const JobPlan::Fix& first = fixes[plan_.systems.try_emplace(v, f).first->second];
        if (!share_axis(*first.cylinder, *fixes[f].cylinder)) refuse_shared(first, fixes[f]);
      }
    }
    for (JobPlan::Fix& fix : fixes)
      if (!fix.cylinder) turn(fix);
  }
  void turn(JobPlan::Fix& fix) const {
    for (const VertexIndex v : mesh_.nodes_of(mesh_.parts()[fix.part])) {
      const auto at = plan_.systems.find(v);
      if (at == plan_.systems.end()) continue;
      const JobPlan::Fix& other = plan_.fixes[at->second];
      const auto holds = in_directions_of(*other.cylinder, fix.holds);
      if (!holds) refuse_shared(fix, other);
      fix.turned.emplace_back(v, *holds);
    }
  }
  /// None where what is held is no choice of radial, tangential, axial.
  static std::optional<std::array<bool, 3>> in_directions_of(const Cylinder& cylinder,
                                                             const std::array<bool, 3>& holds) {
    constexpr double kParallel = 0.9999;
    if (holds[0] && holds[1] && holds[2]) return holds;
    for (std::size_t k = 0; k < 3; ++k)
      if (const bool across = holds[(k + 1) % 3];
          std::abs(cylinder.axis[static_cast<int>(k)]) > kParallel && across == holds[(k + 2) % 3])
        return std::array{across, across, static_cast<bool>(holds[k])};
    return std::nullopt;
  }
  [[noreturn]] void refuse_shared(const JobPlan::Fix& a, const JobPlan::Fix& b) const {
    throw OptionError(
        fmt::format("`fix`: \"{}\" and \"{}\" share nodes, which would be held in two systems of directions; "
                    "hold one of them in all directions, or hold faces that do not touch",
                    name_of(a), name_of(b)));
  }

  void plan_loads() {
    for (const JobLoad& load : job_.loads) {
      if (const auto point = places_.point(load.place)) {
        std::optional<Vec3>& force = plan_.couplings[*point].force;
        force = force.value_or(Vec3{}) + load.force;
        continue;
      }
      plan_.loads.push_back({part_of(places_.faces("load", load.place)), load.force});
      for (const auto& [node, share] : shares_of(mesh_, mesh_.parts()[plan_.loads.back().part]))
        plan_.forces[node] += load.force * share;
    }
  }

  /// Solvers take the last of two on a face.
  void plan_pressures() {
    std::set<std::uint32_t> pressed;
    for (const JobPressure& p : job_.pressures) {
      plan_.pressures.push_back({part_of(places_.faces("pressure", p.place)), p.value});
      for (const std::uint32_t f : mesh_.parts()[plan_.pressures.back().part].members)
        if (!pressed.insert(f).second)
          throw OptionError(fmt::format("`pressure`: faces of \"{}\" have another one too", p.place));
    }
  }

  std::size_t part_of_patch(std::uint32_t patch) const {
    const auto& parts = mesh_.parts();
    return static_cast<std::size_t>(
        std::ranges::find_if(parts, [&](const Part& p) { return p.origin == Origin::kPatch && p.number == patch; }) -
        parts.begin());
  }

  struct Face {
    double edge = 0, young = 0;  ///< of a side of a contact
  };
  Face side_of(std::size_t number) const {
    const Part& part = mesh_.parts()[number];
    double area = 0;
    for (const auto& [a, b, c] : triangles_of(mesh_, part)) area += 0.5 * length(cross(b - a, c - a));
    const auto at = std::ranges::find(regions(), region_at(number), &Part::number) - regions().begin();
    const std::size_t material = plan_.material_of[static_cast<std::size_t>(at)];
    // Of regular triangles.
    return {std::sqrt(area / static_cast<double>(part.members.size()) * 4 / std::sqrt(3.0)),
            material < plan_.materials.size() ? plan_.materials[material].young : kSteelYoung};
  }

  /// Contacts of parts that nobody names are tied; what is open inside a part, a crack, stays so.
  void plan_contacts() {
    const std::vector<OpenedContact>& opened = mesh_.mesh().opened_contacts;
    const ContactLaws laws = laws_of(mesh_.mesh(), job_);
    for (std::size_t i = 0; i < opened.size(); ++i) {
      const std::array<std::size_t, 2> parts{part_of_patch(opened[i].first), part_of_patch(opened[i].second)};
      if (std::max(parts[0], parts[1]) >= mesh_.parts().size()) continue;
      if (laws[i] != nullptr || region_at(parts[0]) != region_at(parts[1]))
        plan_.contacts.push_back(contact_of(parts, laws[i] != nullptr ? laws[i]->friction : std::nullopt));
      if (laws[i] != nullptr && laws[i]->friction && !opened[i].conforming && !is_flat(parts[0]))
        out_.note(
            fmt::format("\"{}\" is curved and slides on triangles of its own: chords of one side reach into the "
                        "other, which presses them apart; `contacts` split has the same triangles on both",
                        mesh_.parts()[parts[0]].name));
    }
  }
  bool is_flat(std::size_t part) const {
    constexpr double kFlat = 1e-3;  // of an edge
    const auto faces = triangles_of(mesh_, mesh_.parts()[part]);
    const auto& [a, b, c] = faces[0];
    const Vec3 normal = normalized(cross(b - a, c - a));
    return std::ranges::all_of(faces, [&, &a = a, edge = length(b - a)](const auto& face) {
      return std::ranges::all_of(face, [&](Vec3 p) { return std::abs(dot(p - a, normal)) < kFlat * edge; });
    });
  }
  std::uint32_t region_at(std::size_t part) const {
    return mesh_.region_of(mesh_.sides()[mesh_.parts()[part].members[0]].tet);
  }

  /// The finer side is the slave, else the softer one.
  JobPlan::Contact contact_of(const std::array<std::size_t, 2>& parts, std::optional<double> friction) const {
    constexpr double kSameSize = 1.05, kApart = 0.25;  // chords of curved faces leave gaps
    const std::array<Face, 2> sides{side_of(parts[0]), side_of(parts[1])};
    const bool alike = std::max(sides[0].edge, sides[1].edge) < kSameSize * std::min(sides[0].edge, sides[1].edge);
    const bool second = alike ? sides[1].young < sides[0].young : sides[1].edge < sides[0].edge;
    return {.slave = parts[second],
            .master = parts[!second],
            .friction = friction,
            .edge = sides[second].edge,
            .young = std::min(sides[0].young, sides[1].young),
            .apart = kApart * std::max(sides[0].edge, sides[1].edge)};
  }

  void plan_bolts() {
    for (const BoltSection& section : sections_) {
      const auto at = std::ranges::find(regions(), section.region, &Part::number) - regions().begin();
      plan_.pretensions.push_back({.region = static_cast<std::size_t>(at),
                                   .force = section.force,
                                   .middle = section.middle,
                                   .axis = section.axis,
                                   .nodes = nodes_of(section)});
    }
  }
  std::vector<std::pair<VertexIndex, VertexIndex>> nodes_of(const BoltSection& section) const {
    std::map<VertexIndex, VertexIndex> behind;
    for (const auto& [n, patch] : mesh_.mesh().split_faces) {
      if (patch != section.in_front) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        behind[n[3 + k]] = n[k];
        const std::size_t l = (k + 1) % 3;
        if (mesh_.second_order()) behind[mesh_.mid_node(n[3 + k], n[3 + l])] = mesh_.mid_node(n[k], n[l]);
      }
    }
    return {behind.begin(), behind.end()};
  }

  /// Solvers stop at a node that follows others, and is held or follows more.
  void refuse_what_follows_twice() const {
    std::map<VertexIndex, std::string> follows;
    const auto follow = [&](VertexIndex v, const std::string& what) {
      if (const auto [at, is_new] = follows.try_emplace(v, what); !is_new) refuse_both(at->second, what);
    };
    for (const JobPlan::Coupling& c : plan_.couplings)
      for (const VertexIndex v : mesh_.nodes_of(mesh_.parts()[c.part]))
        if (c.is_rigid) follow(v, c.name);
    for (const JobPlan::Pretension& p : plan_.pretensions)
      for (const auto& [in_front, behind] : p.nodes) follow(in_front, "section of " + mesh_.parts()[p.region].name);
    for (const JobPlan::Fix& fix : plan_.fixes)
      for (const VertexIndex v : mesh_.nodes_of(mesh_.parts()[fix.part]))
        if (const auto at = follows.find(v); at != follows.end()) refuse_both(at->second, name_of(fix));
  }
  [[noreturn]] static void refuse_both(const std::string& a, const std::string& b) {
    throw OptionError(
        fmt::format("\"{}\" and \"{}\" share nodes, which would follow a point or section, and be held or "
                    "follow another: take faces that do not touch, or make the point distributing",
                    a, b));
  }

  void plan_gravity() {
    plan_.gravity = job_.gravity;
    for (std::size_t r = 0; r < regions().size(); ++r)
      if (const std::size_t m = plan_.material_of[r]; m == plan_.materials.size() || !plan_.materials[m].density)
        throw OptionError(fmt::format("`gravity`: the material of \"{}\" has no \"density\"", regions()[r].name));
  }

  void note_what_lacks() {
    const bool is_held = !plan_.fixes.empty() || std::ranges::any_of(plan_.couplings, [](const auto& c) {
      return c.holds[0] || c.holds[1] || c.holds[2];
    });
    if (!is_held) out_.note("the job holds nothing: say what is held, by `fix`, or it has no answer");
    if (!plan_.has_loads() && plan_.pretensions.empty())
      out_.note("the job has no loads: `load`, `pressure`, `gravity`, `pretension`");
  }

  void note_what_reactions_lack() {
    std::set<VertexIndex> tied;
    for (const JobPlan::Contact& c : plan_.contacts)
      for (const std::size_t side : {c.slave, c.master})
        if (!c.friction)
          for (const VertexIndex v : mesh_.nodes_of(mesh_.parts()[side])) tied.insert(v);
    for (const JobPlan::Fix& fix : plan_.fixes)
      if (std::ranges::any_of(mesh_.nodes_of(mesh_.parts()[fix.part]), [&](VertexIndex v) { return tied.contains(v); }))
        out_.note(
            fmt::format("some nodes of \"{}\" are tied to another part: CalculiX leaves what comes by the tie out "
                        "of their reactions; hold faces away from it where reactions matter",
                        name_of(fix)));
  }

  MeshOutput& out_;
  const MeshParts& mesh_;
  const SolverJob& job_;
  const std::vector<BoltSection>& sections_;
  JobPlaces places_;
  JobPlan plan_;
};

/// The sets that places need and the mesh lacks.
void add_sets(std::optional<TetMesh>& changed, const TetMesh& mesh, const SolverJob& job) {
  const MeshParts parts(mesh);
  const JobPlaces places(mesh, parts, job);
  std::vector<NamedSet> sets;
  places.for_each([&](const std::string& name, PlaceSet wanted) {
    const auto is_it = [&](const NamedSet& set) { return set.kind == wanted.kind && set.members == wanted.members; };
    if (!places.part(wanted) && std::ranges::none_of(sets, is_it))
      sets.push_back({name, wanted.kind, std::move(wanted.members)});
  });
  if (sets.empty()) return;
  if (!changed) changed = mesh;
  changed->sets.insert(changed->sets.end(), sets.begin(), sets.end());
}

}  // namespace

bool JobPlan::has_loads() const {
  return !loads.empty() || !pressures.empty() || gravity ||
         std::ranges::any_of(couplings, [](const Coupling& c) { return c.force.has_value(); });
}

Vec3 as_node_has_it(const JobPlan& plan, const MeshParts& mesh, VertexIndex node, Vec3 force) {
  const auto at = plan.systems.find(node);
  if (at == plan.systems.end()) return force;
  return in_system_of(*plan.fixes[at->second].cylinder, mesh.mesh().points[node], force);
}

void refuse_pressure_on_wedges(const MeshParts& mesh, const JobPlan& plan, std::string_view card) {
  if (!mesh.wide_cells().empty() && !plan.pressures.empty())
    throw OptionError(fmt::format(
        "`pressure`: {} is written on tetrahedra, not on the wedges of layers; give them up by `as_tets`", card));
}

bool JobPlan::slides() const {
  return std::ranges::any_of(contacts, [](const Contact& c) { return c.friction.has_value(); });
}

JobMesh mesh_for_job(const TetMesh& mesh, const SolverJob& job) {
  JobMesh made;
  for (const JobPretension& bolt : job.pretensions) {
    if (!made.changed) made.changed = mesh;
    const MeshParts parts(*made.changed);
    for (const std::uint32_t region : JobPlaces(*made.changed, parts, job).regions("pretension", bolt.region)) {
      made.sections.push_back(open_bolt(*made.changed, region, tied_patches(*made.changed, job)));
      made.sections.back().force = bolt.force;
    }
  }
  add_sets(made.changed, made.changed ? *made.changed : mesh, job);
  return made;
}

JobPlan plan_job(MeshOutput& out, const MeshParts& mesh, const SolverJob& job,
                 const std::vector<BoltSection>& sections) {
  return Planner(out, mesh, job, sections).plan();
}

}  // namespace octafront::io
