// A static analysis in commands of Mechanical APDL. Contacts are pairs of TARGE170 and CONTA174, reference points are
// MASS21 without mass that CERIG or RBE3 leads to faces, sections of bolts constraint equations, whose sign needs no
// normal of a section as that of PRETS179 does.

#include "base/geometry/frame.h"
#include "formats/write/job_writers.h"

#include <algorithm>
#include <array>
#include <span>

namespace octafront::io {
namespace {

/// Numbers of element types, real constants and coordinate systems: those of the mesh are 1 and 2; each contact has a
/// type more for its target.
constexpr std::size_t kPointType = 3, kBoltType = 4, kFirstPairType = 11, kMassReals = 2, kFirstPairReals = 11,
                      kFirstSystem = 11;

/// The face opposite to a corner.
constexpr std::array<int, 4> kFaceOpposite{3, 4, 2, 1};

class AnsysJob {
 public:
  AnsysJob(TextWriter& text, const MeshParts& mesh, const MixedCells& cells, const JobPlan& plan,
           const std::vector<std::string>& names)
      : text_(text), mesh_(mesh), cells_(cells), plan_(plan), names_(names) {}

  void write() {
    write_materials();
    write_points();
    for (std::size_t c = 0; c < plan_.contacts.size(); ++c) write_contact(plan_.contacts[c], c);
    for (std::size_t f = 0; f < plan_.fixes.size(); ++f)
      if (plan_.fixes[f].cylinder) write_system(*plan_.fixes[f].cylinder, f);
    for (const JobPlan::Fix& fix : plan_.fixes) write_fix(fix);
    for (std::size_t c = 0; c < points_.size(); ++c) write_held(std::to_string(points_[c]), plan_.couplings[c].holds);
    text_ << "FINISH\n/SOLU\nANTYPE,STATIC\n";
    if (plan_.slides()) text_ << "AUTOTS,ON\nNSUBST,4,200,4\n";
    if (!plan_.pretensions.empty()) write_tightening();
    if (plan_.pretensions.empty() || plan_.has_loads()) write_loads();
    write_reactions();
  }

 private:
  const std::string& name(std::size_t part) const { return names_[part]; }
  void write_vector(Vec3 v) {
    for (int i = 0; i < 3; ++i) (text_ << ',').within(20, v[i]);
    text_ << '\n';
  }
  std::uint64_t add_node(Vec3 at) {
    text_ << "N," << ++last_node_;
    write_vector(at);
    return last_node_;
  }
  void write_point(std::uint64_t node) { text_.line("EN,{},{}", ++last_element_, node); }

  void write_materials() {
    const auto regions = mesh_.parts(Part::Origin::kRegion);
    for (std::size_t r = 0; r < regions.size(); ++r) {
      const JobMaterial& m = plan_.materials[plan_.material_of[r]];
      text_.line("/COM,{} IS {}", name(r), one_line(m.name));
      const std::uint32_t id = regions[r].number + 1;
      constant("EX", id, m.young), constant("PRXY", id, m.poisson);
      if (m.density) constant("DENS", id, *m.density);
      next_material_ = std::max(next_material_, id + 1);
    }
  }
  void constant(const char* what, std::uint32_t material, double value) {
    (text_ << "MP," << what << ',' << material << ',').within(20, value) << '\n';
  }

  void write_points() {
    if (!plan_.couplings.empty()) text_.line("ET,{},21\nR,{},0,0,0,0,0,0", kPointType, kMassReals);
    for (const JobPlan::Coupling& c : plan_.couplings) {
      text_.line("/COM,POINT {}\nTYPE,{}\nREAL,{}", one_line(c.name), kPointType, kMassReals);
      points_.push_back(add_node(c.at));
      write_point(points_.back());
      text_.line("CMSEL,S,{}", name(c.part));
      c.is_rigid ? text_.line("CERIG,{},ALL,UXYZ", points_.back()) : text_.line("RBE3,{},ALL,ALL", points_.back());
      text_ << "ALLSEL\n";
    }
    if (!plan_.pretensions.empty()) text_.line("ET,{},21,,,2\nR,{},0", kBoltType, kMassReals + 1);
    for (const JobPlan::Pretension& p : plan_.pretensions) write_section(p);
  }
  /// What is in front of a section moves as what is behind, but for the shortening that the node stands for.
  void write_section(const JobPlan::Pretension& p) {
    text_.line("/COM,PRETENSION OF {}\nTYPE,{}\nREAL,{}", name(p.region), kBoltType, kMassReals + 1);
    bolts_.push_back(add_node(p.middle));
    write_point(bolts_.back());
    text_.line("D,{},UY,0,,,,UZ", bolts_.back());
    for (const auto& [in_front, behind] : p.nodes)
      for (int i = 0; i < 3; ++i) {
        const char axis = "XYZ"[i];
        text_ << "CE,NEXT,0," << in_front + 1 << ",U" << axis << ",1," << behind + 1 << ",U" << axis << ",-1";
        if (p.axis[i] != 0) (text_ << ',' << bolts_.back() << ",UX,").within(20, p.axis[i]);
        text_ << '\n';
      }
  }

  /// Gaps of chords count for none. Stiffness is Ansys's own, of bonds ten times that.
  void write_contact(const JobPlan::Contact& c, std::size_t number) {
    const std::size_t target = kFirstPairType + 2 * number, contact = target + 1, reals = kFirstPairReals + number;
    text_.line("/COM,{} ON {}", name(c.slave), name(c.master));
    text_.line("ET,{},170\nET,{},174\nKEYOPT,{},9,1", target, contact, contact);
    text_ << "R," << reals;
    if (c.friction) {
      text_ << '\n';
      constant("MU", next_material_, *c.friction);
    } else {
      (text_ << ",,,10,,0,").within(20, -c.apart) << '\n';
      text_.line("KEYOPT,{},12,5", contact);
    }
    text_.line("REAL,{}\nMAT,{}", reals, next_material_++);
    text_.line("TYPE,{}", contact);
    write_side(c.slave, true);
    text_.line("TYPE,{}", target);
    write_side(c.master, false);
  }
  /// Triangles of contact elements are quadrilaterals whose third and fourth corners are one; targets have a shape.
  void write_side(std::size_t part, bool of_contact) {
    FaceRoom room;
    std::size_t shape = 0;
    for (const std::uint32_t f : cells_.members(mesh_.parts()[part])) {
      const auto n = cells_.face_nodes(f, room);
      if (!of_contact && n.size() != shape)
        text_.line("TSHAP,{}", n.size() == 3 ? "TRIA" : n.size() == 6 ? "TRI6" : n.size() == 4 ? "QUAD" : "QUA8");
      shape = n.size();
      text_ << "EN," << ++last_element_;
      for (std::size_t k = 0; k < n.size(); ++k) {
        text_ << ',' << n[k] + 1;
        const bool is_twice = of_contact && n.size() % 4 != 0 && (k == 2 || k == 4);
        if (is_twice) text_ << ',' << n[2] + 1;
      }
      text_ << '\n';
    }
  }

  void write_system(const Cylinder& c, std::size_t number) {
    const Frame frame = frame_at(c.middle, c.axis);
    std::size_t key = 3 * number;
    for (const Vec3 at : {c.middle, c.middle + frame.u * c.radius, c.middle + frame.v * c.radius}) {
      text_ << "K," << ++key;
      write_vector(at);
    }
    text_.line("CSKP,{},1,{},{},{}\nNROTAT,{}\nCSYS,0", kFirstSystem + number, key - 2, key - 1, key,
               name(plan_.fixes[number].part));
  }
  void write_fix(const JobPlan::Fix& fix) {
    const Part& part = mesh_.parts()[fix.part];
    if (fix.turned.empty() && part.kind != NamedSet::Kind::kElements) return write_held(name(fix.part), fix.holds);
    auto turned = fix.turned.begin();
    for (const VertexIndex v : mesh_.nodes_of(part)) {
      const bool is_turned = turned != fix.turned.end() && turned->first == v;
      write_held(std::to_string(v + 1), is_turned ? turned++->second : fix.holds);
    }
  }
  /// Labels behind the first one stand five fields later.
  void write_held(const std::string& what, std::span<const bool> holds) {
    constexpr std::array kLabels{"UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"};
    bool is_first = true;
    for (std::size_t i = 0; i < holds.size(); ++i) {
      if (!holds[i]) continue;
      text_ << (is_first ? "D," + what + "," + kLabels[i] + ",0,,," : std::string(",") + kLabels[i]);
      is_first = false;
    }
    if (!is_first) text_ << '\n';
  }

  void solve() { text_.line("TIME,{}\nSOLVE", ++step_); }
  void write_tightening() {
    for (std::size_t i = 0; i < bolts_.size(); ++i) write_force(bolts_[i], {plan_.pretensions[i].force, 0, 0});
    solve();
  }
  void write_force(std::uint64_t node, Vec3 force) {
    for (int i = 0; i < 3; ++i)
      if (force[i] != 0)
        (text_ << "F," << node << ",F"
               << "XYZ"[i] << ',')
                .within(20, force[i])
            << '\n';
  }
  /// Bolts stay as long as they are.
  void write_loads() {
    for (const std::uint64_t bolt : bolts_) text_.line("D,{},UX,%_FIX%\nFDELE,{},FX", bolt, bolt);
    for (const auto& [node, force] : plan_.forces)
      write_force(std::uint64_t{node} + 1, as_node_has_it(plan_, mesh_, node, force));
    for (std::size_t c = 0; c < points_.size(); ++c)
      if (plan_.couplings[c].force) write_force(points_[c], *plan_.couplings[c].force);
    for (const JobPlan::Pressure& p : plan_.pressures) write_pressure(p);
    if (plan_.gravity) {  // Ansys asks for the acceleration of what things stand on
      text_ << "ACEL";
      write_vector(*plan_.gravity * -1.0);
    }
    solve();
  }
  void write_pressure(const JobPlan::Pressure& p) {
    for (const std::uint32_t f : mesh_.parts()[p.part].members) {
      const auto& [tet, face] = mesh_.sides()[f];
      (text_ << "SFE," << tet + 1 << ',' << kFaceOpposite[static_cast<std::size_t>(face)] << ",PRES,,")
              .within(20, p.value)
          << '\n';
    }
  }

  void write_reactions() {
    text_ << "FINISH\n/POST1\nSET,LAST\n";
    for (const JobPlan::Fix& fix : plan_.fixes) {
      text_.line("/COM,REACTIONS OF {}\nCMSEL,S,{}", name(fix.part), name(fix.part));
      if (mesh_.parts()[fix.part].kind == NamedSet::Kind::kElements) text_ << "NSLE,S\n";
      text_ << "PRRSOL,F\nALLSEL\n";
    }
    for (std::size_t c = 0; c < points_.size(); ++c)
      text_.line("/COM,POINT {}\nNSEL,S,NODE,,{}\nPRNSOL,U\nPRRSOL\nALLSEL", one_line(plan_.couplings[c].name),
                 points_[c]);
    for (const std::uint64_t bolt : bolts_) text_.line("NSEL,S,NODE,,{}\nPRNSOL,U\nPRRSOL\nALLSEL", bolt);
  }

  TextWriter& text_;
  const MeshParts& mesh_;
  const MixedCells& cells_;
  const JobPlan& plan_;
  const std::vector<std::string>& names_;
  std::uint64_t last_node_ = mesh_.points(), last_element_ = cells_.cells();
  std::uint32_t next_material_ = 1;
  std::vector<std::uint64_t> points_, bolts_;
  int step_ = 0;
};

}  // namespace

void write_ansys_job(TextWriter& text, const MeshParts& mesh, const MixedCells& cells, const JobPlan& plan,
                     const std::vector<std::string>& names) {
  refuse_pressure_on_wedges(mesh, plan, "SFE");
  AnsysJob(text, mesh, cells, plan, names).write();
}

}  // namespace octafront::io
