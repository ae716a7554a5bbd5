// One way in: the command line, C++ and C make the same mesh of the same input, bit for bit.

#include <octafront/generate.h>
#include <octafront/io.h>
#include <octafront/octafront_c.h>

#include "support/named_surfaces.h"
#include "support/test_folder.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using Json = nlohmann::json;

const std::string kSamples = OCTAFRONT_SAMPLES;

/// An input, and what is asked in the words of each door.
struct Case {
  std::vector<std::string> files;
  double size;
  std::string line;         ///< of the command line
  std::string keys = "{}";  ///< of C
  IntakeOptions intake = {};
};

class OneWayIn : public testing::InItsFolder {
 protected:
  Json of_the_line(const Case& c) const {
    std::string command = OCTAFRONT_PROGRAM " mesh";
    for (const std::string& f : c.files) command += " " + f;
    const std::string json = folder_ / "report.json";
    command += " --size " + std::to_string(c.size) + " " + c.line + " -q --threads 1 -o " +
               (folder_ / "mesh.vtu").string() + " --json " + json;
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    std::ifstream in(json);
    return Json::parse(in);
  }
};

int status_at_quiet_end(octafront_job* job) {
  octafront_event event;
  while (octafront_job_wait(job, -1, &event) != OCTAFRONT_EVENT_END) {
  }
  EXPECT_STREQ(octafront_job_message(job), "");
  return octafront_job_status(job);
}

/// The reports of the way in and of the mesh.
std::pair<Json, Json> of_c(const Case& c) {
  std::vector<const char*> files;
  for (const std::string& f : c.files) files.push_back(f.c_str());
  octafront_options* options = octafront_options_new();
  octafront_options_set(options, Json{{"size", c.size}}.dump().c_str());
  octafront_job* opening = octafront_open_files(files.data(), files.size(), c.keys.c_str(), options, 1);
  EXPECT_EQ(status_at_quiet_end(opening), OCTAFRONT_DONE);
  octafront_surface* domain = octafront_job_take_surface(opening);
  octafront_job* meshing = octafront_generate(domain, options, 1);
  EXPECT_EQ(status_at_quiet_end(meshing), OCTAFRONT_DONE);
  std::pair<Json, Json> reports{Json::parse(octafront_job_report(opening)), Json::parse(octafront_job_report(meshing))};
  octafront_job_free(meshing);
  octafront_job_free(opening);
  octafront_options_free(options);
  octafront_surface_free(domain);
  return reports;
}

class OneWayInOf : public OneWayIn {
 protected:
  void expect_one_mesh(const Case& c) const {
    Options options;
    options.size.size = c.size;
    const Domain domain = open_domain(c.files, intake_for(options, c.intake));
    const Json cpp = Json::parse(to_json(generate(domain, options).report)), line = of_the_line(c);
    const auto [opened, made] = of_c(c);
    EXPECT_EQ(cpp["hash"], line["hash"]);
    EXPECT_EQ(made["hash"], line["hash"]);
    const Json known = Json::parse(to_json(domain));
    for (const auto& [key, value] : known.items()) {
      EXPECT_EQ(line[key], value) << key;
      EXPECT_EQ(opened[key == "input_regions" ? "regions" : key], value) << key;
    }
  }
};

TEST_F(OneWayInOf, ACleanStl) {
  expect_one_mesh({{kSamples + "/bracket.stl"}, 8, ""});
}

TEST_F(OneWayInOf, ASoupThatNeedsMending) {
  SurfaceMesh soup =
      testing::joined(testing::icosphere(3), testing::transformed(testing::icosphere(3), 1, {0.7, 0, 0}));
  soup.triangles.erase(soup.triangles.begin() + 40);
  expect_one_mesh({{file("soup.off", soup)}, 0.3, "--tolerance 0.01", R"({"tolerance": 0.01})", [] {
                     IntakeOptions intake;
                     intake.complex.tolerance = 0.01;
                     return intake;
                   }()});
}

TEST_F(OneWayInOf, TwoBodies) {
  const SurfaceMesh pin = testing::transformed(testing::cube(1), 0.5, {0.25, 0.25, 1});
  expect_one_mesh({{file("plate.off", testing::cube(1)), file("pin.off", pin)}, 0.25, ""});
}

#ifdef OCTAFRONT_CAD_PROGRAM
TEST_F(OneWayInOf, AnAssembly) {
  setenv("OCTAFRONT_CAD", OCTAFRONT_CAD_PROGRAM, 1);
  IntakeOptions intake;
  intake.cad.unit = "cm";
  expect_one_mesh({{kSamples + "/assembly.step"}, 0.5, "--unit cm", R"({"cad_unit": "cm"})", intake});
}
#endif

TEST_F(OneWayInOf, AnImageOfLabels) {
  IntakeOptions intake;
  intake.image.names_file = kSamples + "/head_labels.txt";
  intake.image.resample = {12};
  expect_one_mesh({{kSamples + "/head_labels.nii.gz"},
                   30,
                   "--resample 12 --labels " + intake.image.names_file,
                   Json{{"names_file", intake.image.names_file}, {"resample", 12}}.dump(),
                   intake});
}

TEST_F(OneWayInOf, AGreyImageWithBands) {
  IntakeOptions intake;
  intake.image.regions.bands = {{-200, 226, "skin"}, {226, 1e9, "bone"}};
  intake.image.resample = {12};
  expect_one_mesh({{kSamples + "/head_ct.nii.gz"},
                   30,
                   "--resample 12 --band skin=-200:226 --band bone=226:1e9",
                   R"({"resample": 12, "bands": [["skin", -200, 226], ["bone", 226, 1e9]]})",
                   intake});
}

}  // namespace
}  // namespace octafront
