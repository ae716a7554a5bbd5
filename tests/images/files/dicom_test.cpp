#include <octafront/error.h>
#include <octafront/image.h>

#include "images/files/dicom/series.h"
#include "images/files/dicom/unpack.h"
#include "images/small_images.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::any_contains;
using testing::contains;
using testing::dicom_slice;
using testing::DicomSlice;
using testing::input_error;

Image read_slices(const std::vector<DicomSlice>& slices, ImageChoice choice = {}, bool skip = false) {
  std::vector<std::string> names, bytes;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    names.push_back(fmt::format("s{}.dcm", k));
    bytes.push_back(slices[k].bytes());
  }
  const auto open = [&](std::size_t f) { return image::KeptFile{{names[f], bytes[f]}, nullptr}; };
  return image::read_series({names, open, skip}, choice, RunContext{});
}

std::vector<DicomSlice> sample_slices(DicomSlice::Syntax syntax = DicomSlice::Syntax::kExplicit) {
  std::vector<DicomSlice> slices;
  for (std::size_t k = 0; k < 3; ++k) {
    slices.push_back(dicom_slice(k));
    slices.back().syntax = syntax;
  }
  return slices;
}

std::vector<std::int16_t> values_of(const Image& image) {
  return std::get<std::vector<std::int16_t>>(image.values);
}

/// Slices straight above one another, at these heights.
std::vector<DicomSlice> stack(const std::vector<double>& heights) {
  std::vector<DicomSlice> slices;
  for (std::size_t k = 0; k < heights.size(); ++k) {
    DicomSlice s = dicom_slice(0);
    s.at = {0, 0, heights[k]};
    s.directions = {1, 0, 0, 0, 1, 0};
    s.spacing = {1, 1};
    s.instance = static_cast<int>(k) + 1;
    slices.push_back(s);
  }
  return slices;
}

TEST(Dicom, EverySyntaxAndOrderGivesTheSameVolume) {
  using Syntax = DicomSlice::Syntax;
  Image expected = testing::sample_image();
  expected.grid.axes[0] = expected.grid.axes[0] * -1.0;
  for (const Syntax syntax : {Syntax::kExplicit, Syntax::kImplicit, Syntax::kBigEndian, Syntax::kRle}) {
    std::vector<DicomSlice> slices = sample_slices(syntax);
    std::swap(slices[0], slices[2]);
    std::swap(slices[0], slices[1]);
    const Image image = read_slices(slices);
    EXPECT_EQ(image.grid.size, expected.grid.size);
    EXPECT_EQ(values_of(image), testing::sample_values());
    for (std::size_t a = 0; a < 3; ++a) EXPECT_LT(distance(image.grid.axes[a], expected.grid.axes[a]), 1e-6);
    EXPECT_LT(distance(image.grid.origin, expected.grid.origin), 1e-6);
    EXPECT_EQ(image.frame, "LPS");
    EXPECT_TRUE(any_contains(image.notes, "tilted gantry"));
  }
}

TEST(Dicom, WithoutPreambleToo) {
  std::vector<DicomSlice> slices = sample_slices(DicomSlice::Syntax::kImplicit);
  for (DicomSlice& s : slices) s.with_preamble = false;
  EXPECT_EQ(values_of(read_slices(slices)), testing::sample_values());
  EXPECT_TRUE(image::is_dicom(slices[0].bytes()));
}

TEST(Dicom, SlopesAndBitsAreMinded) {
  std::vector<DicomSlice> slices = stack({0, 1});
  for (DicomSlice& s : slices) {
    s.slope = 2;
    s.intercept = -1024;
    s.bits_stored = 12;
    // Bits above those stored are others' (overlays); the twelfth is the sign.
    s.pixels.assign(20, static_cast<std::int16_t>(0x7005));
    s.pixels[1] = static_cast<std::int16_t>(0x0fff);
  }
  const std::vector<std::int16_t> v = values_of(read_slices(slices));
  EXPECT_EQ(v[0], 2 * 5 - 1024);
  EXPECT_EQ(v[1], 2 * -1 - 1024);
  slices[1].slope = 0.5;
  const Image reals = read_slices(slices);
  EXPECT_EQ(std::get<std::vector<float>>(reals.values)[20], 0.5F * 5 - 1024);
}

TEST(Dicom, JitterIsEvenAndUnequalDistancesAreKept) {
  EXPECT_TRUE(read_slices(stack({0, 1.002, 2.001, 3})).grid.slices.empty());
  const Image uneven = read_slices(stack({0, 1, 2, 3.4, 4.4}));
  ASSERT_EQ(uneven.grid.slices.size(), 5U);
  EXPECT_NEAR(uneven.grid.slices[3], 3.4, 1e-9);
  EXPECT_NEAR(uneven.grid.axes[2].z, 1, 1e-9);
  EXPECT_TRUE(any_contains(uneven.notes, "1 to 1.4 apart"));
  EXPECT_FALSE(any_contains(uneven.notes, "missing"));
}

TEST(Dicom, MissingSlicesAreNamed) {
  const Image image = read_slices(stack({0, 1, 2, 5, 6, 7}));
  EXPECT_TRUE(any_contains(image.notes, "2 slices are missing: 2 between s2.dcm and s3.dcm"));
  EXPECT_NEAR(image.grid.slices[3], 5, 1e-9);
}

TEST(Dicom, SeriesAreToldApart) {
  std::vector<DicomSlice> slices = stack({0, 1, 2});
  DicomSlice other = slices[0];
  other.series = "9.9";
  other.series_number = 7;
  other.description = "BONE";
  other.thickness = 3;
  other.pixels[0] = 77;
  slices.push_back(other);
  // A localiser in the same series, in another plane.
  DicomSlice localiser = slices[1];
  localiser.directions = {0, 1, 0, 0, 0, 1};
  localiser.thickness = 5;
  slices.push_back(localiser);
  const std::string list = input_error([&] { read_slices(slices); });
  EXPECT_TRUE(contains(list, "3 series")) << list;
  EXPECT_TRUE(contains(list, "1: CT \"HEAD\", 3 slices of 5 x 4 pixels")) << list;
  EXPECT_TRUE(contains(list, "3: CT \"BONE\", 1 slice")) << list;
  const Image bone = read_slices(slices, {3});
  EXPECT_EQ(values_of(bone)[0], 77);
  EXPECT_NEAR(bone.grid.axes[2].z, 3, 1e-9);
  EXPECT_TRUE(any_contains(bone.notes, "single slice"));
  EXPECT_TRUE(contains(input_error([&] { read_slices(slices, {4}); }), "3 series"));
}

TEST(Dicom, TimesOfOnePlaceAreVolumes) {
  std::vector<DicomSlice> slices = stack({0, 1, 0, 1});
  slices[2].pixels[0] = slices[3].pixels[0] = 50;
  EXPECT_TRUE(contains(input_error([&] { read_slices(slices); }), "image 2 of 2"));
  EXPECT_EQ(values_of(read_slices(slices, {2}))[0], 50);
  EXPECT_EQ(read_slices(slices, {2}).grid.size[2], 2U);
}

TEST(Dicom, StacksThatBendAreRefused) {
  std::vector<DicomSlice> slices = stack({0, 1, 2});
  slices[1].at[0] = 3;
  EXPECT_TRUE(contains(input_error([&] { read_slices(slices); }), "s1.dcm: lies 3 beside the line"));
}

TEST(Dicom, WhatIsNotReadIsRefusedByName) {
  std::vector<DicomSlice> slices = stack({0, 1});
  slices[0].syntax = slices[1].syntax = DicomSlice::Syntax::kJpeg;
  const std::string message = input_error([&] { read_slices(slices); });
  // These say that they are JPEG, and are not.
  EXPECT_TRUE(contains(message, image::has_gdcm() ? "cannot be unpacked" : "JPEG Lossless, first-order prediction"))
      << message;
  // In a folder what cannot be read here is passed over.
  std::vector<DicomSlice> mixed = stack({0, 1, 2});
  mixed[2].syntax = DicomSlice::Syntax::kJpeg;
  if (!image::has_gdcm()) {
    const Image image = read_slices(mixed, {}, true);
    EXPECT_EQ(image.grid.size[2], 2U);
    EXPECT_TRUE(any_contains(image.notes, "1 file was passed over"));
  }
  DicomSlice single = dicom_slice(0);
  EXPECT_TRUE(contains(input_error([&] { read_slices({single}); }), "without thickness"));
  single.pixels.resize(3);
  single.thickness = 1;
  EXPECT_TRUE(contains(input_error([&] { read_slices({single}); }), "truncated"));
}

TEST(Dicom, AnyByteMayChangeOrBeMissing) {
  using Syntax = DicomSlice::Syntax;
  for (const Syntax syntax : {Syntax::kExplicit, Syntax::kImplicit, Syntax::kBigEndian, Syntax::kRle}) {
    DicomSlice slice = dicom_slice(0);
    slice.syntax = syntax;
    slice.thickness = 1;
    const std::string bytes = slice.bytes();
    const auto read = [](const std::string& changed) {
      try {
        testing::read_small({"a.dcm", changed});
        return true;
      } catch (const InputError&) {
        return false;
      }
    };
    EXPECT_TRUE(read(bytes));
    // Pixels come last: without the end there are too few; a byte that ends fragments may be missing.
    for (std::size_t n = 140; n + 9 < bytes.size(); n += 3) EXPECT_FALSE(read(bytes.substr(0, n))) << n;
    for (std::size_t n = 0; n < bytes.size(); ++n)
      for (const char c : {'\0', '\xff', '9'}) {
        std::string changed = bytes;
        changed[n] = c;
        read(changed);
      }
  }
}

}  // namespace
}  // namespace octafront
