// The models that are shipped in samples/: small, readable, closed and outward.

#include <octafront/io.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// Formats like STL give each triangle corners of its own.
SurfaceMesh with_equal_points_merged(SurfaceMesh s) {
  std::map<std::tuple<double, double, double>, VertexIndex> first;
  std::vector<VertexIndex> merged(s.points.size());
  for (VertexIndex v = 0; v < s.points.size(); ++v)
    merged[v] = first.try_emplace({s.points[v].x, s.points[v].y, s.points[v].z}, v).first->second;
  for (Triangle& t : s.triangles)
    for (VertexIndex& v : t) v = merged[v];
  return s;
}

bool is_closed(const SurfaceMesh& s) {
  std::set<Edge> edges;
  for (const Triangle& t : s.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (!edges.insert({t[k], t[(k + 1) % 3]}).second) return false;
  return std::all_of(edges.begin(), edges.end(), [&](const Edge& e) { return edges.count({e[1], e[0]}) == 1; });
}

struct Sample {
  const char* name;
  const char* format;
  std::size_t patches;
  double volume;  ///< cubic millimetres
};

TEST(Samples, AreSmallClosedAndOutward) {
  constexpr Sample kSamples[] = {{"bracket.stl", "binary STL", 0, 21638.6},
                                 {"gear.obj", "OBJ", 4, 17113.6},
                                 {"torus_knot.ply", "binary PLY", 0, 19877.5},
                                 {"gyroid.ply", "binary PLY (big endian)", 7, 10538.2},
                                 {"shell.off", "OFF", 0, 56434.5}};
  for (const Sample& sample : kSamples) {
    SCOPED_TRACE(sample.name);
    const std::filesystem::path path = std::filesystem::path(OCTAFRONT_SAMPLES) / sample.name;
    EXPECT_LT(std::filesystem::file_size(path), 300000U);
    const SurfaceFile file = read_surface(path);
    EXPECT_EQ(file.format, sample.format);
    EXPECT_EQ(file.surface.patch_names.size(), sample.patches);
    EXPECT_TRUE(is_closed(with_equal_points_merged(file.surface)));
    EXPECT_NEAR(enclosed_volume(file.surface), sample.volume, 0.5);
  }
}

}  // namespace
}  // namespace octafront
