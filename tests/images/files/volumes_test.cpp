// Real volumes, where bench/models/get-volumes.sh has fetched them; skipped with a message where not.

#include <octafront/image.h>

#include "images/small_images.h"
#include "support/temporary_folder.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace octafront {
namespace {

namespace fs = std::filesystem;

std::string volume(const std::string& name) {
  return (fs::path(OCTAFRONT_VOLUMES) / name).string();
}

class Volumes : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(volume("Cranium.nrrd"))) GTEST_SKIP() << "bench/models/get-volumes.sh fetches the volumes";
  }
  const testing::TemporaryFolder folder_;
};

/// Turned about the patient's left-right axis by `tilt` degrees against the table: as a gantry does.
std::vector<testing::DicomSlice> slices_of(const Image& image, double tilt) {
  const auto& values = std::get<std::vector<std::int16_t>>(image.values);
  const auto [ni, nj, nk] = image.grid.size;
  const double angle = tilt * std::numbers::pi / 180;
  std::vector<testing::DicomSlice> slices;
  for (std::uint32_t k = 0; k < nk; ++k) {
    testing::DicomSlice s;
    s.syntax = k % 2 == 0 ? testing::DicomSlice::Syntax::kRle : testing::DicomSlice::Syntax::kExplicit;
    s.uid = fmt::format("1.2.3.4.{}", k);
    s.instance = static_cast<int>(nk - k);
    s.size = {static_cast<std::uint16_t>(ni), static_cast<std::uint16_t>(nj)};
    // Rows run to the back, as scanners write them: the last row of the project first.
    s.at = {0, -length(image.grid.axes[1]) * (nj - 1.0), length(image.grid.axes[2]) * k};
    s.directions = {1, 0, 0, 0, std::cos(angle), std::sin(angle)};
    s.spacing = {length(image.grid.axes[1]), length(image.grid.axes[0])};
    s.intercept = -1024;
    s.thickness = 1.5;
    for (std::uint32_t j = nj; j-- > 0;)
      for (std::uint32_t i = 0; i < ni; ++i)
        s.pixels.push_back(static_cast<std::int16_t>(values[i + ni * (j + std::size_t{nj} * k)] + 1024));
    slices.push_back(std::move(s));
  }
  return slices;
}

/// Files with names that tell nothing, in an order of their own.
void write(const fs::path& folder, std::vector<testing::DicomSlice> slices) {
  fs::create_directories(folder);
  std::shuffle(slices.begin(), slices.end(), std::mt19937(7));
  for (std::size_t f = 0; f < slices.size(); ++f)
    std::ofstream(folder / fmt::format("IM{:04}", f), std::ios::binary) << slices[f].bytes();
}

TEST_F(Volumes, CraniumIsWhatItsProjectSays) {
  const Image image = read_image(volume("Cranium.nrrd"));
  EXPECT_EQ(image.grid.size, (std::array<std::uint32_t, 3>{256, 256, 108}));
  const auto& values = std::get<std::vector<std::int16_t>>(image.values);
  const Image mask = read_image(volume("Cranium-mask.nrrd"));
  const auto& inside = std::get<std::vector<std::uint8_t>>(mask.values);
  std::size_t voxels = 0;
  for (std::size_t v = 0; v < values.size(); ++v) {
    voxels += inside[v];
    ASSERT_EQ(inside[v] == 1, values[v] >= 226 && values[v] <= 3071);
  }
  EXPECT_EQ(voxels, 475759U);
  EXPECT_FALSE(looks_like_labels(image));
  EXPECT_TRUE(looks_like_labels(mask));
}

TEST_F(Volumes, CraniumAsASeriesOfDicomIsTheSame) {
  const Image image = read_image(volume("Cranium.nrrd"));
  write(folder_ / "series", slices_of(image, 0));
  const Image series = read_image((folder_ / "series").string());
  // Rows run the other way, so the same voxel has another number.
  const auto [ni, nj, nk] = image.grid.size;
  ASSERT_EQ(series.grid.size, image.grid.size);
  EXPECT_TRUE(series.grid.slices.empty());
  const auto& a = std::get<std::vector<std::int16_t>>(image.values);
  const auto& b = std::get<std::vector<std::int16_t>>(series.values);
  for (std::size_t k = 0; k < nk; ++k)
    for (std::size_t j = 0; j < nj; ++j)
      for (std::size_t i = 0; i < ni; ++i) ASSERT_EQ(a[i + ni * (j + nj * k)], b[i + ni * (nj - 1 - j + nj * k)]);
  EXPECT_LT(distance(image.grid.to_world({3, 5, 7}), series.grid.to_world({3, nj - 6.0, 7})), 1e-6);
}

TEST_F(Volumes, AsScannersReallyWriteThem) {
  const Image image = cropped(read_image(volume("Cranium.nrrd")), {{100, 60, 0}, {140, 120, 20}});
  std::vector<testing::DicomSlice> tilted = slices_of(image, 15);
  const Image sheared = [&] {
    write(folder_ / "tilted", tilted);
    return read_image((folder_ / "tilted").string());
  }();
  EXPECT_TRUE(std::any_of(sheared.notes.begin(), sheared.notes.end(),
                          [](const std::string& n) { return n.find("sheared by 15 degrees") != std::string::npos; }));
  EXPECT_NEAR(dot(normalized(sheared.grid.axes[1]), normalized(sheared.grid.axes[2])),
              std::sin(15 * std::numbers::pi / 180), 1e-6);
  // Slices 7 and 8 are lost, a second series and a report lie in the same folder.
  std::vector<testing::DicomSlice> slices = slices_of(image, 0);
  slices.erase(slices.begin() + 7, slices.begin() + 9);
  std::vector<testing::DicomSlice> other = slices_of(image, 0);
  for (testing::DicomSlice& s : other) {
    s.series = "5.6.7";
    s.series_number = 2;
  }
  write(folder_ / "mixed" / "a", slices);
  write(folder_ / "mixed" / "b", other);
  std::ofstream(folder_ / "mixed" / "README") << "no image";
  const std::string list = testing::input_error([&] { read_image((folder_ / "mixed").string()); });
  EXPECT_NE(list.find("2 series"), std::string::npos) << list;
  const Image one = read_image((folder_ / "mixed").string(), {1});
  EXPECT_EQ(one.grid.size[2], 18U);
  EXPECT_NEAR(one.grid.slices[7], 9, 1e-9);
  EXPECT_TRUE(std::any_of(one.notes.begin(), one.notes.end(),
                          [](const std::string& n) { return n.find("2 slices are missing") != std::string::npos; }));
}

TEST_F(Volumes, SegmentationsAreToldFromGreyImages) {
  for (const char* name :
       {"AICHAmc.nii.gz", "HarvardOxford-cort-maxprob-thr0-1mm.nii.gz", "JHU-WhiteMatter-labels-1mm.nii.gz",
        "JHU-WhiteMatter-labels-2mm.nii.gz", "aal.nii.gz", "brodmann.nii.gz", "inia19-NeuroMaps.nii.gz",
        "jhu189.nii.gz", "natbrainlab.nii.gz", "KmeansTest_T1KmeansPrelimSegmentation.nii.gz", "liver.nrrd"})
    EXPECT_TRUE(looks_like_labels(read_image(volume(name)))) << name;
  for (const char* name : {"ch2.nii.gz", "ch2bet.nii.gz", "ch2better.nii.gz", "inia19-t1-brain.nii.gz",
                           "KmeansTest_T1UCharRaw.nii.gz", "skull_2.9.nrrd", "BrainProtonDensity3Slices.mha"})
    EXPECT_FALSE(looks_like_labels(read_image(volume(name)))) << name;
}

TEST_F(Volumes, NamesOfAtlasesAreRead) {
  EXPECT_EQ(read_label_names(volume("aal.nii.txt"))[0], (LabelName{1, "Precentral_L"}));
  EXPECT_EQ(read_label_names(volume("AICHAmc.nii.txt"))[1], (LabelName{2, "G_Frontal_Sup-2"}));
  const std::vector<LabelName> tracts = read_label_names(volume("JHU-WhiteMatter-labels-1mm.nii.txt"));
  EXPECT_EQ(tracts[2].name, "Pontine_crossing_tract_(a_part_of_MCP)");
}

}  // namespace
}  // namespace octafront
