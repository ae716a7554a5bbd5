#include <octafront/error.h>
#include <octafront/io.h>

#include "sizing/field/octree_field.h"
#include "sizing/sources/make_size_field.h"
#include "support/named_surfaces.h"
#include "support/temporary_folder.h"

#include <filesystem>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// A file in the folder of temporary files that goes away again.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name) : path_(folder_ / name) {}
  TemporaryFile(const std::string& name, const std::string& text) : TemporaryFile(name) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  const testing::TemporaryFolder folder_;
  const std::filesystem::path path_;
};

SizeField make(const SurfaceMesh& surface, const SizeOptions& options) {
  StageReport report;
  return make_size_field(KnownSurface(surface, Features{}), options, {RunContext{}, report});
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SizeFieldFile, ReadsBackAsItWas) {
  SizeOptions options;
  options.curvature = 24;
  const SizeField h = make(testing::torus(50, 20), options);
  const TemporaryFile file("octafront_grid.vtu");
  write_size_field(file.path(), h);
  const SizeField again = read_size_field(file.path());
  EXPECT_TRUE(std::ranges::equal(as_octree_field(again)->tree.leaves(), as_octree_field(h)->tree.leaves()));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1.5, 1.5);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p{u(random), u(random), 0.3 * u(random)};
    ASSERT_NEAR(again.at(p), h.at(p), 2e-3 * h.at(p));
  }
}

TEST(SizeFieldFile, ReadingStopsWhenAsked) {
  const TemporaryFile file("octafront_grid.vtu");
  write_size_field(file.path(), make(testing::torus(50, 20), {}));
  const std::atomic<bool> stop{true};
  RunContext context;
  context.cancel = &stop;
  EXPECT_THROW(read_size_field(file.path(), 0.2, context), Cancelled);
}

TEST(PointSizesFile, ReadsTablesAndBothKindsOfVtkFiles) {
  const std::vector<PointSize> wanted{{{0, 0, 0}, 0.5}, {{1, 0, 0.25}, 2}};
  const std::string points =
      "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 .25</DataArray></Points>"
      "<PointData><DataArray type=\"Float32\" Name=\"h\" format=\"ascii\">.5 2</DataArray></PointData></Piece>";
  const std::vector<std::string> texts{
      "x,y,z,size\n0,0,0,0.5\n1,0,0.25,2\n", "0 0 0 .5\n1 0 .25 2",
      "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"2\" NumberOfPolys=\"0\">" + points +
          "</PolyData></VTKFile>",
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"2\" NumberOfCells=\"0\">" + points +
          "</UnstructuredGrid></VTKFile>"};
  for (const std::string& text : texts) {
    SCOPED_TRACE(text);
    const TemporaryFile file("octafront_sizes", text);
    const std::vector<PointSize> read = read_point_sizes(file.path());
    ASSERT_EQ(read.size(), wanted.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
      EXPECT_EQ(read[i].p, wanted[i].p);
      EXPECT_EQ(read[i].size, wanted[i].size);
    }
  }
  for (const std::string text : {"", "0 0 0 -1", "0 0 0", "title\nmore words", "<VTKFile type=\"ImageData\">"}) {
    SCOPED_TRACE(text);
    const TemporaryFile file("octafront_sizes", text);
    EXPECT_THROW(read_point_sizes(file.path()), InputError);
  }
}

TEST(PointSizes, AreLinearOnTrianglesAndHoldAtVertices) {
  const SurfaceMesh surface = testing::cube(1);
  SizeOptions options;
  options.gradation = 1;
  for (const Vec3 p : surface.points) options.point_sizes.push_back({p, 0.1 + 0.2 * p.x});
  const SizeField h = make(surface, options);
  for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{0, 0.5, 1}, Vec3{0.5, 0.3, 0}, Vec3{0.25, 1, 0.7}, Vec3{1, 0.4, 0.4}}) {
    EXPECT_NEAR(h.at(p), 0.1 + 0.2 * p.x, 0.025) << p.x << " " << p.y << " " << p.z;
  }
}

TEST(PointSizes, TheNearestSpeaksWhereVerticesHaveNone) {
  SizeOptions options;
  options.gradation = 1;
  options.point_sizes = {{{-1, 0.5, 0.5}, 0.05}, {{2, 0.5, 0.5}, 0.4}};
  const SizeField h = make(testing::cube(1), options);
  EXPECT_NEAR(h.at({0, 0.5, 0.5}), 0.05, 0.01);
  EXPECT_GT(h.at({1, 0.5, 0.5}), 0.3);
}

TEST(PointSizes, ASmallSizeAtOneCornerOfALargeTriangleIsNotMissed) {
  const SurfaceMesh surface = testing::cube(1);
  SizeOptions options;
  for (const Vec3 p : surface.points) options.point_sizes.push_back({p, p == Vec3{0, 0, 0} ? 0.01 : 5});
  EXPECT_LT(make(surface, options).at({0, 0, 0}), 0.025);
}

TEST(SizeFieldOption, TakesNoOtherSource) {
  SizeOptions options;
  options.field = SizeField::uniform(0.3);
  EXPECT_EQ(make(testing::cube(), options).at({0.1, 0.2, 0.3}), 0.3);
  options.curvature = 12;
  EXPECT_THROW(make(testing::cube(), options), OptionError);
}

TEST(KeptSurface, RegionsRefineTheInside) {
  SizeOptions options;
  options.regions = {{{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, 0.1, 0.02}};
  StageReport report;
  const SizeField h =
      size_field_of_surface(KnownSurface(testing::cube(4), Features{}), options, {RunContext{}, report});
  EXPECT_LT(h.at({0.5, 0.5, 0.5}), 0.03);
}

TEST(KeptSurface, SaysWhichSourcesItDoesNotUse) {
  SizeOptions options;
  StageReport quiet, report;
  size_field_of_surface(KnownSurface(testing::cube(4), Features{}), options, {{}, quiet});
  EXPECT_TRUE(quiet.notes.empty());
  options.gap = 2;
  options.curvature = 24;
  size_field_of_surface(KnownSurface(testing::cube(4), Features{}), options, {RunContext{}, report});
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_NE(report.notes[0].find("`curvature`, `gap`: not used"), std::string::npos) << report.notes[0];
}

TEST(KeptSurface, SizesChangeFasterWhereItsTrianglesDo) {
  SurfaceMesh fine = testing::cube(40);
  for (Vec3& p : fine.points)  // squeezed towards one corner: sizes from 1/40^3 on
    p = {p.x * p.x * p.x, p.y * p.y * p.y, p.z * p.z * p.z};
  StageReport steep, even;
  EXPECT_EQ(as_octree_field(size_field_of_surface(KnownSurface(fine, Features{}), {}, {{}, steep}))->gradation,
            4 * kDefaultGradation);
  EXPECT_EQ(steep.notes.size(), 1u);
  EXPECT_EQ(
      as_octree_field(size_field_of_surface(KnownSurface(testing::cube(8), Features{}), {}, {{}, even}))->gradation,
      kDefaultGradation);
}

TEST(SizeFieldFile, DamagedFilesAreRefused) {
  const TemporaryFile file("octafront_grid.vtu");
  SizeOptions options;
  options.size = 0.3;
  write_size_field(file.path(), make(testing::cube(), options));
  const std::string whole = text_of(file.path());
  for (const std::size_t length : {std::size_t{0}, std::size_t{40}, whole.size() / 2, whole.size() - 60}) {
    const TemporaryFile cut("octafront_cut.vtu", whole.substr(0, length));
    EXPECT_THROW(read_size_field(cut.path()), InputError) << length;
  }
  EXPECT_THROW(read_size_field(file.path(), 2), OptionError);
  EXPECT_THROW(write_size_field(file.path(), SizeField::uniform(1)), OutputError);
}

TEST(SizeRegions, ComeFromJson) {
  const TemporaryFile file("octafront_regions.json",
                           R"([{"box": [[0, 0, 0], [1, 2, 1]], "size": 0.1},
                               {"sphere": [5, 0, 0], "radius": 2, "size": 0.2}, {"point": [1, 1, 1], "size": 0.05}])");
  const auto regions = read_size_regions(file.path());
  ASSERT_EQ(regions.size(), 3u);
  EXPECT_EQ(regions[0].lo, (Vec3{0, 0, 0}));
  EXPECT_EQ(regions[0].hi, (Vec3{1, 2, 1}));
  EXPECT_EQ(regions[1].radius, 2);
  EXPECT_EQ(regions[2].size, 0.05);
}

TEST(SizeRegions, ComeFromTables) {
  const TemporaryFile file("octafront_points.csv", "x,y,z,size\r\n0, 1, 2, 0.5\r\n\n3;4;5;0.25\n");
  const auto regions = read_size_regions(file.path());
  ASSERT_EQ(regions.size(), 2u);
  EXPECT_EQ(regions[0].lo, (Vec3{0, 1, 2}));
  EXPECT_EQ(regions[1].size, 0.25);
}

/// A text that is no table or list of sizes, and what the refusal says.
struct BadText {
  const char *text, *fragment;
};

template <class Read>
void expect_refused(const std::vector<BadText>& texts, const Read& read) {
  for (const BadText& bad : texts) {
    SCOPED_TRACE(bad.text);
    const TemporaryFile file("octafront_bad_sizes", bad.text);
    try {
      read(file.path());
      ADD_FAILURE() << "was read";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(bad.fragment), std::string::npos) << error.what();
    }
  }
}

TEST(SizeTables, SlipsAreRefusedWithTheLine) {
  const std::vector<BadText> texts{{"1 2 3\n", "line 1: 3 values"},
                                   {"hello world\n", "no line of four numbers"},
                                   {"0 0 0 0.l\n1 0 0 0.1\n", "line 1: \"0.l\""},
                                   {"x,y,z,size\n0,0,0\n", "line 2: 3 values"},
                                   {"0 0 0 1 2\n", "line 1: 5 values"},
                                   {"0 0 0 1\n\n0 O 1 1\n", "line 3: \"O\""},
                                   {"x y z h\nx y z h\n", "line 2"},
                                   {"0 0 0 nan\n", "\"nan\""},
                                   {"0 0 inf 1\n", "\"inf\""},
                                   {"0 0 0 -1\n", "line 1: size -1"}};
  expect_refused(texts, [](const auto& file) { read_size_regions(file); });
  expect_refused(texts, [](const auto& file) { read_point_sizes(file); });
}

TEST(SizeTables, TitlesMayBeWords) {
  const TemporaryFile file("octafront_titles", "# \"Points:0\", Points:1, Points:2, wanted size\n+1 2e0 3 .5");
  const std::vector<PointSize> sizes = read_point_sizes(file.path());
  ASSERT_EQ(sizes.size(), 1u);
  EXPECT_EQ(sizes[0].p, (Vec3{1, 2, 3}));
}

TEST(SizeRegions, BadFilesAreRefused) {
  expect_refused({{"", "empty"},
                  {"[{\"box\": [[0,0,0],[1,1,1]]}]", "entry 0 has no \"size\""},
                  {"[{\"point\": [0,0], \"size\": 1}]", "[x, y, z]"},
                  {"[\n{]", "line 2: is no JSON"},
                  {"[{\"point\": [0,0,1e999], \"size\": 1}]", "number"},
                  {"{}", "no JSON array"},
                  {"[{\"point\": [0,0,0], \"size\": -1}]", "above 0"},
                  {"[{\"blob\": [0,0,0], \"size\": 1}]", "\"blob\""},
                  {"[{\"sphere\": [0,0,0], \"size\": 1}]", "needs a \"radius\""},
                  {"[{\"sphere\": [0,0,0], \"radius\": 0, \"size\": 1}]", "needs a \"radius\" above 0"},
                  {"[{\"point\": [0,0,0], \"radius\": -1, \"size\": 1}]", "radius -1"},
                  {"[{\"box\": [[0,2,0],[1,1,1]], \"size\": 1}]", "corners swapped"},
                  {"[{\"size\": 1}]", "exactly one of"}},
                 [](const auto& file) { read_size_regions(file); });
}

TEST(SizeRegions, HoldInsideAndGrowAround) {
  SizeOptions options;
  options.size = 0.2;
  options.gradation = 0.1;
  options.regions = {{{0.2, 0.2, 0.2}, {0.4, 0.4, 0.4}, 0, 0.05}, {{1, 1, 1}, {1, 1, 1}, 0.2, 0.1}};
  const SizeField h = make(testing::cube(4), options);
  for (const Vec3 p : {Vec3{0.3, 0.3, 0.3}, Vec3{0.21, 0.39, 0.3}}) EXPECT_NEAR(h.at(p), 0.05, 0.003);
  EXPECT_NEAR(h.at({0.9, 0.9, 0.9}), 0.1, 0.005);
  EXPECT_NEAR(h.at({0.9, 0.05, 0.1}), 0.11, 0.03);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(0, 1);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p{u(random), u(random), u(random)}, q = p + 0.1 * Vec3{u(random), u(random), u(random)};
    ASSERT_LE(std::abs(h.at(p) - h.at(q)), 0.1 * distance(p, q) * (1 + 1e-9));
  }
}

/// The seeds of the fuzzer, and what it found: each file is sizes of one kind or another, or refused with an
/// InputError.
TEST(Corpus, SizesAreReadOrRefused) {
  int read = 0;
  const auto count = [&](const auto& reader) {
    try {
      reader();
      ++read;
    } catch (const InputError&) {
    }
  };
  for (const auto& file : std::filesystem::directory_iterator(OCTAFRONT_CORPUS "/sizes")) {
    SCOPED_TRACE(file.path().filename());
    const std::string name = file.path().string();
    count([&] { read_point_sizes(name); });
    count([&] { read_size_regions(name); });
    count([&] { read_size_field(name); });
  }
  EXPECT_GE(read, 9);  // a table is both points and regions, a grid both points and a field
}

}  // namespace
}  // namespace octafront
