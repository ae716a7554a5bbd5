// From triangles as people have them to what can be meshed: complexes of walls and of bodies, and mending.

#include <octafront/complex.h>
#include <octafront/mend.h>
#include <octafront/repair.h>

#include "doors/c_api/c_api.h"
#include "doors/c_api/job.h"
#include "doors/c_api/json_keys.h"

#include <utility>

namespace octafront::c_api {

namespace {

using Json = nlohmann::ordered_json;

ComplexOptions complex_options_from(Json json) {
  if (json.value("nested", Json()) == "auto") json["nested"] = "direction";
  return intake_from(json).complex;
}

MendOptions mend_options_from(const Json& json) {
  using Way = MendOptions::Way;
  MendOptions options;
  with(json, "tolerance", [&](const Json& v) { options.tolerance = v.get<double>(); });
  with(json, "way", [&](const Json& v) {
    options.way = one_of<Way>({{"auto", Way::kAuto}, {"wrap", Way::kWrap}}, v, "way");
  });
  with(json, "distance", [&](const Json& v) { options.distance = v.get<double>(); });
  return options;
}

void give_complex(octafront_job& job, Complex complex) {
  const std::vector<std::string>& names = complex.surface.region_names;
  job.report["regions"] = Json::array();
  for (std::size_t r = 0; r < complex.volumes.size(); ++r)
    job.report["regions"].push_back({{"name", r < names.size() ? names[r] : ""}, {"volume", complex.volumes[r]}});
  job.report["notes"] = complex.notes;
  give(job, std::move(complex.surface));
}

void divide(octafront_job& job, const SurfaceMesh& walls, const ComplexOptions& options) {
  require_indices(walls);
  with_leak(job, [&] {
    std::optional<Complex> complex = complex_of_walls(walls, options, job.context());
    if (complex) return give_complex(job, std::move(*complex));
    job.report = {{"regions", Json::array()}, {"notes", Json::array()}};
    give(job, walls);
  });
}

void join(octafront_job& job, const std::vector<Body>& bodies, const ComplexOptions& options) {
  for (const Body& body : bodies) require_indices(body.surface);
  with_leak(job, [&] { give_complex(job, join_bodies(bodies, options, job.context())); });
}

void mend(octafront_job& job, const SurfaceMesh& soup, const MendOptions& options) {
  require_indices(soup);
  Mended mended = mend_surface(soup, options, job.context());
  job.report = Json::parse(to_json(mended.report));
  give(job, std::move(mended));
}

}  // namespace

}  // namespace octafront::c_api

using namespace octafront;
using namespace octafront::c_api;

octafront_job* octafront_complex_of_walls(const octafront_surface* surface, const char* json, int threads) {
  return started(
      [surface, text = std::string(json)](octafront_job& job) {
        divide(job, surface->domain.surface, complex_options_from(Json::parse(text)));
      },
      threads);
}

octafront_job* octafront_join_bodies(const octafront_surface* const* bodies, const char* const* names, size_t count,
                                     const char* json, int threads) {
  std::vector<Body> joined;
  if (guarded([&] { joined = bodies_of(bodies, names, count); }) != 0) return nullptr;
  return started([joined = std::move(joined), text = std::string(json)](
                     octafront_job& job) { join(job, joined, complex_options_from(Json::parse(text))); },
                 threads);
}

octafront_job* octafront_mend(const octafront_surface* surface, const char* json, int threads) {
  return started([surface, text = std::string(json)](
                     octafront_job& job) { mend(job, surface->domain.surface, mend_options_from(Json::parse(text))); },
                 threads);
}
