// Metrics as arrays of 3 x 3 numbers.

#include <octafront/adapt.h>
#include <octafront/error.h>
#include <octafront/metric.h>

#include "doors/c_api/job.h"
#include "doors/c_api/json_keys.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace octafront::c_api {

namespace {

using Json = nlohmann::ordered_json;

/// Rows of a matrix each, which must be symmetric to rounding.
std::vector<Metric> tensors_from(const double* m, std::size_t n) {
  std::vector<Metric> out;
  out.reserve(n);
  for (std::size_t i = 0; i < n; ++i, m += 9) {
    const double slack = 1e-9 * (std::abs(m[0]) + std::abs(m[4]) + std::abs(m[8]));
    if (std::abs(m[1] - m[3]) > slack || std::abs(m[2] - m[6]) > slack || std::abs(m[5] - m[7]) > slack)
      throw InputError(fmt::format("the tensor of point {} is not symmetric", i));
    out.push_back({m[0], (m[1] + m[3]) / 2, (m[2] + m[6]) / 2, m[4], (m[5] + m[7]) / 2, m[8]});
  }
  return out;
}

void tensors_to(const std::vector<Metric>& metrics, double* out) {
  for (const Metric& m : metrics)
    for (const double value : {m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz}) *out++ = value;
}

double number_of(const Json& json, const char* key, double otherwise) {
  with(json, key, [&](const Json& value) { otherwise = value.get<double>(); });
  return otherwise;
}

metrics::Bounds bounds_from(const Json& json) {
  metrics::Bounds bounds;
  bounds.min_size = number_of(json, "min_size", bounds.min_size);
  bounds.max_size = number_of(json, "max_size", bounds.max_size);
  return bounds;
}

std::vector<Metric> from_field(const TetMesh& mesh, std::vector<double> values, const Json& json,
                               const RunContext& context) {
  metrics::FromField from;
  from.elements = number_of(json, "elements", from.elements);
  from.norm = number_of(json, "norm", from.norm);
  from.gradation = number_of(json, "gradation", from.gradation);
  from.bounds = bounds_from(json);
  return metrics::of_field(mesh, values, from, context);
}

/// What a caller's arrays hold.
struct MetricArrays {
  const double *first, *second;
  std::size_t n;
};

std::vector<Metric> made_by(const std::string& task, const TetMesh& mesh, const MetricArrays& in, const Json& json,
                            const RunContext& context) {
  if (task == "implied") return metrics::implied(mesh);
  if (task == "hessians") return metrics::hessians(mesh, {in.first, in.first + in.n}, context);
  if (task == "of_field") return from_field(mesh, {in.first, in.first + in.n}, json, context);
  const std::vector<Metric> given = tensors_from(in.first, in.n);
  if (task == "graded") return metrics::graded(mesh, given, number_of(json, "gradation", 0.4), context);
  if (task == "intersected") return metrics::intersected(given, tensors_from(in.second, in.n));
  if (task == "bounded") return metrics::bounded(given, bounds_from(json));
  if (task == "with_complexity")
    return metrics::with_complexity(mesh, given, number_of(json, "complexity", 0), bounds_from(json));
  if (task == "complexity") return given;
  throw OptionError(fmt::format("no task \"{}\" of metrics", task));
}

}  // namespace

}  // namespace octafront::c_api

using namespace octafront;
using namespace octafront::c_api;

octafront_job* octafront_metrics(const octafront_mesh* mesh, const char* json, const double* values,
                                 const double* others, size_t n, double* out, int threads) {
  return started(
      [=, text = std::string(json)](octafront_job& job) {
        const TetMesh none;
        if (mesh != nullptr) require_indices(mesh->mesh);
        const TetMesh& ground = mesh != nullptr ? mesh->mesh : none;
        const Json asked = Json::parse(text);
        const std::string task = asked.value("task", "");
        const std::vector<Metric> made = made_by(task, ground, {values, others, n}, asked, job.context());
        if (task == "complexity") job.report["complexity"] = metrics::complexity(ground, made);
        if (out != nullptr) tensors_to(made, out);
      },
      threads);
}

octafront_job* octafront_adapt_to_metric(const octafront_mesh* mesh, const octafront_surface* ground,
                                         const double* metric, size_t n, const octafront_options* options,
                                         int threads) {
  return started(
      [=](octafront_job& job) {
        require_indices(mesh->mesh);
        const TetMesh& old = mesh->mesh;
        const MetricMesh wanted{old.points, old.tets, {}, tensors_from(metric, n), "the metric"};
        give_adapted(job, adapt_to_metric(old, wanted, job.options_of(options), job.context(), domain_of(ground)));
      },
      threads);
}

octafront_job* octafront_adapt_surface(const octafront_surface* surface, const octafront_surface* ground,
                                       const double* metric, size_t n, const octafront_options* options, int threads) {
  return started(
      [=](octafront_job& job) {
        const SurfaceMesh& old = domain_of(surface)->surface;
        const Options asked = job.options_of(options);
        if (metric == nullptr) return give_adapted(job, adapt_surface(old, asked, job.context(), domain_of(ground)));
        const MetricMesh wanted{old.points, {}, old.triangles, tensors_from(metric, n), "the metric"};
        give_adapted(job, adapt_surface_to_metric(old, wanted, asked, job.context(), domain_of(ground)));
      },
      threads);
}
