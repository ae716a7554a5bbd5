#include <octafront/error.h>
#include <octafront/image_samples.h>
#include <octafront/run_context.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/core/wording.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Of fewer middles of voxels the mean depends on where the element lies between them.
constexpr std::size_t kFewVoxels = 8;
/// The quadrature of degree two: each point has this part of one corner, and the rest in equal parts of the others.
constexpr double kNear = 0.58541019662496845, kFar = (1 - kNear) / 3;

using Corners = std::array<Vec3, 4>;

/// A place along an axis: `first` and the voxel behind it, which has the part `behind`.
struct Between {
  std::size_t first = 0, next = 0;
  double behind = 0;
};

/// The voxels i of a row that lie in a tetrahedron of index space: f_m(i) >= 0 for the four functions that are linear.
class RowsOfTet {
 public:
  explicit RowsOfTet(const Corners& c) : origin_(c[0]) {
    const Vec3 e1 = c[1] - c[0], e2 = c[2] - c[0], e3 = c[3] - c[0];
    const double det = dot(e1, cross(e2, e3));
    slope_ = {Vec3{}, cross(e2, e3) * (1 / det), cross(e3, e1) * (1 / det), cross(e1, e2) * (1 / det)};
    slope_[0] = (slope_[1] + slope_[2] + slope_[3]) * -1;
  }
  /// lo > hi: none.
  std::pair<double, double> row(double lo, double hi, double j, double k) const {
    for (int m = 0; m < 4; ++m) {
      const Vec3 g = slope_[static_cast<std::size_t>(m)];
      const double at_zero = (m == 0 ? 1 : 0) + dot(g, Vec3{0, j, k} - origin_);
      if (g.x > 0) lo = std::max(lo, -at_zero / g.x);
      if (g.x < 0) hi = std::min(hi, -at_zero / g.x);
      if (g.x == 0 && at_zero < 0) return {1, 0};
    }
    return {lo, hi};
  }

 private:
  Vec3 origin_;
  std::array<Vec3, 4> slope_;
};

template <class T>
class Sampler {
 public:
  Sampler(const ImageGrid& grid, const std::vector<T>& values) : grid_(grid), values_(values) {
    for (std::uint32_t k = 0; k < grid.size[2]; ++k) slices_.push_back(grid.slice(k));
  }

  double linear(Vec3 world) const {
    const Vec3 at = grid_.to_index(world);
    const Between i = along(at.x, 0), j = along(at.y, 1), k = slice(at.z);
    const auto row = [&](std::size_t b, std::size_t c) {
      return (1 - i.behind) * value(i.first, b, c) + i.behind * value(i.next, b, c);
    };
    const auto plane = [&](std::size_t c) { return (1 - j.behind) * row(j.first, c) + j.behind * row(j.next, c); };
    return (1 - k.behind) * plane(k.first) + k.behind * plane(k.next);
  }

  double mean(const Corners& world) const {
    double sum = 0;
    const std::size_t voxels = add_voxels(world, sum);
    if (voxels >= kFewVoxels) return sum / static_cast<double>(voxels);
    const Vec3 all = world[0] + world[1] + world[2] + world[3];
    double mean = 0;
    for (const Vec3 corner : world) mean += linear(all * kFar + corner * (kNear - kFar)) / 4;
    return mean;
  }

  bool holds(Vec3 world) const {
    const Vec3 at = grid_.to_index(world);
    return at.x >= -.5 && at.x <= grid_.size[0] - .5 && at.y >= -.5 && at.y <= grid_.size[1] - .5 &&
           at.z >= slices_.front() - .5 && at.z <= slices_.back() + .5;
  }

 private:
  double value(std::size_t i, std::size_t j, std::size_t k) const {
    return static_cast<double>(values_[i + grid_.size[0] * (j + grid_.size[1] * k)]);
  }

  Between along(double at, std::size_t axis) const {
    const std::size_t last = grid_.size[axis] - 1;
    const double inside = std::clamp(at, 0.0, static_cast<double>(last));
    const auto first = static_cast<std::size_t>(inside);
    return {first, std::min(first + 1, last), inside - static_cast<double>(first)};
  }

  Between slice(double at) const {
    const double inside = std::clamp(at, slices_.front(), slices_.back());
    const auto above = std::upper_bound(slices_.begin(), slices_.end(), inside) - slices_.begin();
    const std::size_t first = static_cast<std::size_t>(above) - 1, next = std::min(first + 1, slices_.size() - 1);
    return {first, next, next == first ? 0 : (inside - slices_[first]) / (slices_[next] - slices_[first])};
  }

  /// How many voxels have their middles in the tetrahedron.
  std::size_t add_voxels(const Corners& world, double& sum) const {
    Corners c;
    Box3 box;
    for (std::size_t m = 0; m < 4; ++m) box.add(c[m] = grid_.to_index(world[m]));
    const RowsOfTet rows(c);
    const auto first_k = std::lower_bound(slices_.begin(), slices_.end(), box.lo.z) - slices_.begin();
    std::size_t voxels = 0;
    for (auto k = static_cast<std::size_t>(first_k); k < slices_.size() && slices_[k] <= box.hi.z; ++k)
      for (double j = std::max(0.0, std::ceil(box.lo.y)); j <= std::min(grid_.size[1] - 1.0, box.hi.y); ++j) {
        const auto [lo, hi] = rows.row(box.lo.x, box.hi.x, j, slices_[k]);
        for (double i = std::max(0.0, std::ceil(lo)); i <= std::min(grid_.size[0] - 1.0, hi); ++i, ++voxels)
          sum += value(static_cast<std::size_t>(i), static_cast<std::size_t>(j), k);
      }
    return voxels;
  }

  const ImageGrid& grid_;
  const std::vector<T>& values_;
  std::vector<double> slices_;
};

Corners corners_of(const TetMesh& mesh, std::size_t t) {
  const auto& [a, b, c, d] = mesh.tets[t];
  return {mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]};
}

/// The tetrahedra of a wedge or pyramid, which files have as one element, share their mean by volume.
void even_in_wide_cells(const TetMesh& mesh, std::vector<double>& values) {
  for (const WideCell& cell : mesh.wide_cells) {
    double sum = 0, volume = 0;
    for (std::size_t t = cell.first; t < cell.first + cell.tet_count; ++t) {
      const Corners c = corners_of(mesh, t);
      const double part = six_volumes(c[0], c[1], c[2], c[3]);
      sum += values[t] * part, volume += part;
    }
    std::fill_n(values.begin() + cell.first, cell.tet_count, sum / volume);
  }
}

template <class T>
void sample(const TetMesh& mesh, const Sampler<T>& sampler, ImageSamples& samples) {
  std::vector<std::uint8_t> outside(mesh.tets.size());
  parallel_for(mesh.tets.size(), [&](std::size_t t) {
    const Corners c = corners_of(mesh, t);
    samples.of_elements.values[t] = sampler.mean(c);
    outside[t] = !sampler.holds(centroid(c[0], c[1], c[2], c[3]));
  });
  parallel_for(mesh.points.size(),
               [&](std::size_t v) { samples.at_points.values[v] = sampler.linear(mesh.points[v]); });
  even_in_wide_cells(mesh, samples.of_elements.values);
  const auto count = static_cast<std::size_t>(std::count(outside.begin(), outside.end(), 1));
  if (count == 0) return;
  if (count == outside.size())
    throw InputError(fmt::format("{}: the whole mesh lies outside of the image", samples.at_points.name));
  samples.notes.push_back(fmt::format("{}: {} of {} lie outside of the image, and have the values at its edge",
                                      samples.at_points.name, count, counted(outside.size(), "element")));
}

}  // namespace

ImageSamples sample_image(const TetMesh& mesh, const Image& image, const std::string& name, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  context.check();
  ImageSamples samples{{name, true, 1, std::vector<double>(mesh.tets.size())},
                       {name, false, 1, std::vector<double>(mesh.points.size())},
                       {}};
  std::visit([&](const auto& values) { sample(mesh, Sampler(image.grid, values), samples); }, image.values);
  context.check();
  return samples;
}

Image in_frame(Image image, const std::string& frame) {
  const auto is_one = [](const std::string& f) { return f == "RAS" || f == "LPS"; };
  if (!is_one(frame) || !is_one(image.frame) || frame == image.frame) return image;
  const auto turn = [](Vec3& v) { v = {-v.x, -v.y, v.z}; };
  for (Vec3& axis : image.grid.axes) turn(axis);
  turn(image.grid.origin);
  image.frame = frame;
  return image;
}

}  // namespace octafront
