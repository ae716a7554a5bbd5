#include <octafront/error.h>
#include <octafront/quality.h>
#include <octafront/report_page.h>
#include <octafront/run_context.h>

#include "report/page/bytes.h"
#include "report/page/mesh_streams.h"
#include "support/rich_mesh.h"

#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// Reads numbers as assets/decode.js does.
class Numbers {
 public:
  explicit Numbers(const Bytes& bytes) : bytes_(bytes.all()) {}
  bool more() const { return at_ < bytes_.size(); }
  std::uint64_t next() {
    std::uint64_t value = 0;
    for (int shift = 0;; shift += 7) {
      const std::uint8_t byte = bytes_.at(at_++);
      value |= std::uint64_t{byte & 127u} << shift;
      if (byte < 128) return value;
    }
  }
  std::int64_t difference() {
    const std::uint64_t n = next();
    return static_cast<std::int64_t>(n >> 1) ^ -static_cast<std::int64_t>(n & 1);
  }

 private:
  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_ = 0;
};

const Bytes& stream(const MeshStreams& streams, const std::string& name) {
  for (const auto& [of, bytes] : streams.all)
    if (of == name) return bytes;
  throw std::out_of_range(name);
}

TEST(Bytes, NumbersOfAnySizeComeBack) {
  const std::vector<std::int64_t> values{0,   1,    -1,      63,         -64,       64,       127,
                                         128, -129, 1 << 20, -(1 << 30), INT64_MAX, INT64_MIN};
  Bytes bytes;
  for (const std::int64_t v : values) bytes.difference(v);
  Numbers numbers(bytes);
  for (const std::int64_t v : values) EXPECT_EQ(numbers.difference(), v);
  EXPECT_FALSE(numbers.more());
}

TEST(Bytes, ValuesBecomeBytesWhateverTheyAre) {
  EXPECT_EQ(kBetaScale(0), 0);
  EXPECT_EQ(kBetaScale(1), 255);
  EXPECT_EQ(kBetaScale(0.5), 128);
  EXPECT_EQ(kBetaScale(-3), 0);
  EXPECT_EQ(kBetaScale(7), 255);
  EXPECT_EQ(kBetaScale(std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_EQ(kSizeRatioScale(-HUGE_VAL), 0);
  EXPECT_EQ(kSizeRatioScale(HUGE_VAL), 255);
}

TEST(MeshStreams, HoldEveryElementAndFace) {
  const TetMesh mesh = testing::with_mid_nodes(testing::rich_mesh(4));
  const MeshStreams streams = mesh_streams(mesh, nullptr, {});
  std::set<VertexIndex> corners;
  for (const Tet& t : mesh.tets) corners.insert(t.begin(), t.end());
  EXPECT_EQ(streams.points, corners.size()) << "mid-side nodes stay out";

  Numbers tets(stream(streams, "tets")), coordinates(stream(streams, "points"));
  std::vector<std::array<std::int64_t, 3>> points(streams.points);
  for (int axis = 0; axis < 3; ++axis) {
    std::int64_t last = 0;
    for (auto& p : points) p[axis] = last += coordinates.difference();
  }
  std::uint64_t met = 0;
  for (const Tet& t : mesh.tets)
    for (const VertexIndex v : t) {
      const std::uint64_t behind = tets.next(), number = met - behind;
      met += behind == 0;
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(streams.origin[axis] + streams.step * static_cast<double>(points[number][axis]),
                    mesh.points[v][axis], 0.51 * streams.step);
    }
  EXPECT_FALSE(tets.more());

  Numbers boundary(stream(streams, "boundary")), walls(stream(streams, "walls")), regions(stream(streams, "region"));
  std::size_t faces = 0;
  for (; boundary.more(); ++faces) {
    boundary.next();
    EXPECT_LT(boundary.next(), mesh.patch_names.size());
  }
  EXPECT_EQ(faces, mesh.boundary.size());
  std::uint64_t low = 0;
  for (faces = 0; walls.more(); ++faces) {
    low += walls.next();
    const std::uint64_t high = low + walls.next();
    EXPECT_NE(mesh.region[low / 4], mesh.region[high / 4]);
    EXPECT_GT(walls.next(), 0u) << "its patch";
  }
  EXPECT_EQ(faces, mesh.interfaces.size());
  for (const std::uint32_t r : mesh.region) EXPECT_EQ(regions.next(), r);
}

TEST(MeshStreams, OfMidSideNodesThoseOffTheMiddleAreKept) {
  TetMesh mesh = testing::with_mid_nodes(testing::rich_mesh(2));
  EXPECT_TRUE(stream(mesh_streams(mesh, nullptr, {}), "bends").all().empty());
  EXPECT_THROW(stream(mesh_streams(testing::rich_mesh(2), nullptr, {}), "bends"), std::out_of_range);

  const VertexIndex moved = mesh.mid_nodes[5][3];
  const auto at = [&](VertexIndex mid) {
    for (std::size_t i = 0;; ++i)
      if (mesh.mid_nodes[i / 6][i % 6] == mid) return i;
  };
  const double step = mesh_streams(mesh, nullptr, {}).step;
  mesh.points[moved] += step * Vec3{7, -300, 0.2};
  const MeshStreams streams = mesh_streams(mesh, nullptr, {});
  Numbers bends(stream(streams, "bends"));
  EXPECT_EQ(bends.next(), at(moved)) << "at the first element that has it, once";
  EXPECT_EQ(bends.difference(), 7);
  EXPECT_EQ(bends.difference(), -300);
  EXPECT_EQ(bends.difference(), 0);
  EXPECT_FALSE(bends.more());
}

TEST(MeshStreams, SizesAreComparedWithThoseMade) {
  const TetMesh mesh = testing::rich_mesh(2);
  const SizeField sizes = SizeField::uniform(1);
  const MeshStreams streams = mesh_streams(mesh, &sizes, {});
  const Bytes& ratio = stream(streams, "size_ratio");
  ASSERT_EQ(ratio.all().size(), mesh.tets.size());
  double sum = 0;
  for (const auto& [i, j] : kTetEdges) sum += distance(mesh.points[mesh.tets[0][i]], mesh.points[mesh.tets[0][j]]);
  EXPECT_EQ(ratio.all()[0], kSizeRatioScale(std::log2(sum / 6)));
}

TEST(ReportPage, TakesMeshesThatAreNotValid) {
  TetMesh flat;
  flat.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}};
  flat.tets = {{0, 1, 2, 3}};
  EXPECT_NE(report_page(flat, nullptr, "{}").find("</html>"), std::string::npos);
  EXPECT_NE(report_page({}, nullptr, "{}").find("</html>"), std::string::npos);
}

TEST(ReportPage, RefusesReportsThatAreNone) {
  EXPECT_THROW(report_page({}, nullptr, "[1]"), OptionError);
  EXPECT_THROW(report_page({}, nullptr, "{"), OptionError);
}

TEST(ReportPage, NamesCannotEndWhatHoldsThem) {
  TetMesh mesh = testing::rich_mesh(2);
  mesh.patch_names[0] = "</script><b onclick=x>\xff";
  const std::string page = report_page(mesh, nullptr, R"({"input": "</script><i>"})");
  EXPECT_EQ(page.find("<b onclick"), std::string::npos);
  EXPECT_EQ(page.find("<i>"), std::string::npos);
  EXPECT_NE(page.find("\\u003c/script>\\u003ci>"), std::string::npos) << "but they are there";
  EXPECT_EQ(page.find('\xff'), std::string::npos);
}

TEST(ReportPage, IsTheSameForAnyNumberOfThreads) {
  const TetMesh mesh = testing::rich_mesh(4);
  RunContext one, four;
  one.threads = 1;
  four.threads = 4;
  EXPECT_EQ(report_page(mesh, nullptr, "{}", one), report_page(mesh, nullptr, "{}", four));
}

TEST(WorstElements, AreTheLeastInOrder) {
  const TetMesh mesh = testing::rich_mesh(4);
  const auto worst = worst_elements(mesh, 10);
  ASSERT_EQ(worst.size(), 10u);
  const QualitySummary all = summarize_quality(mesh);
  EXPECT_DOUBLE_EQ(worst[0].beta, all.beta_min);
  for (std::size_t i = 1; i < worst.size(); ++i)
    EXPECT_TRUE(worst[i - 1].beta < worst[i].beta ||
                (worst[i - 1].beta == worst[i].beta && worst[i - 1].tet < worst[i].tet));
  EXPECT_EQ(worst_elements(mesh, mesh.tets.size() + 5).size(), mesh.tets.size());
  EXPECT_TRUE(worst_elements({}, 5).empty());
}

}  // namespace
}  // namespace octafront
