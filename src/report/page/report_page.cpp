#include <octafront/error.h>
#include <octafront/picture.h>
#include <octafront/quality.h>
#include <octafront/report_page.h>
#include <octafront/run_context.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "report/page/assets.h"
#include "report/page/mesh_streams.h"
#include "report/picture/colours.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

namespace octafront {

namespace {

using Json = nlohmann::ordered_json;

/// JSON in a page: no "<" in it, so that no name of a file can end the element that holds it.
std::string embedded(const Json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', true, Json::error_handler_t::replace))
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  return text;
}

Json scale(const ByteScale& s) {
  return {s.low, s.high};
}

/// The names of regions or patches, as many as there are numbers in use.
Json names(const std::vector<std::uint32_t>& number, const std::vector<std::string>& given, const char* otherwise,
           Json all = Json::array()) {
  std::uint32_t most = number.empty() ? 0 : *std::max_element(number.begin(), number.end());
  constexpr std::uint32_t kMostNames = 100'000;  // numbers of files may be anything
  most = std::min(most, kMostNames);
  for (std::size_t i = all.size(); i <= most; ++i)
    all.push_back(i < given.size() && !given[i].empty() ? given[i] : otherwise + std::to_string(i));
  return all;
}

Json hex_of_stops() {
  Json stops = Json::array();
  for (const Rgb stop : kPoorToGood) stops.push_back(hex_of(stop));
  return stops;
}

Json facts_of(const TetMesh& mesh, const MeshStreams& streams) {
  Json patches = names(mesh.patch, mesh.patch_names, "patch ");
  if (!mesh.interfaces.empty()) patches = names(mesh.interface_patch, mesh.patch_names, "patch ", std::move(patches));
  return {{"points", streams.points},
          {"tets", mesh.tets.size()},
          {"boundary", mesh.boundary.size()},
          {"origin", {streams.origin.x, streams.origin.y, streams.origin.z}},
          {"step", streams.step},
          {"second_order", mesh.is_second_order()},
          {"regions", names(mesh.region, mesh.region_names, "region ")},
          {"patches", std::move(patches)},
          {"scales",
           {{"beta", scale(kBetaScale)},
            {"min_dihedral", scale(kMinDihedralScale)},
            {"max_dihedral", scale(kMaxDihedralScale)},
            {"size_ratio", scale(kSizeRatioScale)},
            {"layers", scale(kLayersScale)}}},
          {"poor_to_good", hex_of_stops()},
          {"has_sizes", streams.has_sizes},
          {"has_layers", streams.has_layers}};
}

Json list_of(const std::vector<PoorElement>& worst) {
  Json list = Json::array();
  for (const PoorElement& e : worst)
    list.push_back({{"number", e.tet},
                    {"at", {e.at.x, e.at.y, e.at.z}},
                    {"beta", e.beta},
                    {"dihedral_min_degrees", e.dihedral_min},
                    {"dihedral_max_degrees", e.dihedral_max}});
  return list;
}

Json parsed(const std::string& report) {
  Json json = Json::parse(report, nullptr, false);
  if (!json.is_object()) throw OptionError("the report for a page is a JSON object, as `octafront --json` writes it");
  return json;
}

void add_element(std::string& page, const std::string& type, const std::string& id, const std::string& content) {
  page += "<script type=\"" + type + "\" id=\"" + id + "\">" + content + "</script>\n";
}

/// For browsers that cannot draw: a picture with few colours, which packs well.
std::string still_picture(const TetMesh& mesh, const Json& report, const RunContext& context) {
  PictureOptions options;
  options.width = 560, options.height = 420;
  if (report.contains("unit") && report["unit"].is_string()) options.unit = report["unit"];
  Picture picture = draw_picture(mesh, options, context);
  for (std::uint8_t& channel : picture.pixels) {
    constexpr int kStep = 17;  // 0 and 255 stay what they are
    channel = static_cast<std::uint8_t>((channel + kStep / 2) / kStep * kStep);
  }
  return "data:image/png;base64," + to_base64(to_png(picture));
}

}  // namespace

std::string report_page(const TetMesh& mesh, const SizeField* sizes, const std::string& report,
                        const RunContext& context) {
  const ThreadLimit limit(context.threads);
  Json json = parsed(report);
  context.report("packing the page", -1);
  if (!json.contains("worst_elements")) json["worst_elements"] = list_of(worst_elements(mesh, 20));
  const MeshStreams streams = mesh_streams(mesh, sizes, context);
  std::vector<std::string> text(streams.all.size());
  parallel_for(
      text.size(), [&](std::size_t i) { text[i] = packed(streams.all[i].second); }, Split::kSingly);
  context.check();
  std::string page(page_asset::kBefore);
  constexpr std::string_view kNoPicture = "src=\"data:,\"";
  page.replace(page.find(kNoPicture), kNoPicture.size(), "src=\"" + still_picture(mesh, json, context) + "\"");
  add_element(page, "application/json", "report", embedded(json));
  add_element(page, "application/json", "facts", embedded(facts_of(mesh, streams)));
  for (std::size_t i = 0; i < text.size(); ++i)
    add_element(page, "text/plain", std::string("mesh-") + streams.all[i].first, text[i]);
  page += page_asset::kBehind;
  return page;
}

}  // namespace octafront
