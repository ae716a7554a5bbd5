// Contacts in jobs of Abaqus and CalculiX; what tests/cli/jobs_test.py cannot reach by the command line.

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/split.h>

#include "formats/small_files.h"
#include "support/rich_mesh.h"

#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// Two halves of a cube, whose contact is open.
TetMesh two_halves() {
  TetMesh mesh = testing::rich_mesh(2);
  mesh.region_names = {"left", "right"};
  mesh.patch_names[6] = "left|right";
  split_contacts(mesh, contacts_of(mesh));
  return mesh;
}

/// The file of a job, from the materials on.
std::string deck_of(const TetMesh& mesh, const std::string& json) {
  const testing::TemporaryFolder folder;
  WriteOptions options;
  add_to_job(options.job.emplace(), json);
  write_mesh((folder / "job.inp").string(), mesh, {}, options);
  const std::string text = testing::file_bytes(folder / "job.inp");
  return text.substr(text.find("*MATERIAL"));
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(JobFiles, OpenContactsAreTiedOrSlide) {
  const TetMesh mesh = two_halves();
  const std::string tied = deck_of(mesh, R"({"fix": {"fixed end": "all"}})");
  EXPECT_TRUE(has(tied, "*TIE, NAME=left_right_tie, ADJUST=NO, POSITION TOLERANCE=")) << tied;
  EXPECT_TRUE(has(tied, "\nleft_right, right_left\n")) << tied;
  EXPECT_FALSE(has(tied, "*CONTACT PAIR"));
  for (const char* place : {"default", "left|right", "right|left"}) {
    const std::string slides = deck_of(mesh, R"({"friction": {")" + std::string(place) + R"(": 0.25}})");
    EXPECT_FALSE(has(slides, "*TIE"));
    EXPECT_TRUE(has(slides, "*FRICTION\n0.25, ")) << slides;
    EXPECT_TRUE(has(slides, "TYPE=SURFACE TO SURFACE\nleft_right, right_left\n")) << slides;
    EXPECT_TRUE(has(slides, "*STEP, INC=200\n"));
  }
  EXPECT_FALSE(has(deck_of(mesh, R"({"friction": {"default": 0.25, "left|right": "tie"}})"), "*CONTACT PAIR"));
  EXPECT_THROW(deck_of(mesh, R"({"friction": {"left|lid": 0.25}})"), OptionError);
}

TEST(JobFiles, CracksStayOpenUnlessTheyAreNamed) {
  TetMesh mesh = testing::rich_mesh(2);
  mesh.region.assign(mesh.tets.size(), 0);
  split_patches(mesh, {"glue"});
  EXPECT_FALSE(has(deck_of(mesh, R"({"fix": {"fixed end": "all"}})"), "*TIE"));
  EXPECT_TRUE(has(deck_of(mesh, R"({"friction": {"glue_plus": 0}})"), "*CONTACT PAIR"));
}

TEST(JobFiles, TheSofterOfEqualSidesIsTheSlave) {
  const std::string deck = deck_of(two_halves(), R"({"materials": {"left": {"E": 9e5}, "right": {"E": 1e5}}})");
  EXPECT_TRUE(has(deck, "\nright_left, left_right\n")) << deck;
}

TEST(JobFiles, LoadsOnFacesThatPartsShareAreRefused) {
  TetMesh mesh = testing::rich_mesh(2);
  EXPECT_THROW(deck_of(mesh, R"({"load": {"glue": [1, 2, 3]}})"), OptionError);
}

}  // namespace
}  // namespace octafront
