#include <octafront/octafront_c.h>

#include "support/named_surfaces.h"
#include "support/temporary_folder.h"

#include <cstring>
#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace octafront {
namespace {

template <auto kFree>
struct Free {
  template <class T>
  void operator()(T* t) const {
    kFree(t);
  }
};
using Surface = std::unique_ptr<octafront_surface, Free<octafront_surface_free>>;
using Mesh = std::unique_ptr<octafront_mesh, Free<octafront_mesh_free>>;
using Sizes = std::unique_ptr<octafront_sizes, Free<octafront_sizes_free>>;
using Given = std::unique_ptr<octafront_options, Free<octafront_options_free>>;
using Job = std::unique_ptr<octafront_job, Free<octafront_job_free>>;

Surface surface_of(const SurfaceMesh& mesh) {
  Surface surface(octafront_surface_new());
  EXPECT_EQ(octafront_surface_set_array(surface.get(), "points", mesh.points.data(), mesh.points.size()), 0);
  EXPECT_EQ(octafront_surface_set_array(surface.get(), "triangles", mesh.triangles.data(), mesh.triangles.size()), 0);
  return surface;
}

Given options_of(const char* json) {
  Given options(octafront_options_new());
  EXPECT_EQ(octafront_options_set(options.get(), json), 0) << octafront_last_error();
  return options;
}

int status_at_end(const Job& job) {
  octafront_event event;
  while (octafront_job_wait(job.get(), -1, &event) != OCTAFRONT_EVENT_END) {
  }
  return octafront_job_status(job.get());
}

octafront_array array_of(const Mesh& mesh, const char* name) {
  octafront_array found{};
  EXPECT_EQ(octafront_mesh_array(mesh.get(), name, &found), 0) << octafront_last_error();
  return found;
}

Mesh meshed(const Surface& surface, const char* json) {
  const Given options = options_of(json);
  const Job job(octafront_generate(surface.get(), options.get(), 1));
  EXPECT_EQ(status_at_end(job), OCTAFRONT_DONE) << octafront_job_message(job.get());
  return Mesh(octafront_job_take_mesh(job.get()));
}

TEST(CApi, AMeshAndWhatIsKnownOfIt) {
  const Surface cube = surface_of(testing::cube(1));
  const Given options = options_of(R"({"size": 0.3, "order": 2})");
  const Job job(octafront_generate(cube.get(), options.get(), 1));
  ASSERT_EQ(status_at_end(job), OCTAFRONT_DONE) << octafront_job_message(job.get());
  const Mesh mesh(octafront_job_take_mesh(job.get()));
  EXPECT_EQ(octafront_job_take_mesh(job.get()), nullptr) << "given away twice";
  const octafront_array tets = array_of(mesh, "tets"), mids = array_of(mesh, "mid_nodes");
  EXPECT_GT(tets.rows, 50u);
  EXPECT_EQ(tets.columns, 4u);
  EXPECT_EQ(tets.type, std::uint32_t{OCTAFRONT_U32});
  EXPECT_EQ(mids.rows, tets.rows);
  EXPECT_NE(std::string(octafront_job_report(job.get())).find("\"hash\""), std::string::npos);
  EXPECT_NE(std::string(octafront_mesh_summary(mesh.get())).find("beta_mean"), std::string::npos);
  const Sizes sizes(octafront_job_take_sizes(job.get()));
  const double middle[3] = {0.5, 0.5, 0.5};
  double h = 0;
  EXPECT_EQ(octafront_sizes_at(sizes.get(), middle, 1, &h), 0);
  EXPECT_NEAR(h, 0.3, 1e-9);
  double metric[9] = {};
  EXPECT_EQ(octafront_sizes_metric_at(sizes.get(), middle, 1, metric), 0);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(metric[i], i % 4 == 0 ? 1 / (h * h) : 0);
}

TEST(CApi, SizesAreAskedForInBatchesAndTheWorkerWaits) {
  const Surface cube = surface_of(testing::cube(1));
  const Given options(octafront_options_new());
  octafront_options_ask_sizes(options.get());
  const Job job(octafront_generate(cube.get(), options.get(), 1));
  octafront_event event;
  std::size_t asked = 0, batches = 0;
  while (octafront_job_wait(job.get(), -1, &event) != OCTAFRONT_EVENT_END) {
    if (event.kind != OCTAFRONT_EVENT_SIZES) continue;
    for (std::size_t i = 0; i < event.count; ++i) event.sizes[i] = 0.2;
    asked += event.count;
    ++batches;
    octafront_job_answer(job.get());
  }
  EXPECT_EQ(octafront_job_status(job.get()), OCTAFRONT_DONE) << octafront_job_message(job.get());
  EXPECT_GT(asked, 10 * batches);
}

TEST(CApi, JobsEndWhenTheyAreCancelledOrFreed) {
  const Surface sphere = surface_of(testing::icosphere(5));
  const Given options = options_of(R"({"size": 0.01})");
  const Job job(octafront_generate(sphere.get(), options.get(), 1));
  octafront_job_cancel(job.get());
  EXPECT_EQ(status_at_end(job), OCTAFRONT_CANCELLED);

  octafront_options_ask_sizes(options.get());
  Job waiting(octafront_generate_sizes(sphere.get(), options.get(), 1));
  octafront_event event;
  while (octafront_job_wait(waiting.get(), -1, &event) != OCTAFRONT_EVENT_SIZES) {
    ASSERT_NE(event.kind, OCTAFRONT_EVENT_END) << octafront_job_message(waiting.get());
  }
  waiting.reset();  // never answered
}

TEST(CApi, RefusalsCarryTheirKindAndEvidence) {
  SurfaceMesh open = testing::cube(1);
  open.triangles.pop_back();
  const Surface surface = surface_of(open);
  const Job job(octafront_generate(surface.get(), nullptr, 1));
  EXPECT_EQ(status_at_end(job), OCTAFRONT_INPUT);
  EXPECT_NE(std::string(octafront_job_report(job.get())).find("\"open_edges\":{\"count\":3"), std::string::npos);

  const Given contradiction = options_of(R"({"size": 1, "elements": 5})");
  const Job usage(octafront_generate(surface.get(), contradiction.get(), 1));
  EXPECT_EQ(status_at_end(usage), OCTAFRONT_USAGE);

  const Surface cube = surface_of(testing::cube(1));
  const Mesh mesh = meshed(cube, R"({"size": 0.5})");
  const Job lost(octafront_write_mesh(mesh.get(), "/nowhere/mesh.vtu", nullptr));
  EXPECT_EQ(status_at_end(lost), OCTAFRONT_OUTPUT);
  EXPECT_STRNE(octafront_job_message(lost.get()), "");

  EXPECT_NE(octafront_options_set(contradiction.get(), R"({"sise": 1})"), 0);
  EXPECT_STREQ(octafront_last_error(), "there is no option \"sise\"");
  EXPECT_NE(octafront_options_set(contradiction.get(), "{"), 0);
  octafront_array found;
  EXPECT_NE(octafront_mesh_array(mesh.get(), "sides", &found), 0);
  EXPECT_STREQ(octafront_last_error(), "a mesh has no array \"sides\"");
}

TEST(CApi, IndicesOutOfRangeAreRefusedBeforeAnybodyFollowsThem) {
  const Surface cube = surface_of(testing::cube(1));
  const std::uint32_t wrong[3] = {0, 1, 999};
  octafront_surface_set_array(cube.get(), "triangles", wrong, 1);
  for (auto start : {octafront_generate, octafront_generate_surface, octafront_generate_sizes})
    EXPECT_EQ(status_at_end(Job(start(cube.get(), nullptr, 1))), OCTAFRONT_INPUT);
  EXPECT_EQ(status_at_end(Job(octafront_repair(cube.get()))), OCTAFRONT_INPUT);
  EXPECT_EQ(status_at_end(Job(octafront_write_surface(cube.get(), "cube.off"))), OCTAFRONT_INPUT);

  const Mesh mesh(octafront_mesh_new());
  const double points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::uint32_t tet[4] = {0, 1, 2, 4};
  octafront_mesh_set_array(mesh.get(), "points", points, 4);
  octafront_mesh_set_array(mesh.get(), "tets", tet, 1);
  EXPECT_EQ(status_at_end(Job(octafront_order_mesh(mesh.get()))), OCTAFRONT_INPUT);
  EXPECT_EQ(status_at_end(Job(octafront_check(mesh.get(), nullptr))), OCTAFRONT_INPUT);
  EXPECT_EQ(status_at_end(Job(octafront_improve(mesh.get(), nullptr, nullptr, 1))), OCTAFRONT_INPUT);
  EXPECT_EQ(status_at_end(Job(octafront_adapt(mesh.get(), nullptr, nullptr, 1))), OCTAFRONT_INPUT);
  EXPECT_EQ(status_at_end(Job(octafront_write_mesh(mesh.get(), "mesh.vtu", nullptr))), OCTAFRONT_INPUT);
  double beta[1];
  EXPECT_NE(octafront_mesh_quality(mesh.get(), beta, nullptr, nullptr), 0);
  EXPECT_EQ(octafront_mesh_summary(mesh.get()), nullptr);
}

TEST(CApi, FieldsGoToOtherMeshesThatAreCutAndMove) {
  const Surface cube = surface_of(testing::cube(1));
  const Mesh old = meshed(cube, R"({"size": 0.5})"), other = meshed(cube, R"({"size": 0.4})");
  octafront_array points{}, tets{}, new_tets{};
  ASSERT_EQ(octafront_mesh_array(old.get(), "points", &points), 0);
  ASSERT_EQ(octafront_mesh_array(old.get(), "tets", &tets), 0);
  ASSERT_EQ(octafront_mesh_array(other.get(), "tets", &new_tets), 0);
  const std::vector<double> ones(tets.rows, 1), by(3 * points.rows, 2);
  std::vector<double> made(new_tets.rows), heights;
  const octafront_field field{"one", 1, 1, ones.data(), made.data()};
  const Job carry(octafront_carry(old.get(), other.get(), 0, &field, 1, nullptr, 1));
  ASSERT_EQ(status_at_end(carry), OCTAFRONT_DONE);
  for (const double value : made) EXPECT_EQ(value, 1);
  EXPECT_NE(std::string(octafront_job_report(carry.get())).find("integral_error"), std::string::npos);

  const auto* coordinates = static_cast<const double*>(points.data);
  for (std::size_t v = 0; v < points.rows; ++v) heights.push_back(coordinates[3 * v + 2]);
  const octafront_level_set plane{"low", heights.data(), 0.3};
  const Job cut(octafront_cut(old.get(), &plane, 1, nullptr, 1));
  ASSERT_EQ(status_at_end(cut), OCTAFRONT_DONE);
  const Mesh divided(octafront_job_take_mesh(cut.get()));
  std::size_t length = 0;
  EXPECT_EQ(std::string(octafront_mesh_name(divided.get(), "region_names", 1, &length)), "low");

  const Job move(octafront_move(old.get(), by.data(), &field, 1, nullptr, 1));
  ASSERT_EQ(status_at_end(move), OCTAFRONT_DONE);
  const Mesh moved(octafront_job_take_mesh(move.get()));
  octafront_array values{};
  ASSERT_EQ(octafront_mesh_field(moved.get(), 0, &values), 0);
  EXPECT_EQ(values.rows, tets.rows);
  EXPECT_EQ(static_cast<const double*>(values.data)[0], 1);
  EXPECT_NE(octafront_mesh_field(moved.get(), 1, &values), 0);
}

std::string bytes_of(const Job& job) {
  std::size_t length = 0;
  const char* bytes = octafront_job_bytes(job.get(), &length);
  return {bytes, length};
}

TEST(CApi, PicturesOfMeshesAndSurfacesAreBytesAndFiles) {
  const Surface cube = surface_of(testing::cube(1));
  const Mesh mesh = meshed(cube, R"({"size": 0.3})");
  const testing::TemporaryFolder folder;
  const std::string file = folder / "picture.png";
  const char* asked = R"({"width": 200, "height": 150, "cut": "x", "color": "size", "highlight": null})";
  const Job of_mesh(octafront_picture(mesh.get(), nullptr, asked, file.c_str(), 1));
  ASSERT_EQ(status_at_end(of_mesh), OCTAFRONT_DONE) << octafront_job_message(of_mesh.get());
  const std::string png = bytes_of(of_mesh);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\0\xc8\0\0\0\x96", 8)) << "200 across, 150 down";
  EXPECT_EQ(std::filesystem::file_size(file), png.size());
  EXPECT_NE(std::string(octafront_job_report(of_mesh.get())).find("\"width\":200"), std::string::npos)
      << octafront_job_report(of_mesh.get());

  const Job of_surface(octafront_picture(nullptr, cube.get(), asked, nullptr, 2));
  ASSERT_EQ(status_at_end(of_surface), OCTAFRONT_DONE) << octafront_job_message(of_surface.get());
  EXPECT_NE(bytes_of(of_surface), png);
  const Job again(octafront_picture(mesh.get(), nullptr, asked, nullptr, 2));
  ASSERT_EQ(status_at_end(again), OCTAFRONT_DONE);
  EXPECT_EQ(bytes_of(again), png) << "another number of threads, other pixels";
}

TEST(CApi, PicturesThatCannotBeAreRefused) {
  const Surface cube = surface_of(testing::cube(1));
  for (const char* asked : {R"({"color": "blue"})", R"({"edges": 3})", R"({"cut": "w"})", R"({"width": 10})",
                            R"({"highlight": ["nowhere"]})", R"({"worst": true})", R"({"view": "0,0,0"})", "{"}) {
    const Job job(octafront_picture(nullptr, cube.get(), asked, nullptr, 1));
    EXPECT_EQ(status_at_end(job), OCTAFRONT_USAGE) << asked;
    EXPECT_NE(std::string(octafront_job_message(job.get())), "") << asked;
    EXPECT_EQ(bytes_of(job), "");
  }
  const Job job(octafront_picture(nullptr, cube.get(), "{}", "/nowhere/picture.png", 1));
  EXPECT_EQ(status_at_end(job), OCTAFRONT_OUTPUT);
}

TEST(CApi, ArraysNamesAndSetsComeBackAsTheyWent) {
  const Surface cube = surface_of(testing::cube(1));
  const Mesh mesh = meshed(cube, R"({"size": 0.5})");
  const std::string name("a\0\xff", 3);
  EXPECT_EQ(octafront_mesh_add_name(mesh.get(), "region_names", name.data(), name.size()), 0);
  std::size_t length = 0;
  const char* found = octafront_mesh_name(mesh.get(), "region_names", 0, &length);
  EXPECT_EQ(std::string(found, length), name);
  EXPECT_EQ(octafront_mesh_name(mesh.get(), "region_names", 1, &length), nullptr);

  const std::uint32_t members[2] = {0, 3}, falling[2] = {3, 0}, far[1] = {1000000};
  EXPECT_EQ(octafront_mesh_add_set(mesh.get(), OCTAFRONT_NODES, "s", 1, members, 2), 0);
  EXPECT_NE(octafront_mesh_add_set(mesh.get(), OCTAFRONT_NODES, "s", 1, falling, 2), 0);
  EXPECT_NE(octafront_mesh_add_set(mesh.get(), OCTAFRONT_FACES, "s", 1, far, 1), 0);
  EXPECT_NE(octafront_mesh_add_set(mesh.get(), 9, "s", 1, members, 2), 0);
  ASSERT_EQ(octafront_mesh_sets(mesh.get()), 1u);
  int kind = -1;
  octafront_array set;
  EXPECT_EQ(octafront_mesh_set(mesh.get(), 0, &kind, &found, &length, &set), 0);
  EXPECT_EQ(kind, OCTAFRONT_NODES);
  EXPECT_EQ(std::memcmp(set.data, members, sizeof(members)), 0);
  EXPECT_NE(octafront_mesh_set(mesh.get(), 1, &kind, &found, &length, &set), 0);
}

}  // namespace
}  // namespace octafront
