// From triangles as people have them to what can be meshed: complexes of walls and of bodies, and mending.

#include <octafront/complex.h>
#include <octafront/error.h>
#include <octafront/mend.h>
#include <octafront/repair.h>

#include "c_api/c_api.h"
#include "c_api/job.h"
#include "c_api/json_keys.h"

#include <utility>

namespace octafront::c_api {

namespace {

using Json = nlohmann::ordered_json;

Vec3 point_of(const Json& row) {
  if (row.size() != 3) throw OptionError(fmt::format("a point has three coordinates, not {}", row.dump()));
  return {row.at(0).get<double>(), row.at(1).get<double>(), row.at(2).get<double>()};
}

ComplexOptions complex_options_from(const Json& json) {
  using Cells = ComplexOptions::Cells;
  using Nested = ComplexOptions::Nested;
  ComplexOptions options;
  with(json, "regions", [&](const Json& v) {
    for (const Json& row : v) options.regions.push_back({row.at(0).get<std::string>(), point_of(row.at(1))});
  });
  with(json, "voids", [&](const Json& v) {
    for (const Json& row : v) options.voids.push_back(point_of(row));
  });
  with(json, "cells", [&](const Json& v) {
    options.cells =
        one_of<Cells>({{"auto", Cells::kAuto}, {"regions", Cells::kRegions}, {"merge", Cells::kMerge}}, v, "cells");
  });
  with(json, "nested", [&](const Json& v) {
    options.nested = one_of<Nested>(
        {{"auto", Nested::kByDirection}, {"cavity", Nested::kCavity}, {"region", Nested::kRegion}}, v, "nested");
  });
  with(json, "tolerance", [&](const Json& v) { options.tolerance = v.get<double>(); });
  return options;
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
  job.report["regions"] = json_of_regions(complex);
  job.report["notes"] = complex.notes;
  give(job, std::move(complex.surface));
}

/// A leak leaves the way through it in the report.
template <class Work>
void with_leak(octafront_job& job, const Work& work) {
  try {
    work();
  } catch (const LeakError& leak) {
    job.report["leak"] = Json::array();
    for (const Vec3 p : leak.way) job.report["leak"].push_back({p.x, p.y, p.z});
    throw;
  }
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
  give(job, std::move(mended.surface));
  job.surface->bound = std::move(mended.bound);
}

}  // namespace

}  // namespace octafront::c_api

using namespace octafront;
using namespace octafront::c_api;

octafront_job* octafront_complex_of_walls(const octafront_surface* surface, const char* json, int threads) {
  return started([surface, text = std::string(json)](
                     octafront_job& job) { divide(job, surface->mesh, complex_options_from(Json::parse(text))); },
                 threads);
}

octafront_job* octafront_join_bodies(const octafront_surface* const* bodies, const char* const* names, size_t count,
                                     const char* json, int threads) {
  std::vector<Body> joined;
  if (guarded([&] {
        for (size_t i = 0; i < count; ++i) joined.push_back({names[i], bodies[i]->mesh});
      }) != 0)
    return nullptr;
  return started([joined = std::move(joined), text = std::string(json)](
                     octafront_job& job) { join(job, joined, complex_options_from(Json::parse(text))); },
                 threads);
}

octafront_job* octafront_mend(const octafront_surface* surface, const char* json, int threads) {
  return started([surface, text = std::string(json)](
                     octafront_job& job) { mend(job, surface->mesh, mend_options_from(Json::parse(text))); },
                 threads);
}
