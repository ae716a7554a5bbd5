// The way in: files, surfaces, bodies and images become domains.

#include <octafront/cad.h>
#include <octafront/domain.h>
#include <octafront/error.h>
#include <octafront/formula.h>
#include <octafront/options.h>

#include "doors/c_api/c_api.h"
#include "doors/c_api/job.h"
#include "doors/c_api/json_keys.h"

#include <limits>
#include <utility>

#include <fmt/core.h>

namespace octafront::c_api {

namespace {

using Json = nlohmann::ordered_json;

Vec3 point_of(const Json& row) {
  if (row.size() != 3) throw OptionError(fmt::format("a point has three coordinates, not {}", row.dump()));
  return {row.at(0).get<double>(), row.at(1).get<double>(), row.at(2).get<double>()};
}

std::vector<Vec3> points_of(const Json& rows) {
  std::vector<Vec3> points;
  for (const Json& row : rows) points.push_back(point_of(row));
  return points;
}

GreyBand band_of(const Json& row) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {row.at(1).is_null() ? -kInfinity : row.at(1).get<double>(),
          row.at(2).is_null() ? kInfinity : row.at(2).get<double>(), row.at(0).get<std::string>()};
}

std::optional<std::uint32_t> voxel_of(const Json& value) {
  if (value.is_null()) return std::nullopt;
  const auto n = value.get<std::int64_t>();
  if (n < 0 || n >= std::numeric_limits<std::uint32_t>::max())
    throw OptionError(fmt::format("`crop` has the voxel {}, which no image has", n));
  return static_cast<std::uint32_t>(n);
}

/// A key whose value is more than one.
using Take = void (*)(IntakeOptions&, const Json&);

const std::map<std::string, Take>& lists() {
  static const std::map<std::string, Take> all{
      {"regions",
       [](IntakeOptions& o, const Json& v) {
         for (const Json& row : v) o.complex.regions.push_back({row.at(0).get<std::string>(), point_of(row.at(1))});
       }},
      {"voids",
       [](IntakeOptions& o, const Json& v) {
         for (const Json& row : v) o.complex.voids.push_back(point_of(row));
       }},
      {"sheet_files",
       [](IntakeOptions& o, const Json& v) { o.inside.sheet_files = v.get<std::vector<std::string>>(); }},
      {"wire_files", [](IntakeOptions& o, const Json& v) { o.inside.wire_files = v.get<std::vector<std::string>>(); }},
      {"point_files",
       [](IntakeOptions& o, const Json& v) { o.inside.point_files = v.get<std::vector<std::string>>(); }},
      {"inside_sheets",
       [](IntakeOptions& o, const Json& v) {
         for (const Json& row : v)
           o.inside.sheets.push_back({row.at(0).get<std::string>(),
                                      {points_of(row.at(1)), row.at(2).get<std::vector<Triangle>>(), {}, {}, {}}});
       }},
      {"inside_wires",
       [](IntakeOptions& o, const Json& v) {
         for (const Json& row : v)
           o.inside.wires.push_back(
               {row.at(0).get<std::string>(), points_of(row.at(1)), row.at(2).get<std::vector<Edge>>()});
       }},
      {"inside_points",
       [](IntakeOptions& o, const Json& v) {
         for (const Json& row : v) o.inside.points.push_back({row.at(0).get<std::string>(), points_of(row.at(1))});
       }},
      {"size", [](IntakeOptions& o, const Json& v) { o.image.size = v.get<double>(); }},
      {"names_file", [](IntakeOptions& o, const Json& v) { o.image.names_file = v.get<std::string>(); }},
      {"names",
       [](IntakeOptions& o, const Json& v) {
         for (const Json& row : v)
           o.image.regions.labels.names.push_back({row.at(0).get<std::int64_t>(), row.at(1).get<std::string>()});
       }},
      {"ignore",
       [](IntakeOptions& o, const Json& v) { o.image.regions.labels.ignore = v.get<std::vector<std::int64_t>>(); }},
      {"merge",
       [](IntakeOptions& o, const Json& v) {
         for (const Json& row : v)
           o.image.regions.labels.merge.push_back(
               {row.at(0).get<std::string>(), row.at(1).get<std::vector<std::int64_t>>()});
       }},
      {"surface_of",
       [](IntakeOptions& o, const Json& v) {
         for (const Json& row : v)
           o.image.surface_files.push_back({row.at(0).get<std::string>(), row.at(1).get<std::string>()});
       }},
      {"bands",
       [](IntakeOptions& o, const Json& v) {
         for (const Json& row : v) o.image.regions.bands.push_back(band_of(row));
       }},
      {"crop",
       [](IntakeOptions& o, const Json& v) {
         for (std::size_t axis = 0; axis < 3; ++axis)
           o.image.crop[axis] = {voxel_of(v.at(axis).at(0)), voxel_of(v.at(axis).at(1))};
       }},
      {"apart", [](IntakeOptions& o, const Json& v) { o.cad.apart = v.get<std::vector<std::string>>(); }},
      {"resample",
       [](IntakeOptions& o, const Json& v) {
         o.image.resample = v.is_number() ? std::vector{v.get<double>()} : v.get<std::vector<double>>();
       }},
  };
  return all;
}

/// Leaves a domain, and what was found and done in the report, also of an opening that fails.
void open(octafront_job& job, IntakeOptions options, const std::function<Domain(const IntakeOptions&)>& opened) {
  job.report["notes"] = Json::array();
  options.tell = [&](const IntakeNote& note) {
    if (!note.stage.empty()) job.report["notes"].push_back(note.text);
  };
  with_leak(job, [&] {
    Domain domain = opened(options);
    job.report["format"] = domain.format;
    job.report["regions"] = Json::array();
    const Json known = Json::parse(to_json(domain));
    for (const auto& [key, value] : known.items()) job.report[key == "input_regions" ? "regions" : key] = value;
    if (domain.voxel_spacing > 0) {
      job.report["size"] = domain.voxels;
      job.report["voxel"] = domain.voxel_spacing;
    }
    give(job, std::move(domain));
  });
}

}  // namespace

IntakeOptions intake_from(const Json& json) {
  IntakeOptions options;
  for (const auto& [name, value] : json.items()) {
    const auto list = lists().find(name);
    if (list != lists().end()) {
      with(json, name.c_str(), [&](const Json& v) { list->second(options, v); });
    } else if (!value.is_null()) {
      set_option(options, name, value_of(name, value));
    }
  }
  return options;
}

std::vector<Body> bodies_of(const octafront_surface* const* bodies, const char* const* names, std::size_t count) {
  std::vector<Body> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back({names[i], bodies[i]->domain.surface});
  return all;
}

}  // namespace octafront::c_api

using namespace octafront;
using namespace octafront::c_api;

octafront_job* octafront_open_files(const char* const* files, size_t count, const char* json,
                                    const octafront_options* options, int threads) {
  return started(
      [names = std::vector<std::string>(files, files + count), text = std::string(json), options,
       meant = options == nullptr ? Options{} : options->options](octafront_job& job) {
        job.on_ranks(options, "open", [&](const RunContext&) {
          open(job, intake_for(meant, intake_from(Json::parse(text))),
               [&](const IntakeOptions& intake) { return open_domain(names, intake, job.context()); });
        });
      },
      threads);
}

int octafront_is_cad(const char* file) {
  return is_cad(file) ? 1 : 0;
}

int octafront_is_formula(const char* input) {
  return is_formula(input) ? 1 : 0;
}

octafront_job* octafront_open_samples(const double* values, const uint32_t* size, const double* box, const char* json,
                                      int threads) {
  SampledFunction samples{{{box[0], box[1], box[2]}, {box[3], box[4], box[5]}}, {size[0], size[1], size[2]}, {}};
  std::size_t count = 1;
  for (const std::uint32_t n : samples.size) count *= std::size_t{n} + 2;
  if (guarded([&] { samples.values.assign(values, values + count); }) != 0) return nullptr;
  return started(
      [samples = std::move(samples), text = std::string(json)](octafront_job& job) {
        open(job, intake_from(Json::parse(text)),
             [&](const IntakeOptions& options) { return open_samples(samples, options, job.context()); });
      },
      threads);
}

octafront_job* octafront_open_surface(const octafront_surface* surface, const char* json, int threads) {
  return started(
      [surface, text = std::string(json)](octafront_job& job) {
        require_indices(surface->domain.surface);
        open(job, intake_from(Json::parse(text)),
             [&](const IntakeOptions& options) { return open_domain(surface->domain, options, job.context()); });
      },
      threads);
}

octafront_job* octafront_open_bodies(const octafront_surface* const* bodies, const char* const* names, size_t count,
                                     const char* json, int threads) {
  std::vector<Body> all;
  if (guarded([&] { all = bodies_of(bodies, names, count); }) != 0) return nullptr;
  return started(
      [all = std::move(all), text = std::string(json)](octafront_job& job) {
        for (const Body& body : all) require_indices(body.surface);
        open(job, intake_from(Json::parse(text)),
             [&](const IntakeOptions& options) { return open_domain(all, options, job.context()); });
      },
      threads);
}

octafront_job* octafront_image_surface(const octafront_image* image, const char* json, int threads) {
  return started(
      [image, text = std::string(json)](octafront_job& job) {
        open(job, intake_from(Json::parse(text)),
             [&](const IntakeOptions& options) { return open_domain(image->image, options, job.context()); });
      },
      threads);
}
