#include <octafront/adapt.h>
#include <octafront/carry.h>
#include <octafront/level_set.h>
#include <octafront/move.h>
#include <octafront/report.h>

#include <nlohmann/json.hpp>

namespace octafront {

namespace {

using Json = nlohmann::ordered_json;

Json place(Vec3 p) {
  return {p.x, p.y, p.z};
}

Json json_of_kind(const SurfaceDefects::Kind& kind) {
  Json first = Json::array();
  for (const SurfaceDefects::Place& p : kind.first) first.push_back({{"at", place(p.at)}, {"faces", p.faces}});
  return {{"count", kind.count}, {"first", first}};
}

}  // namespace

std::string to_json(const SurfaceDefects& d) {
  return Json{{"open_edges", json_of_kind(d.open_edges)},
              {"open_loops", d.open_loops},
              {"non_manifold_edges", json_of_kind(d.non_manifold_edges)},
              {"misoriented_edges", json_of_kind(d.misoriented_edges)},
              {"non_manifold_vertices", json_of_kind(d.non_manifold_vertices)},
              {"self_intersections", json_of_kind(d.self_intersections)},
              {"degenerate_faces", json_of_kind(d.degenerate_faces)},
              {"region_conflicts", json_of_kind(d.region_conflicts)},
              {"misplaced_parts", json_of_kind(d.misplaced_parts)}}
      .dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string to_json(const JacobianSummary& found) {
  Json first = Json::array();
  for (const InvalidElement& e : found.first)
    first.push_back({{"number", e.tet}, {"at", place(e.at)}, {"scaled_jacobian", e.scaled_jacobian}});
  return Json{{"least_scaled_jacobian", found.least_scaled_jacobian},
              {"least_tet", found.least_tet},
              {"invalid", found.invalid},
              {"first", first}}
      .dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string to_json(const MetricSummary& fit) {
  return Json{{"edges", fit.edges},
              {"fitting", fit.fitting},
              {"shortest", fit.shortest},
              {"longest", fit.longest},
              {"quality_min", fit.quality_min},
              {"quality_min_at", place(fit.quality_min_at)},
              {"quality_mean", fit.quality_mean},
              {"far", fit.far},
              {"shortest_at", place(fit.shortest_at)},
              {"longest_at", place(fit.longest_at)},
              {"complexity", fit.complexity}}
      .dump();
}

std::string to_json(const WallDeviation& d) {
  return Json{{"bound", d.bound}, {"lower", d.lower}, {"upper", d.upper}, {"at", place(d.place)}}.dump();
}

std::string to_json(const std::vector<SolverFinding>& findings) {
  Json all = Json::array();
  for (const SolverFinding& f : findings) {
    Json worst = Json::array();
    for (const SolverFinding::Element& e : f.worst)
      worst.push_back({{"number", e.tet}, {"at", place(e.at)}, {"value", e.value}});
    all.push_back({{"measure", f.measure},
                   {"refused", f.refused},
                   {f.above ? "above" : "below", f.limit},
                   {"count", f.count},
                   {"worst", worst}});
  }
  return all.dump(2, ' ', false, Json::error_handler_t::replace);
}

namespace {

Json json_of_extent(const FieldExtent& extent) {
  return {{"integral", extent.integral}, {"least", extent.least}, {"greatest", extent.greatest}};
}

}  // namespace

std::string to_json(const CarryReport& r) {
  return Json{{"nodes", r.nodes},
              {"elements", r.elements},
              {"copied_nodes", r.copied_nodes},
              {"copied_elements", r.copied_elements},
              {"volume_before", r.volume_before},
              {"volume_after", r.volume_after},
              {"uncovered", r.uncovered},
              {"lost", r.lost},
              {"outside_nodes", r.outside_nodes},
              {"farthest", r.farthest},
              {"farthest_at", place(r.farthest_at)},
              {"by_region", r.by_region},
              {"notes", r.notes}}
      .dump();
}

std::string to_json(const std::vector<LevelSetReport>& reports) {
  Json all = Json::array();
  for (const LevelSetReport& r : reports)
    all.push_back({{"name", r.name},
                   {"moved", r.moved},
                   {"divided", r.divided},
                   {"on", r.on},
                   {"elements", r.elements},
                   {"volume", r.volume},
                   {"triangles", r.triangles},
                   {"area", r.area},
                   {"pieces", r.pieces},
                   {"dropped", r.dropped}});
  return all.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string to_json(const std::vector<MoveStep>& history) {
  Json all = Json::array();
  for (const MoveStep& s : history)
    all.push_back({{"fraction", s.fraction},
                   {"change", s.change},
                   {"elements", s.elements},
                   {"beta_min", s.beta_min},
                   {"beta_mean", s.beta_mean},
                   {"volume", s.volume}});
  return all.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string to_json(const std::vector<FieldReport>& fields) {
  Json all = Json::array();
  for (const FieldReport& f : fields)
    all.push_back({{"name", f.name},
                   {"of", f.of_elements ? "elements" : "points"},
                   {"components", f.components},
                   {"before", json_of_extent(f.before)},
                   {"after", json_of_extent(f.after)},
                   {"integral_error", f.integral_error},
                   {"beyond", f.beyond}});
  return all.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace octafront
