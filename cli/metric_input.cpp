#include "metric_input.h"

#include <algorithm>
#include <array>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

bool was_typed(const Arguments& a, std::string_view option) {
  return std::any_of(a.given.begin(), a.given.end(), [&](const auto& entry) { return entry.first == option; });
}

constexpr std::array<std::string_view, 15> kSizes{
    "size", "sizes",   "size-field", "size-of",          "size-near", "regions",     "point-sizes",     "curvature",
    "gap",  "through", "facets",     "automatic-factor", "interior",  "chord-error", "feature-elements"};

bool is_asked(const Arguments& a) {
  return !a.metric.empty() || !a.field.empty();
}

metrics::Bounds bounds_of(const Options& options) {
  metrics::Bounds bounds;
  if (options.size.min_size) bounds.min_size = *options.size.min_size;
  if (options.size.max_size) bounds.max_size = *options.size.max_size;
  return bounds;
}

MetricMesh metric_from_field(const Session& session, const TetMesh& mesh) {
  const Arguments& a = session.arguments();
  metrics::FromField from;
  from.elements = static_cast<double>(a.options.size.elements.value_or(0));
  from.norm = a.norm;
  from.gradation = a.options.size.gradation.value_or(from.gradation);
  from.bounds = bounds_of(a.options);
  const std::vector<double> values = read_point_values(a.input.string(), a.field, mesh, session.context());
  return {mesh.points, mesh.tets, {}, metrics::of_field(mesh, values, from, session.context()), a.field};
}

/// A metric of a file, changed as options say that were given.
MetricMesh metric_from_file(const Session& session) {
  const Arguments& a = session.arguments();
  MetricMesh metric = read_metric(a.metric, a.input.string(), session.context());
  const metrics::Bounds bounds = bounds_of(a.options);
  const bool is_bounded = a.options.size.min_size || a.options.size.max_size;
  const bool needs_mesh = a.options.size.gradation || a.options.size.elements;
  if (needs_mesh && metric.tets.empty())
    throw OptionError("--gradation and --elements of a metric need a mesh of tetrahedra that it stands on");
  TetMesh ground;
  ground.points = metric.points, ground.tets = metric.tets;
  if (is_bounded) metric.metrics = metrics::bounded(metric.metrics, bounds);
  if (a.options.size.gradation)
    metric.metrics = metrics::graded(ground, metric.metrics, *a.options.size.gradation, session.context());
  if (a.options.size.elements) {
    const double target = static_cast<double>(*a.options.size.elements) / metrics::kElementsPerComplexity;
    metric.metrics = metrics::with_complexity(ground, metric.metrics, target, bounds);
  }
  return metric;
}

}  // namespace

void check_metric_options(const Arguments& a) {
  if (!is_asked(a)) {
    if (!a.metric_out.empty())
      throw OptionError("--save-metric writes the metric of --metric or --from; neither is given");
    return;
  }
  if (!a.metric.empty() && !a.field.empty()) throw OptionError("--metric and --from are two metrics; give one");
  if (!a.field.empty() && !a.options.size.elements)
    throw OptionError("--from needs a number of elements, as --elements 100000");
  for (const std::string_view option : kSizes)
    if (was_typed(a, option))
      throw OptionError(fmt::format("--{} asks for sizes, and {} says all of them: leave one out", option,
                                    a.metric.empty() ? "--from" : "--metric"));
  if (!a.metric_out.empty()) check_metric_target(a.metric_out.string());
}

std::optional<MetricMesh> metric_asked_for(const Session& session, const TetMesh& mesh) {
  const Arguments& a = session.arguments();
  const bool asks_for_sizes =
      was_typed(a, "elements") || std::any_of(kSizes.begin(), kSizes.end(), [&](auto o) { return was_typed(a, o); });
  // What is only to be cut keeps its sizes.
  if (!is_asked(a) && !a.level_sets.empty() && !asks_for_sizes) {
    TetMesh linear = mesh;
    make_linear(linear);
    std::vector<Metric> lengths = metrics::of_edges(linear);
    return MetricMesh{
        std::move(linear.points), std::move(linear.tets), {}, std::move(lengths), "the sizes of the mesh"};
  }
  if (!is_asked(a)) return std::nullopt;
  MetricMesh metric = a.metric.empty() ? metric_from_field(session, mesh) : metric_from_file(session);
  if (!a.metric_out.empty()) write_metric(a.metric_out.string(), metric, session.context());
  return metric;
}

}  // namespace octafront::cli
