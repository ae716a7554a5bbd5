#include <octafront/error.h>
#include <octafront/image.h>

#include "images/files/label_names.h"
#include "images/labels/label_steps.h"
#include "images/labels/runs.h"
#include "images/small_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::any_contains;
using testing::input_error;

template <class T>
Image image_of(std::array<std::uint32_t, 3> size, std::vector<T> values) {
  Image image;
  image.grid.size = size;
  image.values = std::move(values);
  return image;
}

std::vector<std::string> names_of(const LabelImage& labels) {
  std::vector<std::string> names;
  for (const auto& l : labels.labels) names.push_back(l.name);
  return names;
}

constexpr std::uint16_t kOut = LabelImage::kNoRegion;

TEST(Labels, ValuesBecomeRegionsInOrder) {
  Image image = image_of<std::int16_t>({6, 1, 1}, {7, 0, -3, 300, 7, 0});
  image.names = {{7, "from the file"}, {300, "of the file"}};
  LabelOptions options;
  options.names = {{7, "liver"}};
  const LabelImage labels = labels_of(image, options);
  EXPECT_EQ(names_of(labels), (std::vector<std::string>{"label -3", "liver", "of the file"}));
  EXPECT_EQ(labels.labels[0].value, -3);
  EXPECT_EQ(labels.regions, (std::vector<std::uint16_t>{1, kOut, 0, 2, 1, kOut}));
  EXPECT_TRUE(any_contains(labels.notes, "value 0 (2 voxels)"));
}

TEST(Labels, IgnoredAndMergedValues) {
  const Image image = image_of<std::uint8_t>({5, 1, 1}, {0, 1, 2, 3, 4});
  LabelOptions options;
  options.ignore = {{4, 9}};
  options.merge = {{"cortex", {1, 3}}};
  const LabelImage labels = labels_of(image, options);
  EXPECT_EQ(names_of(labels), (std::vector<std::string>{"label 0", "cortex", "label 2"}));
  EXPECT_EQ(labels.regions, (std::vector<std::uint16_t>{0, 1, 2, 1, kOut}));
  EXPECT_TRUE(any_contains(labels.notes, "values 1, 3 are one region, \"cortex\""));
  options.ignore = {{3}};
  EXPECT_THROW(labels_of(image, options), OptionError);
  options.ignore.reset();
  options.merge.push_back({"again", {3}});
  EXPECT_THROW(labels_of(image, options), OptionError);
  // 0 is ignored by custom only: merging it is clear enough.
  options.merge = {{"all", {0, 1}}};
  EXPECT_EQ(labels_of(image, options).regions[0], 0);
  options.merge.clear();
  options.ignore = {{0, 1, 2, 3, 4}};
  EXPECT_THROW(labels_of(image, options), InputError);
  EXPECT_THROW(labels_of(image_of<float>({1, 1, 1}, {0.5F})), InputError);
  EXPECT_EQ(labels_of(image_of<float>({2, 1, 1}, {3.0F, 1e6F})).labels[1].value, 1000000);
}

TEST(Labels, ThinIsWhatLiesBetweenTwoFacesOfAnAxis) {
  LabelImage image;
  image.grid.size = {6, 3, 3};
  image.regions.assign(54, 0);
  for (std::size_t row = 0; row < 9; ++row) image.regions[6 * row + 2] = 1;  // a layer across i
  EXPECT_EQ(image::thinness_of(image).faces, 18u);
  EXPECT_EQ(image::thinness_of(image).thin, 9u);
  for (std::size_t row = 0; row < 9; ++row) image.regions[6 * row + 3] = 1;
  EXPECT_EQ(image::thinness_of(image).faces, 18u);
  EXPECT_EQ(image::thinness_of(image).thin, 0u);
}

TEST(Labels, NoiseIsGreyAndBlocksAreLabels) {
  std::mt19937 random(3);
  constexpr std::uint32_t n = 24;
  std::vector<std::uint8_t> noise, blocks, few;
  for (std::uint32_t k = 0; k < n; ++k)
    for (std::uint32_t j = 0; j < n; ++j)
      for (std::uint32_t i = 0; i < n; ++i) {
        noise.push_back(static_cast<std::uint8_t>(random() % 100));
        blocks.push_back(static_cast<std::uint8_t>(i / 6 + 4 * (j / 6) + 16 * (k / 6)));
        few.push_back(static_cast<std::uint8_t>(random() % 3));
      }
  EXPECT_FALSE(looks_like_labels(image_of<std::uint8_t>({n, n, n}, noise)));
  EXPECT_TRUE(looks_like_labels(image_of<std::uint8_t>({n, n, n}, blocks)));
  EXPECT_TRUE(looks_like_labels(image_of<std::uint8_t>({n, n, n}, few)));
  EXPECT_FALSE(looks_like_labels(image_of<float>({2, 1, 1}, {1, 1.5})));
}

TEST(Labels, ValuesAreCounted) {
  const auto counts = count_values(image_of<std::int32_t>({4, 1, 1}, {2000000000, -2000000000, 5, 5}));
  EXPECT_EQ(*counts, (std::vector<ValueCount>{{-2000000000, 1}, {5, 2}, {2000000000, 1}}));
  EXPECT_TRUE(count_values(image_of<float>({1, 1, 1}, {1e9F})));
  EXPECT_FALSE(count_values(image_of<float>({1, 1, 1}, {0.5F})));
  EXPECT_FALSE(count_values(image_of<float>({1, 1, 1}, {1e17F})));
}

TEST(Labels, FacesOfTheBoxThatRegionsReach) {
  std::vector<std::uint8_t> values(27, 0);
  values[13] = 1;  // the middle
  values[12] = 2;  // first i
  values[26] = 3;  // the last corner
  const LabelImage labels = labels_of(image_of<std::uint8_t>({3, 3, 3}, values));
  EXPECT_EQ(faces_reached(labels), (std::vector<std::uint8_t>{0, 1, 0b101010}));
}

std::vector<LabelName> read_names(const std::string& text) {
  return image::read_label_names_bytes({"names", text});
}

TEST(LabelNames, EveryWayToKeepThem) {
  const std::vector<LabelName> expected{{1, "left lung"}, {3, "liver"}};
  const std::vector<std::string> texts{
      "1 left lung\n3 liver\n",
      "# colours\n1 left lung 255 0 0 255\r\n\r\n3 liver 0 255 0 255\n",
      "3\tliver\n1\tleft lung",
      "1,left lung\n3,liver\n",
      "    1   255    0    0        1  1  1    \"left lung\"\n    3   0 255    0        1  1  1    \"liver\"\n",
      "index\tname\tabbreviation\n1\tleft lung\tLL\n3\tliver\tL\n",
      "labelValue,label,r\n1,left lung,3\n3,liver,4\n",
      "{\"1\": \"left lung\", \"3\": \"liver\"}",
      "{\"left lung\": 1, \"liver\": 3}",
      "{\"name\": \"x\", \"labels\": {\"left lung\": 1, \"liver\": 3}}",
      " [{\"value\": 1, \"name\": \"left lung\"}, {\"id\": 3, \"name\": \"liver\"}]",
  };
  for (const std::string& text : texts) {
    SCOPED_TRACE(text);
    EXPECT_EQ(read_names(text), expected);
  }
  // A number that ends a name stays where other lines have none.
  EXPECT_EQ(read_names("1 Area 17\n2 pons\n")[0].name, "Area 17");
  EXPECT_EQ(read_names("1 Precentral_L 2001\n2 Precentral_R 2002\n")[1].name, "Precentral_R");
}

TEST(LabelNames, WhatIsNoneIsRefused) {
  const std::vector<std::pair<std::string, std::string>> texts{
      {"1 liver\n1 lung\n", "line 2"},   {"one liver\n", "line 1"}, {"", "no names"},         {"{\"1\": 2.5}", "\"1\""},
      {"[{\"name\": \"x\"}]", "like {"}, {"{\"1\": ", "JSON"},      {"# only\n", "no names"}, {"3\n", "line 1"}};
  for (const auto& [text, part] : texts) {
    SCOPED_TRACE(text);
    const std::string message = input_error([&, t = text] { read_names(t); });
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

LabelImage label_image(std::array<std::uint32_t, 3> size, std::vector<std::uint16_t> regions, std::size_t labels) {
  LabelImage image;
  image.grid.size = size;
  image.regions = std::move(regions);
  for (std::size_t l = 0; l < labels; ++l)
    image.labels.push_back({static_cast<std::int64_t>(l + 1), std::string(1, static_cast<char>('a' + l))});
  return image;
}

TEST(Cleaning, IslandsGoToWhatSurroundsThemAndTheLargestPieceStays) {
  // a a b a a . a b b in a row: b has an island inside a, a one beside the outside and b.
  const LabelImage image = label_image({9, 1, 1}, {0, 0, 1, 0, 0, kOut, 0, 1, 1}, 2);
  CleanOptions options;
  options.islands = 1.5;
  const LabelImage out = cleaned(image, options);
  EXPECT_EQ(out.regions, (std::vector<std::uint16_t>{0, 0, 0, 0, 0, kOut, 1, 1, 1}));
  EXPECT_TRUE(any_contains(out.notes, "\"a\" 1 (1 voxel), \"b\" 1 (1 voxel)"));
  // However much is asked for, no region is lost.
  options.islands = 1e9;
  const LabelImage all = cleaned(image, options);
  EXPECT_NE(std::count(all.regions.begin(), all.regions.end(), 0), 0);
  EXPECT_NE(std::count(all.regions.begin(), all.regions.end(), 1), 0);
}

TEST(Cleaning, VolumesAreThoseOfTheWorld) {
  LabelImage image = label_image({5, 1, 1}, {0, kOut, 0, 0, kOut}, 1);
  image.grid.axes[0] = {2, 0, 0};
  image.grid.axes[2] = {0, 1, 3};
  CleanOptions options;
  options.islands = 6;  // a voxel has just that
  EXPECT_EQ(cleaned(image, options).regions, image.regions);
  options.islands = 6.001;
  EXPECT_EQ(cleaned(image, options).regions[0], kOut);
}

/// A layer of c, one voxel thick, between a and b; a reaches b through a square hole of `hole` voxels.
LabelImage layers_with_hole(std::uint32_t hole) {
  constexpr std::uint32_t n = 24;
  std::vector<std::uint16_t> regions;
  for (std::uint32_t v = 0; v < n * n * n; ++v) {
    const std::uint32_t i = v % n, j = v / n % n, k = v / (n * n);
    const bool in_hole = i >= 7 && i < 7 + hole && j >= 7 && j < 7 + hole;
    regions.push_back(k < 10 ? 0 : k > 10 ? 1 : in_hole ? 0 : 2);
  }
  return label_image({n, n, n}, regions, 3);
}

TEST(Cleaning, ASmallContactGoesToWhatLiesAroundIt) {
  CleanOptions options;
  options.contacts = 16;
  const LabelImage closed = cleaned(layers_with_hole(2), options);
  EXPECT_EQ(closed.regions, layers_with_hole(0).regions);
  EXPECT_TRUE(any_contains(closed.notes, "1 spot cleared, by 4 voxels: \"a\" and \"b\" 1"));
  const LabelImage wide = layers_with_hole(6);
  EXPECT_EQ(cleaned(wide, options).regions, wide.regions);
  options.contacts = 1;  // edges of one voxel: nothing is smaller
  EXPECT_EQ(cleaned(layers_with_hole(2), options).regions, layers_with_hole(2).regions);
}

/// How many pieces each region has.
std::vector<std::size_t> pieces_of(const LabelImage& image) {
  const image::Runs runs(image.grid.size, image.regions);
  std::vector<std::set<std::uint32_t>> pieces(image.labels.size());
  for (std::size_t r = 0; r < runs.size(); ++r)
    if (runs.run(r).region != kOut) pieces[runs.run(r).region].insert(runs.piece()[r]);
  std::vector<std::size_t> counts;
  for (const auto& of : pieces) counts.push_back(of.size());
  return counts;
}

TEST(Cleaning, SmallContactsCostNoRegionAndCutNone) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    // Cells around random points, their borders shaken by a voxel: contacts of all sizes.
    std::mt19937 random(seed);
    constexpr std::uint32_t n = 32;
    std::array<Vec3, 9> seeds;
    for (Vec3& p : seeds) p = {double(random() % n), double(random() % n), double(random() % n)};
    std::vector<std::uint16_t> regions;
    for (std::uint32_t v = 0; v < n * n * n; ++v) {
      const Vec3 p{double(v % n), double(v / n % n), double(v / (n * n))};
      std::uint16_t best = 0;
      double least = HUGE_VAL;
      for (std::uint16_t s = 0; s < seeds.size(); ++s) {
        const double away = length(p - seeds[s]) + double(random() % 3);
        if (away < least) least = away, best = s;
      }
      regions.push_back(best == 8 ? kOut : best);
    }
    CleanOptions islands, contacts;
    islands.islands = 8;
    contacts.contacts = 16;
    const LabelImage before = cleaned(label_image({n, n, n}, regions, 8), islands);
    const LabelImage after = cleaned(before, contacts);
    EXPECT_NE(after.regions, before.regions);
    const auto was = pieces_of(before), is = pieces_of(after);
    for (std::size_t l = 0; l < was.size(); ++l) {
      EXPECT_LE(is[l], was[l]) << "label " << l << ", seed " << seed;
      EXPECT_EQ(is[l] == 0, was[l] == 0);
      const auto voxels = [&](const LabelImage& of) {
        return static_cast<double>(std::count(of.regions.begin(), of.regions.end(), l));
      };
      EXPECT_LE(std::abs(voxels(after) - voxels(before)), std::max(1.0, 0.01 * voxels(before)));
    }
  }
}

TEST(Cleaning, HolesInsideAreFilledAndBaysAreNot) {
  std::vector<std::uint16_t> regions(125, 0);
  regions[2 + 5 * (2 + 5 * 2)] = kOut;  // inside
  regions[0 + 5 * (2 + 5 * 2)] = kOut;  // at the edge
  CleanOptions options;
  options.holes = 1.5;
  const LabelImage out = cleaned(label_image({5, 5, 5}, regions, 1), options);
  EXPECT_EQ(out.regions[62], 0);
  EXPECT_EQ(out.regions[60], kOut);
  options.holes = 1;
  EXPECT_EQ(cleaned(label_image({5, 5, 5}, regions, 1), options).regions[62], kOut);
}

TEST(Cleaning, SpecksGoWhileTheyAreOneInAHundred) {
  constexpr std::uint32_t n = 12;
  const auto at = [](std::uint32_t i, std::uint32_t j, std::uint32_t k) { return i + n * (j + n * k); };
  std::vector<std::uint16_t> regions(n * n * n, 0);  // 1,728 voxels of the first region
  regions[at(3, 3, 3)] = kOut;
  regions[at(3, 3, 4)] = kOut;                                      // a hole of two
  for (std::uint32_t i = 5; i < 11; ++i) regions[at(i, 5, 5)] = 1;  // most of the second region,
  for (const std::uint32_t i : {2u, 8u}) regions[at(i, 9, 9)] = 1;  // and a quarter of it elsewhere
  for (std::uint32_t k = 0; k < n; ++k)
    for (std::uint32_t j = 0; j < n; ++j) regions[at(0, j, k)] = 2;  // 144 of the third,
  regions[at(4, 2, 8)] = 2;                                          // one elsewhere,
  for (const std::uint32_t i : {6u, 7u}) regions[at(i, 2, 8)] = 2;   // and two, which would be one too many
  CleanOptions options;
  options.specks = 3.5;
  const LabelImage out = cleaned(label_image({n, n, n}, regions, 3), options);
  EXPECT_EQ(out.regions[at(3, 3, 3)], 0);
  EXPECT_EQ(out.regions[at(3, 3, 4)], 0);
  EXPECT_EQ(out.regions[at(2, 9, 9)], 1);
  EXPECT_EQ(out.regions[at(8, 9, 9)], 1);
  EXPECT_EQ(out.regions[at(4, 2, 8)], 0);
  EXPECT_EQ(out.regions[at(6, 2, 8)], 2);
  ASSERT_EQ(out.notes.size(), 1u);
  EXPECT_NE(out.notes[0].find("1 (1 voxel); holes: 1 filled (2 voxels)"), std::string::npos) << out.notes[0];
}

TEST(Cleaning, GapsCloseUpToTwiceTheReach) {
  for (std::uint32_t gap = 1; gap <= 6; ++gap)
    for (std::uint32_t reach = 1; reach <= 3; ++reach) {
      // Two walls with a gap between them, which are wide: what is near their edges stays open.
      constexpr std::uint32_t n = 17;
      std::vector<std::uint16_t> regions;
      for (std::uint32_t v = 0; v < 20 * n * n; ++v) {
        const std::uint32_t i = v % 20;
        const bool is_wall = (i >= 3 && i < 6) || (i >= 6 + gap && i < 9 + gap);
        regions.push_back(is_wall ? std::uint16_t{0} : kOut);
      }
      CleanOptions options;
      options.closing = reach;
      const LabelImage out = cleaned(label_image({20, n, n}, regions, 1), options);
      const std::size_t middle = 6 + 20 * (n / 2 + n * (n / 2));
      EXPECT_EQ(out.regions[middle] == 0, gap <= 2 * reach) << gap << " " << reach;
      for (std::size_t v = 0; v < regions.size(); ++v)
        if (regions[v] == 0) {
          ASSERT_EQ(out.regions[v], 0);
        }
    }
}

TEST(Cleaning, ClosingTakesNothingFromOthersAndIsTheSameOnAnyThreads) {
  std::mt19937 random(5);
  std::vector<std::uint16_t> regions;
  for (int v = 0; v < 30 * 20 * 25; ++v)
    regions.push_back(random() % 5 == 0 ? kOut : static_cast<std::uint16_t>(random() % 3));
  const LabelImage image = label_image({30, 20, 25}, regions, 3);
  CleanOptions options;
  options.closing = 2;
  RunContext one, many;
  one.threads = 1;
  many.threads = 4;
  const LabelImage closed = cleaned(image, options, one);
  for (std::size_t v = 0; v < regions.size(); ++v)
    if (regions[v] != kOut) {
      ASSERT_EQ(closed.regions[v], regions[v]);
    }
  options.islands = 8;
  options.holes = 8;
  EXPECT_EQ(cleaned(image, options, one).regions, cleaned(image, options, many).regions);
}

TEST(Grid, CroppingKeepsPlaces) {
  Image image = testing::sample_image();
  image.grid.slices = {0, 1, 2.5};
  const Image part = cropped(image, {{1, 2, 1}, {4, 4, 3}});
  EXPECT_EQ(part.grid.size, (std::array<std::uint32_t, 3>{3, 2, 2}));
  EXPECT_EQ(part.grid.slices, (std::vector<double>{0, 1.5}));
  const auto& values = std::get<std::vector<std::int16_t>>(part.values);
  const auto& all = testing::sample_values();
  EXPECT_EQ(values[0], all[1 + 5 * (2 + 4 * 1)]);
  EXPECT_EQ(values.back(), all[3 + 5 * (3 + 4 * 2)]);
  EXPECT_LT(distance(part.grid.to_world({2, 1, part.grid.slice(1)}), image.grid.to_world({3, 3, 2.5})), 1e-12);
  EXPECT_THROW(cropped(image, {{1, 2, 1}, {1, 4, 3}}), OptionError);
  EXPECT_THROW(cropped(image, {{1, 2, 1}, {4, 5, 3}}), OptionError);
}

TEST(Grid, ResamplingGreyKeepsMeansAndSlopes) {
  // A ramp along i; coarser voxels have the mean, finer ones lie on the line.
  Image ramp = image_of<std::int16_t>({8, 2, 2}, {});
  std::vector<std::int16_t> values;
  for (int v = 0; v < 32; ++v) values.push_back(static_cast<std::int16_t>(10 * (v % 8)));
  ramp.values = values;
  const Image coarse = resampled(ramp, {2, 1, 1}, false);
  EXPECT_EQ(coarse.grid.size, (std::array<std::uint32_t, 3>{4, 2, 2}));
  EXPECT_EQ(coarse.grid.origin.x, 0.5);
  EXPECT_EQ(std::get<std::vector<float>>(coarse.values)[1], 25);
  const Image fine = resampled(ramp, {0.5, 1, 1}, false);
  EXPECT_EQ(fine.grid.size[0], 16U);
  EXPECT_EQ(fine.grid.origin.x, -0.25);
  EXPECT_EQ(std::get<std::vector<float>>(fine.values)[5], 22.5F);
  EXPECT_THROW(resampled(ramp, {0, 1, 1}, false), OptionError);
  EXPECT_THROW(resampled(ramp, {1e-9, 1, 1}, false), OptionError);
}

TEST(Grid, ResamplingLabelsTakesTheMostAndSaysWhatIsLost) {
  Image image = image_of<std::uint8_t>({6, 1, 1}, {1, 1, 1, 9, 2, 2});
  const Image coarse = resampled(image, {3, 1, 1}, true);
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(coarse.values), (std::vector<std::uint8_t>{1, 2}));
  EXPECT_TRUE(any_contains(coarse.notes, "labels 9"));
  const Image fine = resampled(image, {0.5, 0.5, 1}, true);
  EXPECT_EQ(fine.grid.voxels(), 24U);
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(fine.values)[6], 9);
  // Unequal slices become even, between the same faces.
  Image uneven = image_of<std::uint8_t>({1, 1, 3}, {1, 2, 3});
  uneven.grid.slices = {0, 1, 4};
  const Image even = resampled(uneven, {1, 1, 1}, true);
  EXPECT_TRUE(even.grid.slices.empty());
  // Faces lie at -.5, .5, 2.5 and 5.5.
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(even.values), (std::vector<std::uint8_t>{1, 2, 2, 3, 3, 3}));
  EXPECT_EQ(even.grid.origin.z, 0);
}

}  // namespace
}  // namespace octafront
