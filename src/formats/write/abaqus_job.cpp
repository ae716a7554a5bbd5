// A job for Abaqus and CalculiX, in words that both know. Bolts are drawn together in a step of their own, then kept as
// long as they are while the loads come.

#include "formats/write/job_writers.h"

#include <algorithm>

namespace octafront::io {
namespace {

class AbaqusJob {
 public:
  AbaqusJob(TextWriter& text, const MeshParts& mesh, const JobPlan& plan, const AbaqusNames& names)
      : text_(text), mesh_(mesh), plan_(plan), names_(names), next_node_(names.first_node) {}

  void write(bool has_sections) {
    write_materials(!has_sections);
    for (const JobPlan::Coupling& c : plan_.couplings) write_coupling(c);
    for (const JobPlan::Pretension& p : plan_.pretensions) write_pretension(p);
    write_contacts();
    write_fixes();
    if (!plan_.pretensions.empty()) write_step(true);
    if (plan_.pretensions.empty() || plan_.has_loads()) write_step(false);
  }

 private:
  struct Point {
    std::uint64_t node;
    std::string set;
  };

  const std::string& name(std::size_t part) const { return names_.parts[part]; }
  void write_vector(Vec3 v) {
    for (int i = 0; i < 3; ++i) (text_ << ", ").within(20, v[i]);
    text_ << '\n';
  }
  Point add_node(const std::string& wanted, Vec3 at) {
    Point point{next_node_++, names_.more(wanted)};
    text_.line("*NODE, NSET={}", point.set);
    text_ << point.node;
    write_vector(at);
    return point;
  }

  void write_materials(bool with_sections) {
    std::vector<std::string> legal;
    for (const JobMaterial& m : plan_.materials) {
      legal.push_back(names_.more(m.name));
      text_.line("*MATERIAL, NAME={}\n*ELASTIC", legal.back());
      text_.within(20, m.young) << ", ";
      text_.within(20, m.poisson) << '\n';
      if (m.density) (text_ << "*DENSITY\n").within(20, *m.density) << '\n';
    }
    const auto regions = mesh_.parts(Part::Origin::kRegion);
    for (std::size_t r = 0; with_sections && r < regions.size(); ++r)
      text_.line("*SOLID SECTION, ELSET={}, MATERIAL={}", name(r), legal[plan_.material_of[r]]);
  }

  void write_coupling(const JobPlan::Coupling& c) {
    points_.push_back(add_node(c.name, c.at));
    text_.line("*COUPLING, REF NODE={}, SURFACE={}, CONSTRAINT NAME={}", points_.back().node, name(c.part),
               names_.more(c.name + "_coupling"));
    text_ << (c.is_rigid ? "*KINEMATIC\n1, 3\n" : "*DISTRIBUTING\n1, 3\n");
  }

  /// What is in front of a section moves as what is behind, but for the shortening that the node stands for.
  void write_pretension(const JobPlan::Pretension& p) {
    bolts_.push_back(add_node(name(p.region) + "_pretension", p.middle));
    text_ << "*EQUATION\n";
    for (const auto& [in_front, behind] : p.nodes)
      for (int i = 0; i < 3; ++i) {
        text_.line("{}", p.axis[i] == 0 ? 2 : 3);
        text_ << in_front + 1 << ", " << i + 1 << ", 1., " << behind + 1 << ", " << i + 1 << ", -1.";
        if (p.axis[i] != 0) (text_ << ", " << bolts_.back().node << ", 1, ").within(20, p.axis[i]);
        text_ << '\n';
      }
  }

  void write_contacts() {
    for (const JobPlan::Contact& c : plan_.contacts) c.friction ? write_pair(c) : write_tie(c);
  }
  void write_tie(const JobPlan::Contact& c) {
    text_ << "*TIE, NAME=" << names_.more(name(c.slave) + "_tie") << ", ADJUST=NO, POSITION TOLERANCE=";
    text_.within(20, c.apart) << '\n';
    text_.line("{}, {}", name(c.slave), name(c.master));
  }
  /// Contact that gives way as a layer of a fifth of an element would.
  void write_pair(const JobPlan::Contact& c) {
    constexpr double kStiffer = 5, kOfSticking = 0.1;
    const std::string law = names_.more(name(c.slave) + "_law");
    const double stiffness = kStiffer * c.young / c.edge;
    text_.line("*SURFACE INTERACTION, NAME={}\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", law);
    text_.within(20, stiffness) << '\n';
    if (*c.friction > 0) {
      (text_ << "*FRICTION\n").within(20, *c.friction) << ", ";
      text_.within(20, kOfSticking * stiffness) << '\n';
    }
    text_.line("*CONTACT PAIR, INTERACTION={}, TYPE=SURFACE TO SURFACE\n{}, {}", law, name(c.slave), name(c.master));
  }

  void write_fixes() {
    for (const JobPlan::Fix& fix : plan_.fixes)
      if (fix.cylinder) {
        const Cylinder& c = *fix.cylinder;
        text_.line("*TRANSFORM, NSET={}, TYPE=C", name(fix.part));
        text_.within(20, c.middle.x) << ", ";
        text_.within(20, c.middle.y) << ", ";
        text_.within(20, c.middle.z);
        write_vector(c.middle + c.axis * c.radius);
      }
    for (const JobPlan::Fix& fix : plan_.fixes) write_fix(fix);
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (is_held(i)) text_ << "*BOUNDARY\n", write_held(points_[i].set, plan_.couplings[i].holds);
  }
  void write_fix(const JobPlan::Fix& fix) {
    text_ << "*BOUNDARY\n";
    if (fix.turned.empty()) return write_held(name(fix.part), fix.holds);
    auto turned = fix.turned.begin();
    for (const VertexIndex v : mesh_.nodes_of(mesh_.parts()[fix.part])) {
      const bool is_turned = turned != fix.turned.end() && turned->first == v;
      write_held(std::to_string(v + 1), is_turned ? turned++->second : fix.holds);
    }
  }
  /// Directions that follow each other are one line.
  void write_held(const std::string& what, std::span<const bool> holds) {
    for (std::size_t i = 0, end = 0; i < holds.size(); i = end + 1) {
      for (end = i; end < holds.size() && holds[end];) ++end;
      if (end > i) text_.line("{}, {}, {}", what, i + 1, end);
    }
  }
  bool is_held(std::size_t point) const {
    return std::ranges::any_of(plan_.couplings[point].holds, [](bool held) { return held; });
  }

  void write_step(bool of_bolts) {
    const bool slides = plan_.slides();
    text_ << (slides ? "*STEP, INC=200\n*STATIC\n1., 1., 1E-5, 1.\n" : "*STEP\n*STATIC\n");
    if (of_bolts)
      write_tightening();
    else
      write_loads();
    write_output();
    text_ << "*END STEP\n";
  }

  void write_tightening() {
    for (std::size_t i = 0; i < bolts_.size(); ++i) write_force(bolts_[i].node, {plan_.pretensions[i].force, 0, 0});
  }
  void write_force(std::uint64_t node, Vec3 force) {
    for (int i = 0; i < 3; ++i) {
      if (force[i] == 0) continue;
      text_ << "*CLOAD\n" << node << ", " << i + 1 << ", ";
      text_.within(20, force[i]) << '\n';
    }
  }

  void write_loads() {
    if (!bolts_.empty()) text_ << "*CLOAD, OP=NEW\n";
    for (const Point& bolt : bolts_) text_.line("*BOUNDARY, FIXED\n{}, 1, 1", bolt.node);
    write_forces();
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (plan_.couplings[i].force) write_force(points_[i].node, *plan_.couplings[i].force);
    for (const JobPlan::Pressure& p : plan_.pressures) {
      text_ << "*DSLOAD\n" << name(p.part) << ", P, ";
      text_.within(20, p.value) << '\n';
    }
    if (plan_.gravity) write_gravity(*plan_.gravity);
  }
  /// Each node once: solvers differ in what becomes of two.
  void write_forces() {
    for (const JobPlan::Load& load : plan_.loads)
      text_.line("** {:.9g}, {:.9g}, {:.9g} ON {}", load.force.x, load.force.y, load.force.z, name(load.part));
    if (!plan_.forces.empty()) text_ << "*CLOAD\n";
    for (const auto& [node, sum] : plan_.forces) {
      const Vec3 force = as_node_has_it(plan_, mesh_, node, sum);
      for (int i = 0; i < 3; ++i) {
        if (force[i] == 0) continue;
        text_ << node + 1 << ", " << i + 1 << ", ";
        text_.within(20, force[i]) << '\n';
      }
    }
  }
  void write_gravity(Vec3 g) {
    const Vec3 along = normalized(g);
    text_ << "*DLOAD\n";
    for (std::size_t r = 0; r < mesh_.parts(Part::Origin::kRegion).size(); ++r) {
      text_ << name(r) << ", GRAV, ";
      text_.within(20, length(g));
      write_vector(along);
    }
  }

  void write_output() {
    text_ << "*NODE FILE\nU, RF\n*EL FILE\nS, E\n";
    for (const JobPlan::Fix& fix : plan_.fixes) write_reaction(name(fix.part));
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (is_held(i)) write_reaction(points_[i].set);
    for (const Point& bolt : bolts_) text_.line("*NODE PRINT, NSET={}\nU", bolt.set);
  }
  void write_reaction(const std::string& set) { text_.line("*NODE PRINT, NSET={}, TOTALS=YES, GLOBAL=YES\nRF", set); }

  TextWriter& text_;
  const MeshParts& mesh_;
  const JobPlan& plan_;
  const AbaqusNames& names_;
  std::uint64_t next_node_;
  std::vector<Point> points_, bolts_;
};

}  // namespace

void write_abaqus_job(TextWriter& text, const MeshParts& mesh, const JobPlan& plan, const AbaqusNames& names,
                      bool has_sections) {
  AbaqusJob(text, mesh, plan, names).write(has_sections);
}

}  // namespace octafront::io
