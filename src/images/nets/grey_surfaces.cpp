#include <octafront/error.h>
#include <octafront/image_surface.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "images/nets/cell_labels.h"
#include "images/nets/cells.h"
#include "images/nets/conflicts.h"
#include "images/nets/function_surface.h"
#include "images/nets/grey_values.h"
#include "images/nets/net_steps.h"
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

  /// The nearest place to p, about, where the values pass the vertex's limit, if it has just one. Of a function it is
  /// one step of Newton's from there, or as near as doubles come.
  Vec3 on_limit(VertexIndex v, Vec3 p, bool exactly = false) const {
    constexpr int kSteps = 6;
    p = cells_.clamped(v, p);
    if (std::isnan(limit_[v])) return p;
    if (function_ != nullptr) return on_zero(v, p, exactly);
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
  /// What is not looked at again before all have moved lies on a zero after a step no longer than this part of six
  /// voxels; the next step would be about its square.
  static constexpr double kNearZero = 0.005;

  /// The same of the function itself, on the faces of the box within them.
  Vec3 on_zero(VertexIndex v, Vec3 p, bool exactly) const {
    unsigned fixed = 0;
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
      fixed |= lattice_.on_box(net_.corner[v], axis) ? 1u << axis : 0u;
      reach += 2 * (lattice_.wall(axis, 1) - lattice_.wall(axis, 0));
    }
    if (fixed == 7) return p;
    const Vec3 world = lattice_.to_world(p);
    return cells_.clamped(
        v, p + (formulas::nearest_zero(*function_, world, fixed, reach, exactly ? 0 : kNearZero * reach) - world));
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

/// How many sweeps ago a place may have been right for what is in the box: with each sweep a vertex hears of those a
/// voxel farther off, some of which lie two voxels away.
class Needed {
 public:
  Needed(const Lattice& lattice, const Box3& box) : lattice_(lattice), box_(box) {}
  bool by(Vec3 straight, int sweeps_left) const {
    if (box_.empty()) return true;
    const Vec3 p = lattice_.to_world(straight);
    for (int axis = 0; axis < 3; ++axis) {
      const double reach = (2 + 1.5 * sweeps_left) * (lattice_.wall(axis, 1) - lattice_.wall(axis, 0));
      if (p[axis] < box_.lo[axis] - reach || p[axis] > box_.hi[axis] + reach) return false;
    }
    return true;
  }

 private:
  const Lattice& lattice_;
  const Box3& box_;
};

void spread(const nets::Stencils& stencils, const Placement& placement, const Needed& needed, std::vector<Vec3>& x,
            const RunContext& context) {
  std::vector<Vec3> next(x.size());
  for (int sweep = 0; sweep < kSpreadingSweeps; ++sweep) {
    context.check();
    parallel_for(x.size(), [&](std::size_t i) {
      const auto v = static_cast<VertexIndex>(i);
      const int left = kSpreadingSweeps - 1 - sweep;
      next[i] = needed.by(x[i], left)
                    ? placement.on_limit(v, x[i] + stencils.difference(x, v) * kSpreadingStep, left == 0)
                    : x[i];
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
                          const formulas::SpaceFunction* function, const PeriodicMargin& margin, const Box3& needed,
                          const RunContext& context) {
  const ThreadLimit thread_limit(context.threads);
  const BandLimits limits(bands);
  const LabelImage labels = labels_of_bands(image, bands);
  const nets::CellLabels in_cell(labels.grid, labels.regions, labels.labels.size(), margin);
  const Lattice& lattice = in_cell.lattice();
  Net net = nets::make_net(lattice);
  context.check();
  const Groups<> quads_at = nets::quads_at_vertices(net);
  const nets::Stencils stencils(net, quads_at);
  const nets::Mates mates(lattice, net);
  const nets::VertexCells cells(lattice, net);
  const GreyValues values(image, lattice);
  Placement placement(net, quads_at, lattice, values, limits, cells, function);
  std::vector<Vec3> x = placement.place();
  spread(stencils, placement, Needed(lattice, needed), x, context);
  mates.bring_together(lattice, net, x);
  nets::ResolvedNet resolved = nets::resolve_conflicts(net, quads_at, lattice, x, context, mates);
  in_cell.cut_out_cell(net);
  return nets::assemble(net, lattice, std::move(resolved), x, labels.labels, false);
}

}  // namespace

Complex complex_of_bands(const Image& image, const std::vector<GreyBand>& bands, const RunContext& context) {
  return complex_of_bands(image, bands, {0, 0, 0}, context);
}

Complex complex_of_bands(const Image& image, const std::vector<GreyBand>& bands, const PeriodicMargin& margin,
                         const RunContext& context) {
  return complex_of_values(image, bands, nullptr, margin, {}, context);
}

Complex complex_of_function(const Image& image, const formulas::SpaceFunction& function, const RunContext& context,
                            const Box3& needed) {
  return complex_of_values(image, {{-std::numeric_limits<double>::infinity(), 0, "body"}}, &function, {0, 0, 0}, needed,
                           context);
}

}  // namespace octafront
