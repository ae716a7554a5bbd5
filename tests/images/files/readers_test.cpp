#include <octafront/error.h>
#include <octafront/image.h>

#include "images/small_images.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::any_contains;
using testing::contains;
using testing::input_error;
using testing::Nifti;
using testing::raw;
using testing::read_small;
using testing::sample_image;
using testing::sample_values;
using testing::SmallImage;

void expect_near(Vec3 a, Vec3 b) {
  EXPECT_LT(distance(a, b), 1e-6 * (1 + length(b))) << a.x << " " << a.y << " " << a.z;
}

void expect_values(const Image& image, const std::vector<double>& expected) {
  const auto values = std::visit([](const auto& v) { return std::vector<double>(v.begin(), v.end()); }, image.values);
  EXPECT_EQ(values, expected);
}

std::vector<double> sample_numbers() {
  const std::vector<std::int16_t> v = sample_values();
  return {v.begin(), v.end()};
}

TEST(ImageReaders, EveryKindGivesTheSameImage) {
  const ImageGrid expected = sample_image().grid;
  for (const SmallImage& file : testing::sheared_images()) {
    SCOPED_TRACE(file.name);
    const Image image = read_small(file);
    EXPECT_EQ(image.grid.size, expected.size);
    for (std::size_t a = 0; a < 3; ++a) expect_near(image.grid.axes[a], expected.axes[a]);
    expect_near(image.grid.origin, expected.origin);
    EXPECT_TRUE(image.grid.slices.empty());
    expect_values(image, sample_numbers());
    EXPECT_EQ(image.frame, file.name.find(".nii") != std::string::npos || file.name.find(".hdr") != std::string::npos
                               ? "RAS"
                               : "LPS");
    EXPECT_FALSE(image.format.empty());
  }
}

Nifti tiny() {
  Nifti n;
  n.dim = {3, 2, 1, 1, 1, 1, 1, 1};
  n.voxels = raw(std::vector<std::int16_t>{3, -4});
  return n;
}

Image read_nifti(const Nifti& n) {
  return read_small({"a.nii", n.bytes()});
}

TEST(Nifti, QuaternionsTurnAndFlip) {
  Nifti n = tiny();
  n.qform_code = 1;
  n.pixdim = {-1, 2, 3, 4, 1, 1, 1, 1};
  // Half of a right angle doubled: a quarter turn about z.
  const double h = std::sqrt(0.5);
  n.quaternion = {0, 0, h, 10, 20, 30};
  const Image image = read_nifti(n);
  expect_near(image.grid.axes[0], {0, 2, 0});
  expect_near(image.grid.axes[1], {-3, 0, 0});
  expect_near(image.grid.axes[2], {0, 0, -4});
  expect_near(image.grid.origin, {10, 20, 30});
  EXPECT_TRUE(contains(image.format, "qform"));
  EXPECT_EQ(image.unit, "mm");
}

TEST(Nifti, TheSformGoesBeforeAndDisagreementIsSaid) {
  Nifti n = tiny();
  n.qform_code = n.sform_code = 1;
  n.rows = {{{1, 0, 0, 5}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  n.quaternion = {0, 0, 0, 5, 0, 0};
  EXPECT_TRUE(read_nifti(n).notes.empty());
  n.quaternion[3] = 5.002;
  const Image apart = read_nifti(n);
  EXPECT_EQ(apart.grid.origin.x, 5);
  EXPECT_TRUE(any_contains(apart.notes, "disagree by up to 0.002 voxels"));
  n.quaternion[3] = 5.0005;
  EXPECT_TRUE(read_nifti(n).notes.empty());
  // A map that is none is no map.
  n.rows = {};
  const Image by_quaternion = read_nifti(n);
  EXPECT_NEAR(by_quaternion.grid.origin.x, 5.0005, 1e-6);
  EXPECT_TRUE(any_contains(by_quaternion.notes, "no invertible map"));
}

TEST(Nifti, WithoutFormsSpacingIsAllThereIs) {
  Nifti n = tiny();
  n.pixdim = {1, 2, 0, 4, 1, 1, 1, 1};
  const Image image = read_nifti(n);
  expect_near(image.grid.axes[0], {2, 0, 0});
  expect_near(image.grid.axes[1], {0, 1, 0});
  EXPECT_EQ(image.frame, "");
  EXPECT_TRUE(any_contains(image.notes, "no spacing along axis 1"));
  EXPECT_TRUE(any_contains(image.notes, "does not say where"));
}

TEST(Nifti, TypesSlopesAndWhatIsNotFinite) {
  Nifti n = tiny();
  n.slope = 2;
  n.intercept = -1000;
  Image image = read_nifti(n);
  expect_values(image, {-994, -1008});
  EXPECT_TRUE(std::holds_alternative<std::vector<std::int16_t>>(image.values));
  n.slope = 0.5;
  n.intercept = 0;
  image = read_nifti(n);
  expect_values(image, {1.5, -2});
  EXPECT_TRUE(std::holds_alternative<std::vector<float>>(image.values));
  n = tiny();
  n.datatype = 1024;
  n.voxels = raw(std::vector<std::int64_t>{7, 70000});
  image = read_nifti(n);
  expect_values(image, {7, 70000});
  EXPECT_TRUE(std::holds_alternative<std::vector<std::int32_t>>(image.values));
  n.datatype = 64;
  n.voxels = raw(std::vector<double>{std::nan(""), 1.5});
  image = read_nifti(n);
  expect_values(image, {1.5, 1.5});
  EXPECT_TRUE(any_contains(image.notes, "1 voxel has no finite value"));
  n.datatype = 16;
  n.voxels = raw(std::vector<float>{std::numeric_limits<float>::infinity(), 2});
  expect_values(read_nifti(n), {2, 2});
  // Beyond single precision.
  n.datatype = 64;
  n.voxels = raw(std::vector<double>{1e300, 2e300});
  const double largest = std::numeric_limits<float>::max();
  expect_values(read_nifti(n), {largest, largest});
  n.datatype = 128;
  EXPECT_TRUE(contains(input_error([&] { read_nifti(n); }), "colours"));
}

TEST(Nifti, LabelsStoredAsFloatsAreRounded) {
  Nifti n = tiny();
  n.datatype = 16;
  n.voxels = raw(std::vector<float>{2.0000305F, 0});
  Image image = read_nifti(n);
  expect_values(image, {2, 0});
  EXPECT_TRUE(any_contains(image.notes, "they are rounded"));
  EXPECT_TRUE(looks_like_labels(image));
  // Values that are just small are no labels, nor are those farther from whole numbers.
  n.voxels = raw(std::vector<float>{0.0007F, 0.0003F});
  EXPECT_TRUE(std::holds_alternative<std::vector<float>>(read_nifti(n).values));
  n.voxels = raw(std::vector<float>{1.25F, 0});
  expect_values(read_nifti(n), {1.25, 0});
}

TEST(Nifti, OneOfSeveralVolumesIsChosen) {
  Nifti n = tiny();
  n.dim = {4, 2, 1, 1, 3, 1, 1, 1};
  n.voxels = raw(std::vector<std::int16_t>{1, 2, 3, 4, 5, 6});
  EXPECT_TRUE(contains(input_error([&] { read_nifti(n); }), "holds 3 volumes"));
  expect_values(read_small({"a.nii", n.bytes()}, {2}), {3, 4});
  EXPECT_TRUE(contains(input_error([&] { read_small({"a.nii", n.bytes()}, {4}); }), "number 4"));
}

TEST(Nrrd, ListsOfValuesAndNamesOfSegments) {
  const std::string head =
      "NRRD0004\ntype: uchar\ndimension: 4\nspace dimension: 3\nsizes: 2 3 1 1\nspace directions: none (1,0,0) "
      "(0,1,0) (0,0,1)\nkinds: list domain domain domain\nencoding: raw\nSegment0_Name:=liver\n"
      "Segment0_LabelValue:=3\nSegment0_Layer:=1\nSegment1_Name:=other layer\nSegment1_LabelValue:=3\n"
      "Segment1_Layer:=0\n\n";
  const SmallImage file{"a.seg.nrrd", head + std::string("\1\2\3\4\5\6")};
  const Image image = read_small(file, {2});
  expect_values(image, {2, 4, 6});
  EXPECT_EQ(image.names, (std::vector<LabelName>{{3, "liver"}}));
  // Without a choice layers of segments are put together, a number for each segment.
  const Image all = read_small(file);
  expect_values(all, {0, 2, 0});
  EXPECT_EQ(all.names, (std::vector<LabelName>{{1, "liver"}, {2, "other layer"}}));
  EXPECT_TRUE(any_contains(all.notes, "without a voxel: liver"));
  const SmallImage lists{"a.nrrd", head.substr(0, head.find("Segment0")) + "\n" + std::string("\1\2\3\4\5\6")};
  EXPECT_TRUE(contains(input_error([&] { read_small(lists); }), "holds 2"));
}

struct BadImage {
  std::string what;
  SmallImage file;
  std::vector<std::string> fragments;  ///< the message must contain all of them
};

TEST(BadImages, ErrorsSayWhereAndWhat) {
  Nifti huge = tiny();
  huge.dim = {3, 30000, 30000, 3000, 1, 1, 1, 1};
  Nifti large = tiny();
  large.dim = {3, 3000, 3000, 300, 1, 1, 1, 1};
  Nifti negative = tiny();
  negative.dim[2] = -3;
  Nifti early = tiny();
  early.offset = 12;
  Nifti flat = tiny();
  flat.dim[0] = 2;
  Nifti folded = tiny();
  folded.sform_code = 1;
  folded.rows = {{{1, 1, 0, 0}, {0, 1e-9, 0, 0}, {0, 0, 1, 0}}};
  // A byte of its checksum.
  std::string damaged = testing::gzip(tiny().bytes());
  damaged[damaged.size() - 6] = static_cast<char>(~damaged[damaged.size() - 6]);
  const std::string nrrd = "NRRD0004\ntype: short\ndimension: 3\nsizes: 2 1 1\nencoding: raw\n";
  const std::string meta = "ObjectType = Image\nNDims = 3\nDimSize = 2 1 1\nElementType = MET_SHORT\n";
  const std::vector<BadImage> files{
      {"too many voxels", {"a.nii", huge.bytes()}, {"a.nii", "30000 x 30000 x 3000", "more than"}},
      {"claimed voxels", {"a.nii", large.bytes()}, {"byte 352", "5400000000 bytes", "only 4", "truncated"}},
      {"claimed voxels, packed", {"a.nii.gz", testing::gzip(large.bytes())}, {"unpacked", "at most"}},
      {"negative size", {"a.nii", negative.bytes()}, {"2 x -3 x 1"}},
      {"voxels in the header", {"a.nii", early.bytes()}, {"begin at byte 12"}},
      {"flat", {"a.nii", flat.bytes()}, {"flat image", "three dimensions"}},
      {"axes in a plane", {"a.nii", folded.bytes()}, {"in one plane"}},
      {"damaged gzip", {"a.nii.gz", damaged}, {"a.nii.gz", "byte", "compressed data are damaged"}},
      {"no img", {"a.hdr", testing::sheared_images()[1].bytes}, {"a.img", "no such file"}},
      {"nrrd without endian", {"a.nrrd", nrrd + "\n1234"}, {"endian"}},
      {"nrrd bzip2",
       {"a.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1 1\nencoding: bzip2\n\n12"},
       {"line 5", "bzip2", "raw or gzip"}},
      {"nrrd truncated", {"a.nrrd", nrrd + "endian: little\n\n123"}, {"4 bytes", "only 3"}},
      {"nrrd sizes",
       {"a.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1\nencoding: raw\n\n12"},
       {"line 4", "2 values for 3"}},
      {"nrrd word", {"a.nrrd", "NRRD0004\ntype: uchar\nsome words\n\n12"}, {"line 3", "some words"}},
      {"nrrd type",
       {"a.nrrd", "NRRD0004\ntype: quad\ndimension: 3\nsizes: 1 1 1\nendian: little\nencoding: raw\n\n1"},
       {"line 2", "quad"}},
      {"meta without data", {"a.mha", meta}, {"ElementDataFile", "truncated"}},
      {"meta truncated", {"a.mha", meta + "ElementDataFile = LOCAL\n123"}, {"4 bytes", "only 3"}},
      {"meta channels",
       {"a.mha", meta + "ElementNumberOfChannels = 3\nElementDataFile = LOCAL\n123"},
       {"line 5", "3 values per voxel"}},
      {"meta shares", {"a.mhd", meta + "ElementDataFile = s%d.raw 1 3 1\n"}, {"3 files for 2 voxels"}},
      {"json", {"a.json", "{\"size\": [1,1,1], \"type\": \"int16\","}, {"byte", "JSON"}},
      {"json key", {"a.json", "{\"size\": [1,1,1], \"type\": \"int16\", \"spacings\": 3}"}, {"spacings"}},
      {"json type", {"a.json", "{\"size\": [1,1,1], \"type\": \"int7\"}", {{"a.raw", "12"}}}, {"\"type\""}},
      {"prose", {"a.txt", "Dear reader, this is no image."}, {"no image of a kind", "Dear reader"}},
  };
  for (const BadImage& bad : files) {
    SCOPED_TRACE(bad.what);
    const std::string message = input_error([&] { read_small(bad.file); });
    for (const std::string& part : bad.fragments) EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST(BadImages, CutOffAnywhereTheyAreRefused) {
  for (const SmallImage& file : testing::sheared_images()) {
    SCOPED_TRACE(file.name);
    const bool is_text = file.name.starts_with("d.");
    // Lists of files lack one of them when they are cut off in their last line; the JSON has all in its first two.
    for (std::size_t n = 1; n + (is_text ? 4 : 1) < file.bytes.size(); n += 1 + n / 40) {
      if (file.name.ends_with("hdr") || file.name.ends_with(".json")) continue;
      SmallImage cut = file;
      cut.bytes.resize(n);
      try {
        read_small(cut);
        // What compression pads with may be missing.
        if (file.name.find("gz") == std::string::npos && file.name != "c.nrrd" && file.name != "c.mha" &&
            cut.beside.empty())
          ADD_FAILURE() << "read without its end: " << n << " of " << file.bytes.size();
      } catch (const InputError&) {
      }
    }
  }
}

TEST(BadImages, AnyByteMayChange) {
  for (const SmallImage& file : testing::sheared_images())
    for (std::size_t n = 0; n < file.bytes.size(); n += 1 + file.bytes.size() / 300)
      for (const char c : {'\0', '\xff', '9'}) {
        SmallImage changed = file;
        changed.bytes[n] = c;
        try {
          const Image image = read_small(changed);
          std::visit([&](const auto& values) { EXPECT_EQ(values.size(), image.grid.voxels()); }, image.values);
        } catch (const InputError&) {
        }
      }
}

}  // namespace
}  // namespace octafront
