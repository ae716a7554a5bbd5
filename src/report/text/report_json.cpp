#include <octafront/report.h>

#include <nlohmann/json.hpp>

#include <fmt/core.h>

namespace octafront {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const StageReport& stage) {
  Json counters = Json::object();
  for (const auto& [key, value] : stage.counters) counters[key] = value;
  return {{"name", stage.name},
          {"wall_seconds", stage.wall_seconds},
          {"cpu_seconds", stage.cpu_seconds},
          {"counters", counters},
          {"notes", stage.notes}};
}

Json json_of(Vec3 p) {
  return {p.x, p.y, p.z};
}

/// All notes, with the codes and values of those that have some.
Json notes_of(const std::vector<StageReport>& stages) {
  Json all = Json::array();
  for (const StageReport& stage : stages)
    for (const std::string& note : stage.notes) {
      Json told{{"code", "note"}, {"stage", stage.name}, {"text", note}};
      for (const Finding& finding : stage.findings) {
        if (finding.text != note) continue;
        told["code"] = finding.code;
        if (!finding.region.empty()) told["region"] = finding.region;
        for (const auto& [key, value] : finding.values) told[key] = value;
        if (finding.at) told["at"] = json_of(*finding.at);
      }
      all.push_back(std::move(told));
    }
  return all;
}

Json json_of(const QualitySummary& q) {
  return {{"beta_mean", q.beta_mean},
          {"beta_min", q.beta_min},
          {"beta_min_tet", q.beta_min_tet},
          {"beta_min_at", json_of(q.beta_min_at)},
          {"beta_classes", q.beta_classes},
          {"beta_class_bounds", {0, 0.2, 0.4, 0.6, 0.8, 1}},
          {"dihedral_min_degrees", q.dihedral_min},
          {"dihedral_min_tet", q.dihedral_min_tet},
          {"dihedral_min_at", json_of(q.dihedral_min_at)},
          {"dihedral_max_degrees", q.dihedral_max},
          {"dihedral_histogram", q.dihedral_histogram},
          {"dihedral_class_degrees", 10}};
}

Json json_of(const std::vector<RegionSummary>& regions) {
  Json all = Json::array();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    all.push_back({{"number", r},
                   {"name", regions[r].name},
                   {"tets", regions[r].quality.elements},
                   {"volume", regions[r].volume},
                   {"quality", json_of(regions[r].quality)}});
    if (regions[r].input_volume > 0) all.back()["input_volume"] = regions[r].input_volume;
    if (regions[r].layers_volume > 0) all.back()["layers_volume"] = regions[r].layers_volume;
    if (regions[r].needed > 0) all.back()["needed_tets"] = regions[r].needed;
    if (regions[r].true_volume > 0) all.back()["true_volume"] = regions[r].true_volume;
  }
  return all;
}

Json json_of(const std::vector<WallSummary>& walls) {
  Json all = Json::array();
  for (const WallSummary& w : walls)
    all.push_back(
        {{"regions", w.regions}, {"triangles", w.triangles}, {"area", w.area}, {"needed_triangles", w.needed}});
  return all;
}

Json json_of(const std::vector<ContactSummary>& contacts) {
  Json all = Json::array();
  for (const ContactSummary& c : contacts)
    all.push_back(
        {{"patches", c.patches}, {"triangles", c.triangles}, {"areas", c.areas}, {"conforming", c.conforming}});
  return all;
}

Json json_of(const SizeSummary& s) {
  return {{"edges", s.edges}, {"mean_ratio", s.mean_ratio}, {"share_within_0.7_1.4", s.share_within}};
}

Json json_of(const std::vector<LayerSummary>& walls) {
  Json all = Json::array();
  for (const LayerSummary& w : walls) {
    Json stopped = Json::object();
    for (const auto& [reason, part] : w.stopped) stopped[reason] = part;
    all.push_back({{"patch", w.patch},
                   {"region", w.region},
                   {"faces", w.faces},
                   {"share_full", w.full},
                   {"share_with_some", w.with_some},
                   {"mean_layers", w.mean_count},
                   {"asked_layers", w.asked_count},
                   {"first_height", {{"min", w.first_min}, {"median", w.first_median}, {"max", w.first_max}}},
                   {"share_of_thickness", w.thickness},
                   {"least_scaled_jacobian", w.min_scaled_jacobian},
                   {"stopped", stopped}});
  }
  return all;
}

Json json_of(const SecondOrderSummary& s) {
  return {{"edges", s.edges},
          {"curved_edges", s.curved},
          {"eased_edges", s.eased},
          {"eased_faces", s.eased_faces},
          {"straight_edges", s.straight},
          {"corners_moved", s.moved},
          {"corners_held", s.held},
          {"largest_bend", s.largest_bend},
          {"least_scaled_jacobian", s.least_scaled_jacobian},
          {"least_tet", s.least_tet}};
}

}  // namespace

std::string to_json(const Report& report) {
  Json stages = Json::array();
  for (const StageReport& stage : report.stages) stages.push_back(json_of(stage));
  Json j{{"points", report.points},
         {"tets", report.tets},
         {"boundary_faces", report.boundary_faces},
         {"bodies", report.bodies},
         {"volume", report.volume},
         {"input_volume", report.input_volume},
         {"expected_tets", report.expected_tets}};
  if (report.true_volume > 0) j["true_volume"] = report.true_volume;
  if (report.tets > 0) {
    j["quality"] = json_of(report.quality);
    if (!report.regions.empty()) j["regions"] = json_of(report.regions);
    if (!report.walls.empty()) j["walls"] = json_of(report.walls);
    if (!report.contacts.empty()) j["opened_contacts"] = json_of(report.contacts);
    if (!report.layers.empty()) j["layers"] = json_of(report.layers);
    if (report.second_order.edges > 0) j["second_order"] = json_of(report.second_order);
    j["volume_edges"] = json_of(report.volume_edges);
    j["hash"] = fmt::format("{:016x}", report.hash);
  }
  if (report.surface_edges.edges > 0) j["surface_edges"] = json_of(report.surface_edges);
  j["notes"] = notes_of(report.stages);
  j["stages"] = stages;
  j["wall_seconds"] = report.wall_seconds;
  j["cpu_seconds"] = report.cpu_seconds;
  j["peak_memory_bytes"] = report.peak_memory_bytes;
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace octafront
