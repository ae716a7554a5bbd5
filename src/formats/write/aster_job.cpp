// Linear statics in commands of code_aster (U4): reference points are elements of one node without stiffness, which
// LIAISON_SOLIDE or LIAISON_RBE3 leads to faces; opened contacts are tied by LIAISON_MAIL, whose masters are solids. No
// node may be held twice, for its equations would be singular: groups of nodes leave out what others hold.

#include <octafront/error.h>

#include "base/core/elementary.h"
#include "formats/write/job_writers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <set>
#include <span>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using AsterList = std::vector<std::string>;

/// As Python has it, with a point or an exponent.
std::string real_in_python(double value) {
  const std::string text = fmt::format("{:.15g}", value);
  return text.find_first_of(".e") == text.npos ? text + ".0" : text;
}

std::string tuple_of(const AsterList& names) {
  std::string all;
  for (const std::string& name : names) all += fmt::format("'{}', ", name);
  return "(" + all + ")";
}

/// ", DX=0.0, DZ=0.0" of what is held.
std::string zeros(std::span<const bool> holds) {
  constexpr std::array kNames{"DX", "DY", "DZ", "DRX", "DRY", "DRZ"};
  std::string all;
  for (std::size_t i = 0; i < holds.size(); ++i)
    if (holds[i]) all += fmt::format(", {}=0.0", kNames[i]);
  return all;
}

/// ", FX=1.0" of a vector; nothing of what is 0.
std::string forces(Vec3 v) {
  std::string all;
  for (int i = 0; i < 3; ++i)
    if (v[i] != 0) all += fmt::format(", F{}={}", "XYZ"[i], real_in_python(v[i]));
  return all;
}

bool holds_all(const JobPlan::Fix& fix) {
  return fix.holds[0] && fix.holds[1] && fix.holds[2];
}

/// The global axis that a cylinder has; 3: none.
std::size_t global_axis(const Cylinder& c) {
  constexpr double kParallel = 0.999999;
  std::size_t k = 0;
  while (k < 3 && !(std::abs(c.axis[static_cast<int>(k)]) > kParallel)) ++k;
  return k;
}

class AsterJob {
 public:
  AsterJob(MeshOutput& out, const MeshParts& mesh, const JobPlan& plan, const AsterNames& names)
      : text_(out.sibling(".comm")), mesh_(mesh), plan_(plan), names_(names) {
    for (const AsterNames::Point& point : names.points) points_.push_back(point.name);
  }

  void write() {
    text_ << "# Job by octafront; the .export beside says which file is which\nDEBUT()\n";
    for (const JobPlan::Fix& fix : plan_.fixes) plan_fix(fix);
    for (const JobPlan::Contact& c : plan_.contacts) plan_tie(c);
    plan_points();
    write_mesh();
    write_model();
    write_materials();
    write_loads();
    write_result();
    text_ << "FIN()\n";
  }

 private:
  const std::string& name(std::size_t part) const { return names_.parts[part]; }
  const Part& part(std::size_t number) const { return mesh_.parts()[number]; }

  struct Keyword {
    std::string_view name;
    AsterList entries;
  };
  /// name = COMMAND(said, KEYWORD=(_F(...), ...)) of keywords that have entries.
  void command(std::string_view head, std::string_view said, std::initializer_list<Keyword> keywords) {
    text_.line("{}(\n    {}", head, said);
    for (const auto& [name, entries] : keywords) {
      if (entries.empty()) continue;
      text_.line("    {}=(", name);
      for (const std::string& entry : entries) text_.line("        _F({}),", entry);
      text_ << "    ),\n";
    }
    text_ << ")\n";
  }
  AsterList regions() const {
    return {names_.parts.begin(), names_.parts.begin() + static_cast<std::ptrdiff_t>(plan_.material_of.size())};
  }
  /// The group of nodes of a part.
  const std::string& nodes(std::size_t p) {
    if (part(p).kind != NamedSet::Kind::kNodes) of_nodes_.insert(p);
    return name(p);
  }
  /// GROUP_MA or GROUP_NO of a part.
  std::string group(std::size_t p) const {
    return fmt::format("GROUP_{}='{}'", part(p).kind == NamedSet::Kind::kNodes ? "NO" : "MA", name(p));
  }
  bool share_nodes(std::size_t a, std::size_t b) const {
    const auto of_a = mesh_.nodes_of(part(a)), of_b = mesh_.nodes_of(part(b));
    return std::ranges::any_of(of_a, [&](VertexIndex v) { return std::ranges::binary_search(of_b, v); });
  }

  void plan_fix(const JobPlan::Fix& fix) {
    if (!fix.cylinder || holds_all(fix)) {
      held_.push_back(group(fix.part) + zeros(fix.holds));
      return;
    }
    const auto [radial, tangential, axial] = fix.holds;
    if (tangential && !radial)
      throw OptionError(
          fmt::format("`fix`: code_aster has no tangential direction of faces; hold \"{}\" also in radial direction",
                      part(fix.part).name));
    const std::string all = group(fix.part) + without(fix);
    if (radial && !tangential) normal_.push_back(all + ", DNOR=0.0");
    const std::size_t axis = global_axis(*fix.cylinder);
    std::array<bool, 3> holds{axial, tangential, tangential};
    if (axis < 3) holds = {tangential, tangential, tangential}, holds[axis] = axial;
    if (!axial && !tangential) return;
    axis < 3 ? held_.push_back(all + zeros(holds))
             : oblique_.push_back(all + angles(fix.cylinder->axis) + zeros(holds));
  }
  /// ", SANS_GROUP_NO=('ground', )": nodes that another holds in all directions.
  std::string without(const JobPlan::Fix& fix) {
    AsterList others;
    for (const JobPlan::Fix& other : plan_.fixes) {
      if (&other == &fix || !share_nodes(fix.part, other.part)) continue;
      if (!holds_all(other))
        throw OptionError(
            fmt::format("`fix`: \"{}\" and \"{}\" share nodes, whose equations code_aster would have twice; hold one "
                        "of them in all directions, or faces that do not touch",
                        part(fix.part).name, part(other.part).name));
      others.push_back(nodes(other.part));
    }
    return others.empty() ? "" : ", SANS_GROUP_NO=" + tuple_of(others);
  }
  /// Nautical angles of a system whose x is the axis.
  static std::string angles(Vec3 axis) {
    constexpr double kDegrees = 180 / std::numbers::pi;
    return fmt::format(", ANGL_NAUT=({}, {}, 0.0)", real_in_python(kDegrees * elementary::atan2(axis.y, axis.x)),
                       real_in_python(kDegrees * elementary::atan2(-axis.z, elementary::hypot(axis.x, axis.y))));
  }

  void plan_tie(const JobPlan::Contact& c) {
    const std::uint32_t slave = region_at(c.slave), master = region_at(c.master);
    if (slave == master)
      throw OptionError(
          fmt::format("`friction`: code_aster ties faces to another part, and \"{}\" is a crack", part(c.slave).name));
    AsterList others;
    for (const JobPlan::Fix& fix : plan_.fixes)
      if (share_nodes(c.slave, fix.part)) others.push_back(nodes(fix.part));
    for (const JobPlan::Coupling& coupling : plan_.couplings)
      if (coupling.is_rigid && share_nodes(c.slave, coupling.part)) others.push_back(nodes(coupling.part));
    std::string tied = nodes(c.slave);
    if (!others.empty()) {
      others.insert(others.begin(), tied);
      tied = names_.ties[tied_.size()];
      differences_.push_back(fmt::format("NOM='{}', DIFFE={}", tied, tuple_of(others)));
    }
    const auto regions = mesh_.parts(Part::Origin::kRegion);
    const auto at = static_cast<std::size_t>(std::ranges::find(regions, master, &Part::number) - regions.begin());
    tied_.push_back(fmt::format("GROUP_MA_MAIT='{}', GROUP_NO_ESCL='{}', DISTANCE_MAX={}", name(at), tied,
                                real_in_python(c.apart)));
  }
  std::uint32_t region_at(std::size_t p) const { return mesh_.region_of(mesh_.sides()[part(p).members[0]].tet); }

  void plan_points() {
    for (std::size_t c = 0; c < points_.size(); ++c) {
      const JobPlan::Coupling& coupling = plan_.couplings[c];
      const std::string& faces = nodes(coupling.part);
      if (coupling.is_rigid)
        rigid_.push_back("GROUP_NO=" + tuple_of({faces, points_[c]}));
      else
        averaged_.push_back(
            fmt::format("GROUP_NO_MAIT='{}', DDL_MAIT=('DX', 'DY', 'DZ', 'DRX', 'DRY', 'DRZ'), GROUP_NO_ESCL='{}', "
                        "DDL_ESCL='DX-DY-DZ', COEF_ESCL=1.0",
                        points_[c], faces));
      if (const std::string held = zeros(coupling.holds); !held.empty())
        held_.push_back(fmt::format("GROUP_NO='{}'", points_[c]) + held), held_points_.push_back(points_[c]);
    }
  }

  void write_mesh() {
    text_.line("{} = LIRE_MAILLAGE(FORMAT='MED', UNITE=20)", points_.empty() ? "mesh" : "read");
    AsterList elements, groups;
    for (const std::string& point : points_)
      elements.push_back(fmt::format("NOM_GROUP_MA='{0}', GROUP_NO='{0}'", point));
    if (!points_.empty()) command("mesh = CREA_MAILLAGE", "MAILLAGE=read,", {{"CREA_POI1", elements}});
    for (const JobPlan::Fix& fix : plan_.fixes) nodes(fix.part);
    for (const std::size_t p : of_nodes_) groups.push_back(name(p));
    if (!groups.empty())
      text_.line("mesh = DEFI_GROUP(reuse=mesh, MAILLAGE=mesh, CREA_GROUP_NO=_F(GROUP_MA={}))", tuple_of(groups));
    if (!differences_.empty())
      command("mesh = DEFI_GROUP", "reuse=mesh, MAILLAGE=mesh,", {{"CREA_GROUP_NO", differences_}});
  }

  void write_model() {
    AsterList models{"TOUT='OUI', PHENOMENE='MECANIQUE', MODELISATION='3D'"}, discrete;
    for (const std::string& point : points_) {
      models.push_back(fmt::format("GROUP_MA='{}', PHENOMENE='MECANIQUE', MODELISATION='DIS_TR'", point));
      discrete.push_back(fmt::format("GROUP_MA='{}', CARA='K_TR_D_N', VALE=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)", point));
    }
    command("model = AFFE_MODELE", "MAILLAGE=mesh,", {{"AFFE", models}});
    if (!points_.empty()) command("points = AFFE_CARA_ELEM", "MODELE=model,", {{"DISCRET", discrete}});
  }

  void write_materials() {
    for (std::size_t m = 0; m < plan_.materials.size(); ++m) {
      const JobMaterial& material = plan_.materials[m];
      text_.line("mater{} = DEFI_MATERIAU(ELAS=_F(E={}, NU={}{}))  # {}", m + 1, real_in_python(material.young),
                 real_in_python(material.poisson), material.density ? ", RHO=" + real_in_python(*material.density) : "",
                 one_line(material.name));
    }
    AsterList entries;
    for (std::size_t r = 0; r < plan_.material_of.size(); ++r)
      entries.push_back(fmt::format("{}, MATER=mater{}", group(r), plan_.material_of[r] + 1));
    command("matter = AFFE_MATERIAU", "MAILLAGE=mesh,", {{"AFFE", entries}});
  }

  /// Of two loads of one kind on a face the second would count alone: each is a charge.
  void write_loads() {
    if (!held_.empty() || !normal_.empty() || !oblique_.empty() || !rigid_.empty() || !averaged_.empty() ||
        !tied_.empty())
      write_charge({{"DDL_IMPO", held_},
                    {"FACE_IMPO", normal_},
                    {"LIAISON_OBLIQUE", oblique_},
                    {"LIAISON_SOLIDE", rigid_},
                    {"LIAISON_RBE3", averaged_},
                    {"LIAISON_MAIL", tied_}});
    for (const JobPlan::Load& load : plan_.loads)
      if (const std::string all = forces(load.force / area_of(mesh_, part(load.part))); !all.empty())
        write_charge({{"FORCE_FACE", {group(load.part) + all}}});
    for (std::size_t c = 0; c < points_.size(); ++c)
      if (const std::string all = forces(plan_.couplings[c].force.value_or(Vec3{})); !all.empty())
        write_charge({{"FORCE_NODALE", {fmt::format("GROUP_NO='{}'{}", points_[c], all)}}});
    for (const JobPlan::Pressure& p : plan_.pressures)
      write_charge({{"PRES_REP", {fmt::format("{}, PRES={}", group(p.part), real_in_python(p.value))}}});
    if (!plan_.gravity || squared_length(*plan_.gravity) == 0) return;
    const Vec3 along = normalized(*plan_.gravity);
    write_charge({{"PESANTEUR",
                   {fmt::format("GRAVITE={}, DIRECTION=({}, {}, {}), GROUP_MA={}",
                                real_in_python(length(*plan_.gravity)), real_in_python(along.x),
                                real_in_python(along.y), real_in_python(along.z), tuple_of(regions()))}}});
  }
  void write_charge(std::initializer_list<Keyword> keywords) {
    command(fmt::format("load{} = AFFE_CHAR_MECA", ++charges_), "MODELE=model,", keywords);
  }

  void write_result() {
    AsterList entries;
    for (std::size_t c = 1; c <= charges_; ++c) entries.push_back(fmt::format("CHARGE=load{}", c));
    command("result = MECA_STATIQUE",
            fmt::format("MODELE=model, CHAM_MATER=matter,{}", points_.empty() ? "" : " CARA_ELEM=points,"),
            {{"EXCIT", entries}});
    text_.line(
        "result = CALC_CHAMP(reuse=result, RESULTAT=result, GROUP_MA={}, CONTRAINTE='SIEF_NOEU', "
        "CRITERES='SIEQ_NOEU')\nresult = CALC_CHAMP(reuse=result, RESULTAT=result, FORCE='REAC_NODA')",
        tuple_of(regions()));
    write_reactions();
    text_ << "IMPR_RESU(FORMAT='MED', UNITE=80, RESU=_F(RESULTAT=result))\n";
  }
  void write_reactions() {
    AsterList groups = held_points_, entries;
    for (const JobPlan::Fix& fix : plan_.fixes) groups.push_back(name(fix.part));
    for (const std::string& held : groups)
      entries.push_back(
          fmt::format("OPERATION='EXTRACTION', INTITULE='{0}', RESULTAT=result, NOM_CHAM='REAC_NODA', GROUP_NO='{0}', "
                      "RESULTANTE=('DX', 'DY', 'DZ')",
                      held));
    if (entries.empty()) return;
    command("reacts = POST_RELEVE_T", "INFO=1,", {{"ACTION", entries}});
    text_ << "IMPR_TABLE(TABLE=reacts, UNITE=8)\n";
  }

  TextWriter text_;
  const MeshParts& mesh_;
  const JobPlan& plan_;
  const AsterNames& names_;
  std::set<std::size_t> of_nodes_;  ///< parts that need a group of nodes
  AsterList points_, held_points_, differences_, held_, normal_, oblique_, rigid_, averaged_, tied_;
  std::size_t charges_ = 0;
};

/// Which file is which, for run_aster and as_run.
void write_export(MeshOutput& out) {
  TextWriter text(out.sibling(".export"));
  const std::string stem = out.target().stem().string();
  text << "P actions make_etude\nP memory_limit 4096\nP time_limit 86400\nP ncpus 1\n";
  text.line("F comm {0}.comm D 1\nF mmed {1} D 20\nF mess {0}.mess R 6\nF resu {0}.resu R 8\nF rmed {0}.rmed R 80",
            stem, out.target().filename().string());
}

}  // namespace

AsterNames aster_names(MeshOutput& out, const MeshParts& mesh, const JobPlan& plan) {
  constexpr std::size_t kLongestName = 24;
  LegalNames legal({.longest = kLongestName, .also = "_", .ignores_case = false});
  AsterNames names;
  for (const Part& part : mesh.parts()) names.parts.push_back(legal.legal(part.name));
  for (const JobPlan::Coupling& c : plan.couplings) names.points.push_back({legal.legal(c.name), c.at});
  out.note(legal.note());
  for (std::size_t c = 0; c < plan.contacts.size(); ++c)
    names.ties.push_back(legal.legal(fmt::format("tied_{}", c + 1)));
  return names;
}

void write_aster_job(MeshOutput& out, const MeshParts& mesh, const JobPlan& plan, const AsterNames& names) {
  if (!plan.pretensions.empty())
    throw OptionError("`pretension`: a job for code_aster has no bolts; write Abaqus or Ansys");
  if (plan.slides())
    throw OptionError("`friction`: a job for code_aster is linear, and ties contacts; write Abaqus or Ansys");
  AsterJob(out, mesh, plan, names).write();
  write_export(out);
}

}  // namespace octafront::io
