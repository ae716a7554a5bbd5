// A job of linear statics for Nastran. Forces are in the basic system, supports in that of their nodes; rigid points
// are RBE2, distributing ones RBE3.

#include <octafront/error.h>

#include "base/geometry/frame.h"
#include "formats/parts/legal_names.h"
#include "formats/write/job_writers.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <type_traits>

namespace octafront::io {
namespace {

constexpr std::uint64_t kForces = 1, kGravity = 2, kBoth = 3, kSupports = 1;

/// The set of loads that is asked for.
std::uint64_t load_of(const JobPlan& plan) {
  const auto has_force = [](const JobPlan::Coupling& c) { return c.force.has_value(); };
  const bool has_forces =
      !plan.loads.empty() || !plan.pressures.empty() || std::ranges::any_of(plan.couplings, has_force);
  return !plan.gravity ? kForces : has_forces ? kBoth : kGravity;
}

class NastranJob {
 public:
  NastranJob(TextWriter& text, const MeshParts& mesh, const JobPlan& plan, std::uint64_t next_element)
      : text_(text), mesh_(mesh), plan_(plan), next_element_(next_element) {}

  void write() {
    write_materials();
    for (std::size_t f = 0; f < plan_.fixes.size(); ++f) {
      if (plan_.fixes[f].cylinder) write_system(f + 1, *plan_.fixes[f].cylinder);
      write_fix(plan_.fixes[f]);
    }
    for (std::size_t c = 0; c < plan_.couplings.size(); ++c) write_coupling(plan_.couplings[c], mesh_.points() + c + 1);
    for (const auto& [node, force] : plan_.forces) write_force(std::uint64_t{node} + 1, force);
    for (const JobPlan::Pressure& p : plan_.pressures) write_pressure(p);
    if (plan_.gravity) write_gravity(*plan_.gravity);
  }

 private:
  /// A card of fields of 16 characters: four of them in a line.
  template <class... Fields>
  void wide(std::string_view name, Fields... fields) {
    in_line_ = 0;
    text_ << name << std::string_view("*       ").substr(0, 8 - name.size());
    (wide_field(fields), ...);
    text_ << '\n';
  }
  template <class Field>
  void wide_field(Field field) {
    if (in_line_ > 0 && in_line_ % 4 == 0) text_ << "\n*       ";
    ++in_line_;
    if constexpr (std::is_same_v<Field, const char*>)
      text_ << std::string_view("                ").substr(std::string_view(field).size()) << field;
    else
      text_.field(16, field);
  }
  /// Numbers in fields of 8 characters, eight in a line, behind a card's first ones.
  void numbers(std::size_t field, std::span<const VertexIndex> nodes) {
    for (const VertexIndex v : nodes) {
      if (field++ % 8 == 0) text_ << "\n        ";
      text_.field(8, std::uint64_t{v} + 1);
    }
    text_ << '\n';
  }

  void write_materials() {
    const auto regions = mesh_.parts(Part::Origin::kRegion);
    for (std::size_t r = 0; r < regions.size(); ++r) {
      const JobMaterial& m = plan_.materials[plan_.material_of[r]];
      text_.line("$ {} IS {}", one_line(regions[r].name), one_line(m.name));
      const std::uint64_t id = regions[r].tag;
      m.density ? wide("MAT1", id, m.young, "", m.poisson, *m.density) : wide("MAT1", id, m.young, "", m.poisson);
    }
  }

  void write_system(std::uint64_t number, const Cylinder& c) {
    const Vec3 top = c.middle + c.axis, side = c.middle + frame_at(c.middle, c.axis).u;
    wide("CORD2C", number, "", c.middle.x, c.middle.y, c.middle.z, top.x, top.y, top.z, side.x, side.y, side.z);
  }

  static std::string components(std::span<const bool> holds) {
    std::string all;
    for (std::size_t i = 0; i < holds.size(); ++i)
      if (holds[i]) all += static_cast<char>('1' + i);
    return all;
  }
  void write_held(const std::string& components, std::span<const VertexIndex> nodes) {
    if (components.empty() || nodes.empty()) return;
    (text_ << "SPC1    ").field(8, kSupports) << std::string_view("        ").substr(components.size()) << components;
    numbers(2, nodes);
  }
  void write_fix(const JobPlan::Fix& fix) {
    std::vector<VertexIndex> nodes = mesh_.nodes_of(mesh_.parts()[fix.part]);
    for (const auto& [node, holds] : fix.turned) {
      nodes.erase(std::ranges::lower_bound(nodes, node));
      write_held(components(holds), std::array{node});
    }
    write_held(components(fix.holds), nodes);
  }

  void write_coupling(const JobPlan::Coupling& c, std::uint64_t node) {
    text_.line("$ {} IS GRID {}", one_line(c.name), node);
    wide("GRID", node, "", c.at.x, c.at.y, c.at.z);
    (text_ << (c.is_rigid ? "RBE2    " : "RBE3    ")).field(8, next_element_++);
    if (!c.is_rigid) text_ << "        ";
    text_.field(8, node) << (c.is_rigid ? "     123" : "  123456      1.     123");
    numbers(c.is_rigid ? 3 : 6, mesh_.nodes_of(mesh_.parts()[c.part]));
    write_held(components(c.holds), std::array{static_cast<VertexIndex>(node - 1)});
    if (c.force) write_force(node, *c.force);
  }

  void write_force(std::uint64_t node, Vec3 f) { wide("FORCE", kForces, node, "", 1.0, f.x, f.y, f.z); }
  void write_gravity(Vec3 g) {
    wide("GRAV", kGravity, "", 1.0, g.x, g.y, g.z);
    if (load_of(plan_) == kBoth) wide("LOAD", kBoth, 1.0, 1.0, kForces, 1.0, kGravity);
  }
  /// A corner of the face, and the one opposite to it.
  void write_pressure(const JobPlan::Pressure& p) {
    for (const std::uint32_t f : mesh_.parts()[p.part].members) {
      const Side& side = mesh_.sides()[f];
      const Tet& tet = mesh_.mesh().tets[side.tet];
      const std::uint64_t element = side.tet + 1, on = mesh_.face(f)[0] + 1,
                          off = tet[static_cast<std::size_t>(side.face)] + 1;
      wide("PLOAD4", kForces, element, p.value, "", "", "", on, off);
    }
  }

  TextWriter& text_;
  const MeshParts& mesh_;
  const JobPlan& plan_;
  std::uint64_t next_element_;
  int in_line_ = 0;
};

}  // namespace

void write_nastran_control(TextWriter& text, const MeshParts& mesh, const JobPlan& plan) {
  if (!plan.contacts.empty() || !plan.pretensions.empty())
    throw OptionError("Nastrans differ in contacts and bolts, so a job for them has none: let parts share their nodes");
  refuse_pressure_on_wedges(mesh, plan, "PLOAD4");
  text << "SOL 101\nCEND\nTITLE = JOB BY OCTAFRONT\n";
  text.line("SPC = {}", kSupports);
  if (plan.has_loads()) text.line("LOAD = {}", load_of(plan));
  text << "DISPLACEMENT = ALL\nSPCFORCES = ALL\nSTRESS = ALL\n";
}

void write_nastran_job(TextWriter& text, const MeshParts& mesh, const JobPlan& plan, std::uint64_t next_element) {
  NastranJob(text, mesh, plan, next_element).write();
}

std::uint64_t nastran_system_of(const JobPlan& plan, VertexIndex node) {
  const auto at = plan.systems.find(node);
  return at == plan.systems.end() ? 0 : at->second + 1;
}

}  // namespace octafront::io
