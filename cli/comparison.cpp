#include "comparison.h"

#include <octafront/io.h>

#include "charts.h"
#include "text.h"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

namespace octafront::cli {

namespace {

using Json = nlohmann::ordered_json;

const std::map<std::string, Colour> kColours{{"octree-aft", 0x0072b2}, {"aft", 0xd55e00}, {"octree", 0x009e73}};
constexpr std::array<const char*, 5> kClasses{"0 - 0.2", "0.2 - 0.4", "0.4 - 0.6", "0.6 - 0.8", "0.8 - 1"};

bool is_earlier_try(const StageReport& s) {
  return s.name.ends_with("(earlier try)");
}
bool fills(const StageReport& s) {
  return s.name == "volume front" || s.name == "stuffing";
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

std::vector<std::string> methods_in(const std::vector<Comparison>& all) {
  std::vector<std::string> methods;
  for (const Comparison& c : all)
    if (std::find(methods.begin(), methods.end(), c.method) == methods.end()) methods.push_back(c.method);
  return methods;
}

/// Sums over the meshes of one method.
struct Total {
  std::array<double, 5> classes{};
  double elements = 0, seconds = 0, filling = 0;
  int meshes = 0, failures = 0;
  std::vector<std::pair<double, double>> times;  ///< elements, seconds of filling

  double percent(int k) const { return elements > 0 ? 100 * classes[k] / elements : 0; }
};

Total total_of(const std::vector<Comparison>& all, const std::string& method) {
  Total t;
  for (const Comparison& c : all) {
    if (c.method != method) continue;
    if (!c.failure.empty()) {
      ++t.failures;
      continue;
    }
    ++t.meshes;
    for (int k = 0; k < 5; ++k) t.classes[k] += static_cast<double>(c.report.quality.beta_classes[k]);
    t.elements += static_cast<double>(c.report.tets);
    t.seconds += c.total_seconds();
    t.filling += c.filling_seconds();
    t.times.emplace_back(static_cast<double>(c.report.tets), c.filling_seconds());
  }
  return t;
}

Json json_of_run(const Comparison& c) {
  Json j{{"model", c.model}, {"faces", c.faces}, {"method", c.method}};
  j["elements_wanted"] = c.elements_wanted > 0 ? Json(c.elements_wanted) : Json(nullptr);
  j["failure"] = c.failure.empty() ? Json(nullptr) : Json(c.failure);
  if (!c.failure.empty()) return j;
  j["filling_cpu_seconds"] = c.filling_seconds();
  j["total_cpu_seconds"] = c.total_seconds();
  j["report"] = Json::parse(to_json(c.report));
  return j;
}

Json json_of_runs(const std::vector<Comparison>& all) {
  Json j;
  for (const Comparison& c : all) j["runs"].push_back(json_of_run(c));
  for (const std::string& method : methods_in(all)) {
    const Total t = total_of(all, method);
    const PowerLaw law = fit_power_law(t.times);
    j["methods"][method] = {{"meshes", t.meshes},
                            {"failures", t.failures},
                            {"elements", t.elements},
                            {"filling_cpu_seconds", t.filling},
                            {"beta_percent", {t.percent(0), t.percent(1), t.percent(2), t.percent(3), t.percent(4)}},
                            {"exponent", law.exponent != 0 ? Json(law.exponent) : Json(nullptr)}};
  }
  return j;
}

std::string csv_of(const std::vector<Comparison>& all) {
  std::string csv =
      "model,faces,method,elements_wanted,elements,points,boundary_faces,filling_cpu_s,total_cpu_s,beta_mean,beta_min,"
      "beta_below_0.2,beta_0.2_0.4,beta_0.4_0.6,beta_0.6_0.8,beta_from_0.8,dihedral_min_degrees,dihedral_max_degrees,"
      "volume_over_input,failure\n";
  for (const Comparison& c : all) {
    const Report& r = c.report;
    const auto& q = r.quality;
    csv += fmt::format("{},{},{},{},", csv_field(c.model), c.faces, c.method, c.elements_wanted);
    if (c.failure.empty())
      csv += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{},{:.6g},{:.6g},{:.8g},\n", r.tets, r.points,
                         r.boundary_faces, c.filling_seconds(), c.total_seconds(), q.beta_mean, q.beta_min,
                         fmt::join(q.beta_classes, ","), q.dihedral_min, q.dihedral_max, r.volume / r.input_volume);
    else
      csv += fmt::format(",,,,,,,,,,,,,,,{}\n", csv_field(first_line(c.failure)));
  }
  return csv;
}

void draw_beta(const std::filesystem::path& folder, const std::vector<Comparison>& all) {
  BarChart chart{.title = "Elements by quality beta = 3 r / R, all models together",
                 .y_label = "% of elements",
                 .groups = {kClasses.begin(), kClasses.end()},
                 .series = {},
                 .stacked = false,
                 .write_values = true};
  for (const std::string& method : methods_in(all)) {
    const Total t = total_of(all, method);
    Series& s = chart.series.emplace_back(Series{method, kColours.at(method), {}, {}});
    for (int k = 0; k < 5; ++k) s.values.push_back(t.percent(k));
  }
  draw_bars(folder / "beta_classes", chart);
}

void draw_times(const std::filesystem::path& folder, const std::vector<Comparison>& all) {
  ScatterChart chart{"Time to fill the volume", "elements", "CPU seconds", {}};
  for (const std::string& method : methods_in(all))
    chart.series.push_back({method, kColours.at(method), {}, total_of(all, method).times});
  draw_scatter(folder / "time_elements", chart);
}

void draw_stages(const std::filesystem::path& folder, const std::vector<Comparison>& all) {
  const std::vector<std::string> methods = methods_in(all);
  constexpr std::array<Colour, 8> kStageColours{0x999999, 0xcccccc, 0x56b4e9, 0xe69f00,
                                                0x0072b2, 0xcc79a7, 0x009e73, 0xf0e442};
  BarChart chart{.title = "CPU time of the stages per million elements",
                 .y_label = "seconds",
                 .groups = methods,
                 .series = {},
                 .stacked = true,
                 .write_values = false};
  std::vector<std::string> stages;
  for (const Comparison& c : all)
    for (const StageReport& s : c.report.stages)
      if (!is_earlier_try(s) && std::find(stages.begin(), stages.end(), s.name) == stages.end())
        stages.push_back(s.name);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    Series& series = chart.series.emplace_back(Series{stages[i], kStageColours[i % kStageColours.size()], {}, {}});
    for (const std::string& method : methods) {
      double seconds = 0;
      for (const Comparison& c : all)
        for (const StageReport& s : c.report.stages)
          if (c.method == method && c.failure.empty() && s.name == stages[i]) seconds += s.cpu_seconds;
      const double elements = total_of(all, method).elements;
      series.values.push_back(elements > 0 ? 1e6 * seconds / elements : 0);
    }
  }
  draw_bars(folder / "stages", chart);
}

}  // namespace

double Comparison::filling_seconds() const {
  double sum = 0;
  for (const StageReport& s : report.stages)
    if (fills(s)) sum += s.cpu_seconds;
  return sum;
}

double Comparison::total_seconds() const {
  double sum = 0;
  for (const StageReport& s : report.stages)
    if (!is_earlier_try(s)) sum += s.cpu_seconds;
  return sum;
}

std::string table_head() {
  return fmt::format("{:<20} {:<10} {:>10} {:>8} {:>8} {:>9} {:>6} {:>6} {:>9} {:>7}\n", "model", "method", "elements",
                     "fill s", "total s", "elem/s", "beta", "least", "% < 0.2", "% > 0.8");
}

std::string table_row(const Comparison& c) {
  std::string row = fmt::format("{:<20.20} {:<10} ", c.model, c.method);
  if (!c.failure.empty()) return row + "failed: " + first_line(c.failure) + "\n";
  const Report& r = c.report;
  const double n = static_cast<double>(r.tets), filling = c.filling_seconds();
  return row + fmt::format("{:>10} {:>8.2f} {:>8.2f} {:>8.0f}k {:>6.3f} {:>6.3f} {:>9.4f} {:>7.2f}\n", r.tets, filling,
                           c.total_seconds(), filling > 0 ? n / filling / 1e3 : 0, r.quality.beta_mean,
                           r.quality.beta_min, 100 * static_cast<double>(r.quality.beta_classes[0]) / n,
                           100 * static_cast<double>(r.quality.beta_classes[4]) / n);
}

std::string summary_of(const std::vector<Comparison>& all, const std::filesystem::path& folder) {
  std::string text = "\nall models together\n";
  for (const std::string& method : methods_in(all)) {
    const Total t = total_of(all, method);
    text += fmt::format(
        "  {:<10} {} meshes, {} failures; beta < 0.2: {:.4f} %, > 0.8: {:.2f} %; filling {:.0f}k elements/s", method,
        t.meshes, t.failures, t.percent(0), t.percent(4), t.filling > 0 ? t.elements / t.filling / 1e3 : 0);
    const PowerLaw law = fit_power_law(t.times);
    text += law.exponent != 0 ? fmt::format(", time ~ elements^{:.2f}\n", law.exponent) : "\n";
  }
  text += fmt::format("written to {}: compare.csv, compare.json{}\n", folder.string(),
                      can_draw() ? ", beta_classes, time_elements and stages as .svg and .png"
                                 : "; no charts, for this program was built without cairo");
  return text;
}

std::vector<std::filesystem::path> comparison_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files{folder / "compare.csv", folder / "compare.json"};
  for (const char* chart : {"beta_classes", "time_elements", "stages"})
    for (const char* ending : {".svg", ".png"})
      if (can_draw()) files.push_back(folder / (std::string(chart) + ending));
  return files;
}

void write_comparison(const std::filesystem::path& folder, const std::vector<Comparison>& all) {
  write_text((folder / "compare.csv").string(), csv_of(all));
  write_text((folder / "compare.json").string(),
             json_of_runs(all).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  if (!can_draw()) return;
  draw_beta(folder, all);
  draw_times(folder, all);
  draw_stages(folder, all);
}

}  // namespace octafront::cli
