#include <octafront/error.h>
#include <octafront/picture.h>
#include <octafront/quality.h>
#include <octafront/run_context.h>

#include "report/picture/canvas.h"
#include "report/picture/colours.h"
#include "report/picture/raster.h"
#include "report/picture/scene.h"
#include "support/named_surfaces.h"
#include "support/rich_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <zlib.h>

namespace octafront {
namespace {

using Lab = std::array<double, 3>;
using Matrix = std::array<std::array<double, 3>, 3>;

/// Of D65, from linear red, green and blue.
Lab lab_of(const std::array<double, 3>& rgb) {
  constexpr Matrix kToXyz{
      {{0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}}};
  std::array<double, 3> f{};
  for (std::size_t i = 0; i < 3; ++i) {
    double x = 0, white = 0;
    for (std::size_t k = 0; k < 3; ++k) x += kToXyz[i][k] * rgb[k], white += kToXyz[i][k];
    x /= white;
    f[i] = x > 0.008856 ? std::cbrt(x) : 7.787 * x + 16.0 / 116;
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

/// As eyes see it that lack one kind of cones (Machado, Oliveira, Fernandes 2009, severity 1).
Lab as_seen(Rgb colour, const Matrix& eyes) {
  std::array<double, 3> linear{}, seen{};
  const std::array<std::uint8_t, 3> bytes{colour.r, colour.g, colour.b};
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = bytes[i] / 255.0;
    linear[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) seen[i] += eyes[i][k] * linear[k];
    seen[i] = std::clamp(seen[i], 0.0, 1.0);
  }
  return lab_of(seen);
}

constexpr std::array<Matrix, 4> kEyes{
    {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
     {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
     {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
     {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}}};

template <std::size_t N>
void expect_ordered(const std::array<Rgb, N>& stops) {
  for (const Matrix& eyes : kEyes)
    for (int i = 0; i < 20; ++i) {
      const Lab a = as_seen(on_scale(stops, i / 20.0), eyes), b = as_seen(on_scale(stops, (i + 1) / 20.0), eyes);
      EXPECT_GT(b[0], a[0]) << "lighter at every step, at " << i / 20.0;
      EXPECT_GT(std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]), 2.3) << "a difference that is seen, at " << i / 20.0;
    }
}

TEST(PictureColours, ScalesGetLighterForAllEyes) {
  expect_ordered(kPoorToGood);
  expect_ordered(kSmallToLarge);
}

TEST(PictureColours, TellWhatTheyAreWorthWhateverTheMesh) {
  EXPECT_EQ(on_scale(kPoorToGood, 0), kPoorToGood.front());
  EXPECT_EQ(on_scale(kPoorToGood, -1), kPoorToGood.front());
  EXPECT_EQ(on_scale(kPoorToGood, std::nan("")), kPoorToGood.front());
  EXPECT_EQ(on_scale(kPoorToGood, 0.2), kPoorToGood[1]);
  EXPECT_EQ(on_scale(kPoorToGood, 1), kPoorToGood.back());
  EXPECT_EQ(on_scale(kPoorToGood, 7), kPoorToGood.back());
}

TEST(StrokeFont, HasAGlyphForEachLetter) {
  const auto missing = stroke_font::strokes_of("\xe4\xbd\xa0");
  std::set<std::vector<std::pair<double, double>>> seen;
  const auto add = [&](const std::string& letter) {
    std::vector<std::pair<double, double>> points;
    for (const auto& stroke : stroke_font::strokes_of(letter))
      for (const auto& p : stroke) points.emplace_back(p.x, p.y);
    EXPECT_TRUE(seen.insert(points).second) << letter << " looks like another one";
  };
  for (char c = '!'; c <= '~'; ++c) add(std::string(1, c));
  for (int second = 0x80; second <= 0xbf; ++second)
    if (const std::string letter{'\xc3', static_cast<char>(second)};
        stroke_font::strokes_of(letter).size() != missing.size())
      add(letter);
  EXPECT_GE(seen.size(), 94u + 40u);
  EXPECT_EQ(missing.size(), 1u) << "a box";
  EXPECT_GT(stroke_font::width_of("mm"), stroke_font::width_of("m"));
  EXPECT_FALSE(stroke_font::strokes_of("\xff\xc3").empty()) << "what is no UTF-8";
}

/// Chunks of a PNG whose checks are right; the data inflated.
std::map<std::string, std::string> chunks_of(const std::string& png) {
  std::map<std::string, std::string> chunks;
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(png.at(at + i));
    return value;
  };
  for (std::size_t at = 8; at < png.size();) {
    const std::uint32_t length = number(at);
    const std::string checked = png.substr(at + 4, 4 + length);
    EXPECT_EQ(number(at + 8 + length),
              crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size())));
    chunks[checked.substr(0, 4)] = checked.substr(4);
    at += 12 + length;
  }
  return chunks;
}

std::vector<std::uint8_t> unfiltered(const Picture& picture, const std::string& deflated) {
  const std::size_t bytes = 3 * static_cast<std::size_t>(picture.width),
                    rows = static_cast<std::size_t>(picture.height);
  std::string all(rows * (bytes + 1), '\0');
  uLongf size = all.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(all.data()), &size, reinterpret_cast<const Bytef*>(deflated.data()),
                       deflated.size()),
            Z_OK);
  EXPECT_EQ(size, all.size());
  std::vector<std::uint8_t> pixels;
  for (std::size_t y = 0; y < rows; ++y)
    for (std::size_t x = 0; x < bytes; ++x) {
      const int filter = all[y * (bytes + 1)];
      const std::uint8_t before = x < 3 ? 0 : pixels[y * bytes + x - 3],
                         above = y == 0 ? 0 : pixels[(y - 1) * bytes + x];
      const int add = filter == 1 ? before : filter == 2 ? above : 0;
      pixels.push_back(static_cast<std::uint8_t>(all[y * (bytes + 1) + 1 + x] + add));
    }
  return pixels;
}

TEST(Picture, ComesBackOutOfItsPng) {
  PictureOptions options;
  options.width = 301, options.height = 200;
  const Picture picture = draw_picture(testing::rich_mesh(4), options);
  const auto chunks = chunks_of(to_png(picture));
  ASSERT_EQ(chunks.size(), 3u);
  EXPECT_EQ(chunks.at("IHDR"), std::string("\0\0\1\x2d\0\0\0\xc8\x8\x2\0\0\0", 13));
  EXPECT_EQ(unfiltered(picture, chunks.at("IDAT")), picture.pixels);
}

TEST(Picture, IsTheSameForEveryNumberOfThreads) {
  const TetMesh mesh = testing::with_mid_nodes(testing::rich_mesh(6));
  PictureOptions options;
  options.names = true, options.cut = PictureCut{{1, 0.3, 0.2}};
  RunContext one, four;
  one.threads = 1, four.threads = 4;
  EXPECT_EQ(draw_picture(mesh, options, one).pixels, draw_picture(mesh, options, four).pixels);
}

Picture white(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255)};
}

/// Per pixel the face that is seen, of a picture that the scene fills.
std::vector<std::uint32_t> faces_seen(const Scene& scene, Vec3 view, int side) {
  Camera camera = looking_from(view);
  const Rectangle all{0, 0, 1.0 * side, 1.0 * side};
  fit(camera, scene, all);
  Picture picture = white(side, side);
  return rasterise(scene, camera, picture, {1, all}, {});
}

TEST(Picture, TrianglesLeaveNoGapBetweenThem) {
  const Scene scene = scene_of(testing::rich_mesh(8), {}, {});
  // A square seen straight on fills all; from its corner a cube is a regular hexagon on its tip.
  const auto straight = faces_seen(scene, {0, 0, 1}, 257);
  EXPECT_EQ(std::ranges::count(straight, kNone), 0);
  for (const int side : {200, 333}) {
    const auto aslant = faces_seen(scene, {1, 1, 1}, side);
    const double covered = static_cast<double>(aslant.size()) - static_cast<double>(std::ranges::count(aslant, kNone));
    EXPECT_NEAR(covered / static_cast<double>(aslant.size()), std::sqrt(27.0) / 8, 0.01);
    // In each row what is covered is in one piece.
    for (int y = 0; y < side; ++y) {
      int pieces = 0;
      for (int x = 0; x < side; ++x) {
        const auto at = static_cast<std::size_t>(y * side + x);
        pieces += aslant[at] != kNone && (x == 0 || aslant[at - 1] == kNone);
      }
      EXPECT_LE(pieces, 1) << "row " << y;
    }
  }
}

TEST(Picture, OfACutElementsStayWhole) {
  const TetMesh mesh = testing::rich_mesh(6);
  PictureOptions options;
  options.cut = PictureCut{{1, 0.2, -0.4}, 0.4};
  const CutPlane plane(*options.cut, mesh.points);
  // The faces that are in one of the elements that stay.
  std::map<Triangle, int> count;
  for (const Tet& tet : mesh.tets) {
    if (std::ranges::all_of(tet, [&](VertexIndex v) { return plane.beyond(mesh.points[v]); })) continue;
    for (const auto& corners : kTetFaces) {
      Triangle face{tet[corners[0]], tet[corners[1]], tet[corners[2]]};
      std::ranges::sort(face);
      ++count[face];
    }
  }
  std::set<std::array<std::array<double, 3>, 3>> expected, drawn;
  const auto key = [](std::array<Vec3, 3> at) {
    std::array<std::array<double, 3>, 3> made{};
    for (std::size_t i = 0; i < 3; ++i) made[i] = {at[i].x, at[i].y, at[i].z};
    std::ranges::sort(made);
    return made;
  };
  for (const auto& [face, times] : count)
    if (times == 1) expected.insert(key({mesh.points[face[0]], mesh.points[face[1]], mesh.points[face[2]]}));
  const Scene scene = scene_of(mesh, options, {});
  for (const SceneTriangle& t : scene.triangles) drawn.insert(key(t.at));
  // Others lie within what stays.
  EXPECT_TRUE(std::ranges::includes(drawn, expected));
  const double share = static_cast<double>(drawn.size()) / static_cast<double>(expected.size());
  EXPECT_LT(share, 1.5);
  EXPECT_GT(expected.size(), 100u);
}

TEST(Picture, WhatIsHighlightedIsSeenFromWhereverItIs) {
  const TetMesh mesh = testing::rich_mesh(4);
  const Rgb mark = colour_of_mark(0);
  for (std::uint32_t patch = 0; patch < mesh.patch_names.size(); ++patch) {
    PictureOptions options;
    options.width = options.height = 200, options.highlight = {"patch_" + std::to_string(patch + 1)};
    if (!mesh.patch_names[patch].empty()) options.highlight = {mesh.patch_names[patch]};
    const Picture picture = draw_picture(mesh, options);
    int reddish = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 3)
      reddish += picture.pixels[i] > picture.pixels[i + 1] + 60 && picture.pixels[i + 2] > picture.pixels[i + 1] + 20;
    EXPECT_GT(reddish, 1500) << options.highlight[0] << ": " << int{mark.r};
  }
  PictureOptions options;
  options.highlight = {"nowhere"};
  EXPECT_THROW(draw_picture(mesh, options), OptionError);
  EXPECT_THROW(draw_picture(testing::cube(), options), OptionError);
}

TEST(Picture, NamesAreTheVisibleOnesAndTheOthersAreTold) {
  PictureOptions options;
  options.names = true, options.color = PictureOptions::Color::kPatch;
  EXPECT_EQ(draw_picture(testing::cube(4), options).notes.size(), 3u) << "three sides of a cube are seen from a corner";
  options.view = picture_view("front");
  EXPECT_EQ(draw_picture(testing::cube(4), options).notes.size(), 5u);
}

TEST(Picture, TheWorstElementIsToldAndShown) {
  TetMesh mesh = testing::rich_mesh(6);
  mesh.points[mesh.tets[100][2]] += Vec3{0.35, 0.2, 0.1};
  PictureOptions options;
  options.worst = true;
  const Picture picture = draw_picture(mesh, options);
  ASSERT_EQ(picture.notes.size(), 1u);
  EXPECT_NE(picture.notes[0].find("number " + std::to_string(worst_elements(mesh, 1)[0].tet) + " at"),
            std::string::npos);
  EXPECT_THROW(draw_picture(testing::cube(), options), OptionError);
  EXPECT_THROW(draw_picture(TetMesh(), options), OptionError);
}

TEST(Picture, TheBackOfATriangleIsNotItsFront) {
  SurfaceMesh one;
  one.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, one.triangles = {{0, 1, 2}};
  PictureOptions options;
  options.width = options.height = 64, options.furniture = false;
  std::array<Picture, 2> sides;
  options.view = Vec3{0, 0, 1}, sides[0] = draw_picture(one, options);
  options.view = Vec3{0, 0, -1}, sides[1] = draw_picture(one, options);
  const auto violet = [](const Picture& p) {
    int count = 0;
    for (std::size_t i = 0; i < p.pixels.size(); i += 3) count += p.pixels[i + 2] > p.pixels[i + 1] + 25;
    return count;
  };
  EXPECT_EQ(violet(sides[0]), 0);
  EXPECT_GT(violet(sides[1]), 500);
}

TEST(Picture, OfNothingIsEmpty) {
  EXPECT_EQ(draw_picture(TetMesh()).pixels.size(), 3u * 1200 * 900);
  EXPECT_EQ(draw_picture(SurfaceMesh()).pixels.size(), 3u * 1200 * 900);
}

TEST(Picture, WhatIsAskedIsReadOrRefused) {
  EXPECT_EQ(picture_cut("x").normal, (Vec3{1, 0, 0}));
  EXPECT_EQ(picture_cut("-y").normal, (Vec3{0, -1, 0}));
  EXPECT_EQ(picture_cut("-z=12.5").through, (Vec3{0, 0, 12.5}));
  EXPECT_EQ(picture_cut("x=-2").through, (Vec3{-2, 0, 0}));
  EXPECT_EQ(picture_cut("y=30%").share, 0.3);
  EXPECT_EQ(picture_cut("1,-2,3").normal, (Vec3{1, -2, 3}));
  EXPECT_EQ(picture_cut("1,-2,3:4,5,6").through, (Vec3{4, 5, 6}));
  for (const char* text : {"", "w", "x=", "x=1,2", "y=101%", "0,0,0", "1,2", "1,2,3,4", "1,2,3:", "nan,1,1", "x=inf"})
    EXPECT_THROW(picture_cut(text), OptionError) << text;
  EXPECT_EQ(picture_view("top"), (Vec3{0, 0, 1}));
  EXPECT_EQ(picture_view("1,2,-3"), (Vec3{1, 2, -3}));
  for (const char* text : {"", "up", "0,0,0", "1,2"}) EXPECT_THROW(picture_view(text), OptionError) << text;
  EXPECT_EQ(picture_up("-y"), (Vec3{0, -1, 0}));
  EXPECT_THROW(picture_up("upwards"), OptionError);
  PictureOptions options;
  options.width = 10;
  EXPECT_THROW(draw_picture(testing::cube(), options), OptionError);
  options.width = 100, options.view = Vec3{0, 0, 0};
  EXPECT_THROW(draw_picture(testing::cube(), options), OptionError);
}

}  // namespace
}  // namespace octafront
