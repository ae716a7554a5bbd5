#include <octafront/error.h>
#include <octafront/image_surface.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "images/nets/assemble.h"
#include "images/nets/cells.h"
#include "images/nets/check_image.h"
#include "images/nets/function_surface.h"
#include "images/nets/grey_values.h"
#include "images/nets/resolve_conflicts.h"
#include "images/nets/stencils.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

namespace octafront {

namespace {

using nets::BandLimits;
using nets::GreyValues;
using nets::Lattice;
using nets::Net;

LabelImage labels_within(const Image& image, const std::vector<GreyBand>& bands, const BandLimits& limits) {
  LabelImage labels;
  labels.grid = image.grid;
  for (std::size_t b = 0; b < bands.size(); ++b) labels.labels.push_back({static_cast<std::int64_t>(b), bands[b].name});
  std::visit(
      [&](const auto& values) {
        labels.regions.resize(values.size());
        parallel_for(values.size(), [&](std::size_t i) {
          labels.regions[i] = limits.label(limits.rank(static_cast<double>(values[i])));
        });
      },
      image.values);
  return labels;
}

/// Puts vertices where the values pass the limits of bands.
class Placement {
 public:
  Placement(const Net& net, const Groups<>& quads_at, const Lattice& lattice, const GreyValues& values,
            const BandLimits& limits, const nets::VertexCells& cells, const formulas::SpaceFunction* function = nullptr)
      : function_(function),
        net_(net),
        quads_at_(quads_at),
        lattice_(lattice),
        values_(values),
        limits_(limits),
        cells_(cells),
        limit_(net.corner.size(), kSeveral) {}

  std::vector<Vec3> place() {
    std::vector<Vec3> x = net_.start;
    parallel_for(x.size(), [&](std::size_t v) {
      x[v] = on_limit(static_cast<VertexIndex>(v), mean_of_passes(static_cast<VertexIndex>(v)));
    });
    return x;
  }

  /// The nearest place to p, about, where the values pass the vertex's limit, if it has just one.
  Vec3 on_limit(VertexIndex v, Vec3 p) const {
    constexpr int kSteps = 6;
    p = cells_.clamped(v, p);
    if (std::isnan(limit_[v])) return p;
    if (function_ != nullptr) return on_zero(v, p);
    for (int step = 0; step < kSteps; ++step) {
      const GreyValues::Sample s = values_.near(net_.corner[v], p);
      const double steepness = squared_length(s.gradient);
      if (!(steepness > 0)) break;
      p = cells_.clamped(v, p + s.gradient * ((limit_[v] - s.value) / steepness));
    }
    return p;
  }

 private:
  static constexpr double kSeveral = std::numeric_limits<double>::quiet_NaN();

  /// The same of the function itself, on the faces of the box within them.
  Vec3 on_zero(VertexIndex v, Vec3 p) const {
    unsigned fixed = 0;
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
      fixed |= lattice_.on_box(net_.corner[v], axis) ? 1u << axis : 0u;
      reach += 2 * (lattice_.wall(axis, 1) - lattice_.wall(axis, 0));
    }
    if (fixed == 7) return p;
    const Vec3 world = lattice_.to_world(p);
    return cells_.clamped(v, p + (formulas::nearest_zero(*function_, world, fixed, reach) - world));
  }

  /// Of the places where the lines between voxels pass limits, on the two sides of each face at the vertex.
  Vec3 mean_of_passes(VertexIndex v) {
    Vec3 sum;
    int passes = 0;
    bool one_limit = true;
    for (const std::uint32_t q : quads_at_[v]) {
      const nets::Quad& quad = net_.quads[q];
      if (quad.box != 0) continue;
      const nets::Corner upper = net_.corner[quad.v[0]];
      nets::Corner lower = upper;
      --lower[quad.axis];
      const double a = values_.at(lower), b = values_.at(upper);
      const double limit = limits_.between(limits_.rank(a), limits_.rank(b));
      one_limit = one_limit && (passes == 0 || limit == limit_[v]);
      limit_[v] = limit;
      Vec3 p = lattice_.middle_of(lower);
      p[quad.axis] += (limit - a) / (b - a) * (lattice_.middle(quad.axis, upper[quad.axis]) - p[quad.axis]);
      sum += p;
      ++passes;
    }
    if (!one_limit) limit_[v] = kSeveral;
    return passes == 0 ? net_.start[v] : sum / passes;
  }

  const formulas::SpaceFunction* function_;  ///< null: the values are all that is known
  const Net& net_;
  const Groups<>& quads_at_;
  const Lattice& lattice_;
  const GreyValues& values_;
  const BandLimits& limits_;
  const nets::VertexCells& cells_;
  std::vector<double> limit_;  ///< of each vertex
};

// Along the surface vertices spread until triangles are even; a few sweeps do most of it.
constexpr int kSpreadingSweeps = 12;
constexpr double kSpreadingStep = 0.5;

void spread(const nets::Stencils& stencils, const Placement& placement, std::vector<Vec3>& x,
            const RunContext& context) {
  std::vector<Vec3> next(x.size());
  for (int sweep = 0; sweep < kSpreadingSweeps; ++sweep) {
    context.check();
    parallel_for(x.size(), [&](std::size_t i) {
      const auto v = static_cast<VertexIndex>(i);
      next[i] = placement.on_limit(v, x[i] + stencils.difference(x, v) * kSpreadingStep);
    });
    x.swap(next);
  }
}

}  // namespace

LabelImage labels_of_bands(const Image& image, const std::vector<GreyBand>& bands) {
  const std::size_t values = std::visit([](const auto& v) { return v.size(); }, image.values);
  nets::check_grid(image.grid, values);
  LabelImage labels = labels_within(image, bands, BandLimits(bands));
  for (std::size_t i = 0; i < values; ++i)
    if (labels.regions[i] != LabelImage::kNoRegion) return labels;
  throw InputError("no value of the image lies in a band: look at its histogram with octafront info");
}

namespace {

Complex complex_of_values(const Image& image, const std::vector<GreyBand>& bands,
                          const formulas::SpaceFunction* function, const RunContext& context) {
  const ThreadLimit thread_limit(context.threads);
  const BandLimits limits(bands);
  const LabelImage labels = labels_of_bands(image, bands);
  const Lattice lattice(labels.grid, labels.regions);
  Net net = nets::make_net(lattice);
  context.check();
  const Groups<> quads_at = nets::quads_at_vertices(net);
  const nets::Stencils stencils(net, quads_at);
  const nets::VertexCells cells(lattice, net);
  const GreyValues values(image, lattice);
  Placement placement(net, quads_at, lattice, values, limits, cells, function);
  std::vector<Vec3> x = placement.place();
  spread(stencils, placement, x, context);
  nets::ResolvedNet resolved = nets::resolve_conflicts(net, quads_at, lattice, x, context);
  return nets::assemble(net, lattice, std::move(resolved), x, labels.labels, false);
}

}  // namespace

Complex complex_of_bands(const Image& image, const std::vector<GreyBand>& bands, const RunContext& context) {
  return complex_of_values(image, bands, nullptr, context);
}

Complex complex_of_function(const Image& image, const formulas::SpaceFunction& function, const RunContext& context) {
  return complex_of_values(image, {{-std::numeric_limits<double>::infinity(), 0, "body"}}, &function, context);
}

}  // namespace octafront
