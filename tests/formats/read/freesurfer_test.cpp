#include <octafront/error.h>
#include <octafront/io.h>

#include "formats/read/readers.h"

#include <bit>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace octafront::io {
namespace {

using namespace std::string_literals;
using ::testing::HasSubstr;

std::string big_endian(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}
std::string big_endian(float value) {
  return big_endian(std::bit_cast<std::uint32_t>(value));
}

/// A tetrahedron with corners at the origin and at 1, 2 and 3 along the axes.
std::string tetrahedron(const std::string& footer = "") {
  std::string bytes = "\xff\xff\xfe"s + "created by hand\n\n" + big_endian(4u) + big_endian(4u);
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f, 3.f}) bytes += big_endian(x);
  for (const std::uint32_t v : {0u, 2u, 1u, 0u, 1u, 3u, 0u, 3u, 2u, 1u, 2u, 3u}) bytes += big_endian(v);
  return bytes + footer;
}

const std::string kFooter =
    big_endian(2u) + big_endian(0u) + big_endian(20u) +
    "valid = 1  # volume info valid\nfilename = orig.mgz\nvolume = 256 256 256\n"
    "voxelsize = 1 1 1\nxras   = -1 0 0\nyras   = 0 0 -1\nzras   = 0 1 0\ncras   = 10 -20 30.5\n";

TEST(FreeSurfer, TrianglesComeInTheScannersCoordinates) {
  const std::string bytes = tetrahedron(kFooter);
  const SurfaceFile file = read_freesurfer({"lh.pial", bytes});
  EXPECT_EQ(file.format, "FreeSurfer");
  ASSERT_EQ(file.surface.triangles.size(), 4u);
  EXPECT_EQ(file.surface.points[0], (Vec3{10, -20, 30.5}));
  EXPECT_EQ(file.surface.points[1], (Vec3{11, -20, 30.5}));
  EXPECT_EQ(file.surface.points[2], (Vec3{10, -18, 30.5}));
  EXPECT_EQ(file.surface.points[3], (Vec3{10, -20, 33.5}));
  EXPECT_DOUBLE_EQ(enclosed_volume(file.surface), 1);
}

TEST(FreeSurfer, WithoutAVolumeItIsSaid) {
  const std::string bytes = tetrahedron();
  const SurfaceFile file = read_freesurfer({"lh.pial", bytes});
  EXPECT_EQ(file.surface.points[1], (Vec3{1, 0, 0}));
  EXPECT_THAT(file.notes, ::testing::Contains(HasSubstr("does not say where its volume lies")));
}

TEST(FreeSurfer, WhatIsMissingIsTold) {
  const std::string whole = tetrahedron();
  const auto words = [](std::string bytes) -> std::string {
    try {
      read_freesurfer({"lh.pial", bytes});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(words(whole.substr(0, 10)), HasSubstr("its stamp does not end"));
  EXPECT_THAT(words(whole.substr(0, 24)), HasSubstr("counts of vertices"));
  EXPECT_THAT(words(whole.substr(0, 60)), HasSubstr("vertices"));
  EXPECT_THAT(words(whole.substr(0, whole.size() - 5)), HasSubstr("triangles"));
  std::string far = whole;
  far.replace(whole.size() - 4, 4, big_endian(9u));
  EXPECT_THAT(words(far), HasSubstr("9"));
}

}  // namespace
}  // namespace octafront::io
