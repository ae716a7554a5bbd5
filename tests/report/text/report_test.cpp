#include <octafront/report.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using Json = nlohmann::json;

StageReport stage(std::string name, double seconds) {
  StageReport made;
  made.name = std::move(name);
  made.wall_seconds = seconds;
  made.cpu_seconds = 2 * seconds;
  return made;
}

/// A large mesh of one body, with a stage that has something to say.
Report large_report() {
  Report r;
  r.stages = {stage("repair", 0.25), stage("volume front", 98765.5)};
  r.stages[1].count("candidates tried", 1.5e9);
  r.stages[1].count("faces held back", 0);
  r.stages[1].notes = {"sizes were raised: lower `max_size`"};
  r.points = 4'294'967'294;
  r.tets = 18'446'744'073'709'551'615u;
  r.boundary_faces = 1234567;
  r.bodies = 1;
  r.volume = 2;
  r.input_volume = 1.6;
  r.expected_tets = 1e9;
  r.quality.elements = r.tets;
  r.quality.beta_classes = {0, 1, 0, 0, r.tets - 1};
  r.surface_edges = {10, 0.98, 0.75};
  r.volume_edges = {20, 1.02, 0.875};
  r.peak_memory_bytes = 1'234'567'890'123;
  r.hash = 0x1f;
  return r;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ReportAsJson, KeepsEveryNumberAndTheOrderOfStages) {
  const Report r = large_report();
  const Json j = Json::parse(to_json(r));
  EXPECT_EQ(j["points"].get<std::uint64_t>(), r.points);
  EXPECT_EQ(j["tets"].get<std::uint64_t>(), r.tets);
  EXPECT_EQ(j["boundary_faces"].get<std::uint64_t>(), r.boundary_faces);
  EXPECT_EQ(j["volume"].get<double>(), r.volume);
  EXPECT_EQ(j["input_volume"].get<double>(), r.input_volume);
  EXPECT_EQ(j["quality"]["beta_classes"].get<std::vector<std::uint64_t>>(),
            (std::vector<std::uint64_t>{0, 1, 0, 0, r.tets - 1}));
  EXPECT_EQ(j["peak_memory_bytes"].get<std::uint64_t>(), r.peak_memory_bytes);
  EXPECT_EQ(j["volume_edges"]["share_within_0.7_1.4"].get<double>(), 0.875);
  ASSERT_EQ(j["stages"].size(), 2u);
  EXPECT_EQ(j["stages"][0]["name"], "repair");
  EXPECT_EQ(j["stages"][1]["counters"]["candidates tried"].get<double>(), 1.5e9);
  EXPECT_TRUE(j["stages"][1]["counters"].contains("faces held back"));
  EXPECT_EQ(j["stages"][1]["notes"][0], r.stages[1].notes[0]);
}

TEST(ReportAsJson, NotesHaveCodesAndValues) {
  Report r = large_report();
  Finding lost{"volume-lost", "region \"ball\" has 91 %", "ball", {{"change_percent", -9}}, Vec3{1, 2, 3}};
  r.stages[1].note(lost);
  const Json notes = Json::parse(to_json(r))["notes"];
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0]["code"], "note");
  EXPECT_EQ(notes[0]["text"], r.stages[1].notes[0]);
  EXPECT_EQ(notes[0]["stage"], "volume front");
  EXPECT_EQ(notes[1]["code"], "volume-lost");
  EXPECT_EQ(notes[1]["region"], "ball");
  EXPECT_EQ(notes[1]["change_percent"], -9);
  EXPECT_EQ(notes[1]["at"], (Json{1, 2, 3}));
  EXPECT_TRUE(has(to_table(r), "note (volume front): region \"ball\" has 91 %\n"));
}

TEST(ReportAsJson, TheLeastElementHasItsPlace) {
  Report r = large_report();
  r.quality.beta_min_tet = 5, r.quality.dihedral_min_tet = 7;
  r.quality.beta_min_at = {1, 2, 3}, r.quality.dihedral_min_at = {4, 5, 6};
  r.quality.dihedral_min = 0.0012;
  const Json q = Json::parse(to_json(r))["quality"];
  EXPECT_EQ(q["beta_min_tet"], 5);
  EXPECT_EQ(q["beta_min_at"], (Json{1, 2, 3}));
  EXPECT_EQ(q["dihedral_min_tet"], 7);
  EXPECT_EQ(q["dihedral_min_at"], (Json{4, 5, 6}));
  const std::string table = to_table(r);
  EXPECT_TRUE(has(table, "dihedral angles from 0.0012 to")) << "not 0.0";
  EXPECT_TRUE(has(table, "tet 7 at (4, 5, 6)"));
}

TEST(ReportAsJson, WritesTheHashWithAllItsDigits) {
  EXPECT_EQ(Json::parse(to_json(large_report()))["hash"], "000000000000001f");
}

TEST(ReportAsJson, ClaimsNoQualityOfAMeshThatWasNotMade) {
  Report r = large_report();
  r.tets = 0;
  const Json j = Json::parse(to_json(r));
  for (const char* key : {"quality", "hash", "volume_edges", "regions", "second_order"})
    EXPECT_FALSE(j.contains(key)) << key;
  EXPECT_TRUE(j.contains("surface_edges"));
}

TEST(ReportAsJson, StaysJsonWhateverNamesHold) {
  Report r = large_report();
  r.stages[0].notes = {"\xff\xfe \"quoted\" \n\x01"};
  r.regions.resize(2);
  r.regions[1].name = "r\xe9gion";
  r.regions[1].quality.elements = 7;
  const Json j = Json::parse(to_json(r));
  EXPECT_TRUE(has(j["stages"][0]["notes"][0].get<std::string>(), "\"quoted\" \n\x01"));
  EXPECT_EQ(j["regions"][1]["number"], 1);
  EXPECT_EQ(j["regions"][1]["tets"], 7);
}

TEST(ReportAsTable, FitsAHundredColumnsWhateverTheNumbers) {
  Report r = large_report();
  r.regions.resize(3);
  r.regions[1].name = std::string(200, 'n');
  r.second_order.edges = r.second_order.curved = r.tets;
  for (const std::string& line : lines_of(to_table(r))) {
    const bool is_note = line.starts_with("note (");
    EXPECT_TRUE(is_note || line.size() <= 100) << line;
  }
}

TEST(ReportAsTable, SaysEachNoteWithItsStageAndCountsInWords) {
  const std::string table = to_table(large_report());
  EXPECT_TRUE(has(table, "note (volume front): sizes were raised: lower `max_size`\n"));
  EXPECT_TRUE(has(table, "1 234 567 boundary triangles, 1 body\n"));
  EXPECT_TRUE(has(table, "volume 2 (input 1.6, +25.000 %)\n"));
  Report one;
  one.tets = one.quality.elements = one.boundary_faces = 1;
  one.bodies = 2;
  EXPECT_TRUE(to_table(one).starts_with("1 tetrahedron, 0 vertices, 1 boundary triangle, 2 bodies\n"));
}

TEST(ReportAsTable, ComparesNoVolumeWithNothing) {
  Report r = large_report();
  r.volume = r.input_volume = 0;  // of an open surface
  const std::string table = to_table(r);
  EXPECT_FALSE(has(table, "nan"));
  EXPECT_FALSE(has(table, "inf"));
  EXPECT_TRUE(has(table, "volume 0"));
}

TEST(ReportAsTable, LeavesOutRegionsAloudWhenThereAreMany) {
  Report r = large_report();
  r.regions.resize(30);
  for (std::size_t k = 0; k < r.regions.size(); ++k) r.regions[k].name = "part_" + std::to_string(k);
  const std::string table = to_table(r);
  const std::vector<std::string> lines = lines_of(table);
  const auto listed = std::count_if(lines.begin(), lines.end(), [](const std::string& l) { return has(l, "  part_"); });
  EXPECT_TRUE(has(table, "  part_0 "));
  EXPECT_TRUE(has(table, "and " + std::to_string(30 - listed) + " more"));
  EXPECT_LT(listed, 30);
}

TEST(FindingsAsJson, SayWhereAndHowMany) {
  SurfaceDefects defects;
  defects.self_intersections.count = 12;
  defects.self_intersections.first.push_back({{1, 2, 3}, {4, 5}});
  const Json d = Json::parse(to_json(defects));
  EXPECT_EQ(d["self_intersections"]["count"], 12);
  EXPECT_EQ(d["self_intersections"]["first"][0]["at"], (Json{1, 2, 3}));
  EXPECT_EQ(d["self_intersections"]["first"][0]["faces"], (Json{4, 5}));
  EXPECT_EQ(d["open_edges"]["count"], 0);

  SolverFinding finding;
  finding.measure = "aspect ratio";
  finding.limit = 20;
  finding.above = true;
  finding.count = 3;
  const Json f = Json::parse(to_json(std::vector{finding}));
  EXPECT_EQ(f[0]["above"], 20);
  EXPECT_FALSE(f[0].contains("below"));
  EXPECT_EQ(f[0]["count"], 3);
}

}  // namespace
}  // namespace octafront
