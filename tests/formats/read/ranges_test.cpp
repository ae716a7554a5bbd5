#include <octafront/io.h>

#include "base/core/thread_limit.h"
#include "formats/small_files.h"
#include "support/named_surfaces.h"

#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

namespace octafront {
namespace {

using testing::surface_of;

/// Long enough to be read by several threads.
const SurfaceMesh& sphere() {
  static const SurfaceMesh kSphere = testing::icosphere(5);
  return kSphere;
}

std::string off_text(const char* end_of_line = "\n", const char* colour = " 255 0 0") {
  const SurfaceMesh& s = sphere();
  std::string text = fmt::format("OFF{0}# made up{0}{1} {2} 0{0}", end_of_line, s.points.size(), s.triangles.size());
  for (const Vec3& p : s.points) text += fmt::format("{} {} {}{}{}", p.x, p.y, p.z, colour, end_of_line);
  text += fmt::format("{0}# faces{0}", end_of_line);
  for (const auto& [a, b, c] : s.triangles) text += fmt::format("3 {} {} {}{}", a, b, c, end_of_line);
  return text;
}

/// Objects and groups of some hundred faces, the first ones before any name.
std::string obj_text(const char* corner = "{}") {
  const SurfaceMesh& s = sphere();
  std::string text = "# made up\n";
  for (const Vec3& p : s.points) text += fmt::format("v {} {} {}\nvn 0 0 1\n", p.x, p.y, p.z);
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (t % 700 == 650) text += fmt::format("o part {}\n", t / 2800);
    if (t % 900 == 850) text += fmt::format("g side {}\nusemtl steel\n", t / 900 % 3);
    text += 'f';
    for (const VertexIndex v : s.triangles[t]) text.append(1, ' ').append(fmt::format(fmt::runtime(corner), v + 1));
    text += '\n';
  }
  return text;
}

/// Solids of some hundred facets; `end`: of each facet.
std::string stl_text(const char* end_of_line = "\n", const char* end = "endfacet") {
  const SurfaceMesh& s = sphere();
  std::string text = "solid first part\n";
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (t % 700 == 650) text += fmt::format("endsolid\n  solid part {}{}", t / 700, end_of_line);
    text += fmt::format("facet normal 0 0 1{0}outer loop{0}", end_of_line);
    for (const VertexIndex v : s.triangles[t])
      text += fmt::format("vertex {} {} {}{}", s.points[v].x, s.points[v].y, s.points[v].z, end_of_line);
    text += fmt::format("endloop{0}{1}{0}", end_of_line, end);
  }
  return text + "endsolid first part\n";
}

SurfaceFile read_by(int threads, const std::string& text, const char* name) {
  const ThreadLimit limit(threads);
  return surface_of(text, name);
}

void expect_same(const SurfaceMesh& a, const SurfaceMesh& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.patch, b.patch);
  EXPECT_EQ(a.patch_names, b.patch_names);
  EXPECT_EQ(a.source, b.source);
}

/// What several threads read is what one reads; `is_sphere`: the sphere.
void expect_no_thread_is_seen(const std::string& text, const char* name, bool is_sphere = true) {
  const SurfaceFile one = read_by(1, text, name), four = read_by(4, text, name);
  expect_same(four.surface, one.surface);
  EXPECT_EQ(four.notes, one.notes);
  if (!is_sphere) return;
  EXPECT_EQ(four.surface.triangles, sphere().triangles);
  EXPECT_EQ(four.surface.points, sphere().points);
}

std::string message_by(int threads, const std::string& text, const char* name) {
  try {
    read_by(threads, text, name);
  } catch (const std::exception& e) {
    return e.what();
  }
  return "nothing is wrong";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

TEST(ReadInRanges, Off) {
  expect_no_thread_is_seen(off_text(), "s.off");
  expect_no_thread_is_seen(off_text("\r\n"), "s.off");
  expect_no_thread_is_seen(off_text("\r"), "s.off");
}

TEST(ReadInRanges, OffOfPolygonsAndOfOtherLayouts) {
  const std::string last = fmt::format("3 {} {} {}\n", sphere().triangles.back()[0], sphere().triangles.back()[1],
                                       sphere().triangles.back()[2]);
  const std::string text = off_text();
  const std::string quad = text.substr(0, text.rfind(last)) + "4 0 1 2 3\n";
  expect_no_thread_is_seen(quad, "s.off", false);
  expect_no_thread_is_seen(replaced(off_text("\n", ""), "\n3 ", "\n3\n"), "s.off");
}

TEST(ReadInRanges, Obj) {
  for (const char* corner : {"{}", "{0}/{0}", "{0}//{0}"}) expect_no_thread_is_seen(obj_text(corner), "s.obj");
  EXPECT_GT(surface_of(obj_text(), "s.obj").surface.patch_names.size(), 5U);
}

TEST(ReadInRanges, ObjOfWhatNeedsTheLinesBefore) {
  expect_no_thread_is_seen(obj_text() + "f -1 -2 -3\n", "s.obj", false);
  expect_no_thread_is_seen(obj_text() + "f 1 2 3 4\n", "s.obj", false);
  expect_no_thread_is_seen(obj_text() + "f 1 2 \\\n 3\n", "s.obj", false);
}

TEST(ReadInRanges, AsciiStl) {
  for (const char* end_of_line : {"\n", "\r\n", " "}) expect_no_thread_is_seen(stl_text(end_of_line), "s.stl", false);
  const SurfaceMesh read = read_by(4, stl_text(), "s.stl").surface;
  EXPECT_EQ(read.triangles.size(), sphere().triangles.size());
  EXPECT_GT(read.patch_names.size(), 20U);
  EXPECT_EQ(read.patch.back() + 1, read.patch_names.size());
  expect_no_thread_is_seen(stl_text("\n", "endfacet\ncolor 1 0 0"), "s.stl", false);
}

TEST(ReadInRanges, AsciiStlOfPolygonsAndOfOneSolid) {
  const std::string text = stl_text();
  const std::size_t vertex = text.rfind("vertex");
  expect_no_thread_is_seen(text.substr(0, vertex) + "vertex 0 0 0\n" + text.substr(vertex), "s.stl", false);
  std::string one = text.substr(0, text.find("endsolid"));
  while (one.size() < text.size()) one += one.substr(one.find("facet"));
  expect_no_thread_is_seen(one + "endsolid\n", "s.stl", false);
}

TEST(ReadInRanges, ComplaintsNameTheLine) {
  const std::string off = off_text() + "\n", obj = obj_text(), stl = stl_text();
  const std::string bad_off = replaced(off, "\n# faces\n3 ", "\n# faces\n3 x"),
                    bad_obj = replaced(obj, "\nf 1 ", "\nf x ");
  for (const auto& [text, name] :
       {std::pair(bad_off, "s.off"), std::pair(bad_obj, "s.obj"), std::pair(obj + "f 1 2 999999\n", "s.obj"),
        std::pair(replaced(stl, "endsolid\n", ""), "s.stl"), std::pair(replaced(stl, "  solid", "  solit"), "s.stl"),
        std::pair(stl.substr(0, stl.rfind("endsolid")), "s.stl"), std::pair(stl + "facet\n", "s.stl")}) {
    const std::string one = message_by(1, text, name);
    EXPECT_NE(one.find("line"), std::string::npos) << one;
    EXPECT_EQ(message_by(4, text, name), one);
  }
}

}  // namespace
}  // namespace octafront
