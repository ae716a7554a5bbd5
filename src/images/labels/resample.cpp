#include <octafront/error.h>
#include <octafront/image.h>
#include <octafront/run_context.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

using Sizes = std::array<std::uint32_t, 3>;

/// How much of old voxels goes into a new one, along one axis.
struct Share {
  std::uint32_t index = 0;
  double weight = 0;
};
using Shares = std::vector<std::vector<Share>>;  ///< per new voxel

/// The voxels along one axis: where their middles and their faces lie, in steps of the axis.
struct Places {
  std::vector<double> middles, faces;
};

Places places_along(const ImageGrid& grid, int axis) {
  Places p;
  const std::uint32_t n = grid.size[static_cast<std::size_t>(axis)];
  for (std::uint32_t i = 0; i < n; ++i) p.middles.push_back(axis == 2 ? grid.slice(i) : i);
  // Half a voxel beyond the ends, as wide as the distance to the next one.
  const double first = n > 1 ? p.middles[1] - p.middles[0] : 1, last = n > 1 ? p.middles[n - 1] - p.middles[n - 2] : 1;
  p.faces.push_back(p.middles.front() - first / 2);
  for (std::uint32_t i = 1; i < n; ++i) p.faces.push_back((p.middles[i - 1] + p.middles[i]) / 2);
  p.faces.push_back(p.middles.back() + last / 2);
  return p;
}

/// By the parts of old voxels that lie in each new one.
Shares overlaps(const Places& old, std::uint32_t n) {
  const double begin = old.faces.front(), step = (old.faces.back() - begin) / n;
  Shares all(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const double lo = begin + i * step, hi = begin + (i + 1) * step;
    const auto first = std::upper_bound(old.faces.begin() + 1, old.faces.end() - 1, lo) - old.faces.begin() - 1;
    for (auto k = static_cast<std::size_t>(first);
         k + 1 < old.faces.size() && (old.faces[k] < hi || k == static_cast<std::size_t>(first)); ++k) {
      const double part = std::min(hi, old.faces[k + 1]) - std::max(lo, old.faces[k]);
      if (part > 0 || all[i].empty()) all[i].push_back({static_cast<std::uint32_t>(k), std::max(part, 0.0) / step});
    }
  }
  return all;
}

/// Linear between the middles of old voxels; beyond the first and last one as there.
Shares interpolated(const Places& old, std::uint32_t n) {
  const double begin = old.faces.front(), step = (old.faces.back() - begin) / n;
  const auto last = static_cast<std::uint32_t>(old.middles.size() - 1);
  Shares all(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const double at = begin + (i + 0.5) * step;
    const auto above = std::upper_bound(old.middles.begin(), old.middles.end(), at) - old.middles.begin();
    const auto b = std::min(static_cast<std::uint32_t>(above), last);
    const std::uint32_t a = above == 0 ? 0 : static_cast<std::uint32_t>(above) - 1;
    if (a == b) {
      all[i] = {{a, 1}};
      continue;
    }
    const double t = (at - old.middles[a]) / (old.middles[b] - old.middles[a]);
    all[i] = {{a, 1 - t}, {b, t}};
  }
  return all;
}

std::uint32_t voxels_along(const Places& old, double length_of_step, double spacing) {
  const double extent = (old.faces.back() - old.faces.front()) * length_of_step;
  const double n = std::max(1.0, std::round(extent / spacing));
  constexpr double kMost = 1 << 20;
  if (!(spacing > 0) || !(n <= kMost))
    throw OptionError(
        fmt::format("`resample` to voxels of {:.6g} makes no image: this one is {:.6g} wide", spacing, extent));
  return static_cast<std::uint32_t>(n);
}

/// The label that fills most of each new voxel; of equals the least.
template <class T>
std::vector<T> by_majority(const std::vector<T>& old, const Sizes& from, const Sizes& to,
                           const std::array<Shares, 3>& shares, const RunContext& context) {
  std::vector<T> out(std::size_t{to[0]} * to[1] * to[2]);
  parallel_for(to[2], [&](std::size_t k) {
    context.check();
    std::vector<std::pair<T, double>> parts;
    std::size_t at = k * to[0] * to[1];
    for (std::size_t j = 0; j < to[1]; ++j)
      for (std::size_t i = 0; i < to[0]; ++i, ++at) {
        parts.clear();
        for (const Share& c : shares[2][k])
          for (const Share& b : shares[1][j])
            for (const Share& a : shares[0][i]) {
              const T value = old[a.index + from[0] * (b.index + std::size_t{from[1]} * c.index)];
              const auto found =
                  std::find_if(parts.begin(), parts.end(), [&](const auto& p) { return p.first == value; });
              const double weight = a.weight * b.weight * c.weight;
              if (found == parts.end()) {
                parts.emplace_back(value, weight);
              } else {
                found->second += weight;
              }
            }
        out[at] = std::max_element(parts.begin(), parts.end(), [](const auto& a, const auto& b) {
                    return a.second < b.second || (a.second == b.second && a.first > b.first);
                  })->first;
      }
  });
  return out;
}

/// One axis after the other.
std::vector<float> by_mean(std::vector<float> values, Sizes size, const Sizes& to, const std::array<Shares, 3>& shares,
                           const RunContext& context) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Sizes next = size;
    next[axis] = to[axis];
    const std::size_t step = axis == 0 ? 1 : axis == 1 ? size[0] : std::size_t{size[0]} * size[1];
    std::vector<float> out(std::size_t{next[0]} * next[1] * next[2]);
    parallel_for(next[2], [&](std::size_t k) {
      context.check();
      std::size_t at = k * next[0] * next[1];
      for (std::size_t j = 0; j < next[1]; ++j)
        for (std::size_t i = 0; i < next[0]; ++i, ++at) {
          std::array<std::size_t, 3> p{i, j, k};
          const std::vector<Share>& parts = shares[axis][p[axis]];
          p[axis] = 0;
          const std::size_t base = p[0] + size[0] * (p[1] + std::size_t{size[1]} * p[2]);
          double sum = 0;
          for (const Share& part : parts) sum += part.weight * static_cast<double>(values[base + part.index * step]);
          out[at] = static_cast<float>(sum);
        }
    });
    values = std::move(out);
    size = next;
  }
  return values;
}

void check_inside(const VoxelBox& box, const Sizes& size) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (box.lo[axis] >= box.hi[axis] || box.hi[axis] > size[axis])
      throw OptionError(
          fmt::format("`crop` to the voxels {} to {} along axis {} is empty or reaches out of the image, "
                      "which has {}, counted from 0",
                      box.lo[axis], std::int64_t{box.hi[axis]} - 1, axis, size[axis]));
}

/// The names of values that an image had and another one of the same kind has no more.
void note_lost(const Image& before, Image& after) {
  const auto had = count_values(before), has = count_values(after);
  if (!had || !has) return;
  std::string lost;
  for (const ValueCount& c : *had)
    if (!std::any_of(has->begin(), has->end(), [&](const ValueCount& d) { return d.value == c.value; }))
      lost += fmt::format("{}{}", lost.empty() ? "" : ", ", c.value);
  if (!lost.empty())
    after.notes.push_back(fmt::format("resampling left no voxel of the labels {}; finer voxels would keep them", lost));
}

}  // namespace

Image cropped(const Image& image, const VoxelBox& box) {
  const ImageGrid& grid = image.grid;
  check_inside(box, grid.size);
  Image out = image;
  for (std::size_t axis = 0; axis < 3; ++axis) out.grid.size[axis] = box.hi[axis] - box.lo[axis];
  if (!grid.slices.empty()) {
    out.grid.slices.assign(grid.slices.begin() + box.lo[2], grid.slices.begin() + box.hi[2]);
    for (double& s : out.grid.slices) s -= grid.slices[box.lo[2]];
  }
  out.grid.origin = grid.to_world({double(box.lo[0]), double(box.lo[1]), grid.slice(box.lo[2])});
  out.values = std::visit(
      [&](const auto& values) -> Image::Values {
        std::decay_t<decltype(values)> part;
        part.reserve(out.grid.voxels());
        for (std::size_t k = box.lo[2]; k < box.hi[2]; ++k)
          for (std::size_t j = box.lo[1]; j < box.hi[1]; ++j) {
            const auto row = values.begin() + static_cast<std::ptrdiff_t>(grid.size[0] * (j + grid.size[1] * k));
            part.insert(part.end(), row + box.lo[0], row + box.hi[0]);
          }
        return part;
      },
      image.values);
  return out;
}

Image resampled(const Image& image, Vec3 spacing, bool labels, const RunContext& context) {
  const ThreadLimit limit(context.threads);
  const ImageGrid& grid = image.grid;
  Image out{grid, {}, image.notes, image.format, image.unit, image.frame, image.names};
  std::array<Shares, 3> shares;
  double voxels = 1;
  std::array<Places, 3> places;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    places[a] = places_along(grid, axis);
    out.grid.size[a] = voxels_along(places[a], length(grid.axes[a]), spacing[axis]);
    voxels *= out.grid.size[a];
  }
  constexpr double kMostVoxels = 0xfffffffe;
  if (voxels > kMostVoxels)
    throw OptionError(
        fmt::format("`resample` would make {:.4g} voxels, more than can be numbered; choose larger ones", voxels));
  Vec3 first;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const std::uint32_t n = out.grid.size[a];
    const double step = (places[a].faces.back() - places[a].faces.front()) / n;
    shares[a] = labels || n <= grid.size[a] ? overlaps(places[a], n) : interpolated(places[a], n);
    first[axis] = places[a].faces.front() + step / 2;
    out.grid.axes[a] = grid.axes[a] * step;
  }
  out.grid.origin = grid.to_world(first);
  out.grid.slices.clear();
  out.values = std::visit(
      [&]<class T>(const std::vector<T>& values) -> Image::Values {
        if (labels) return by_majority(values, grid.size, out.grid.size, shares, context);
        return by_mean({values.begin(), values.end()}, grid.size, out.grid.size, shares, context);
      },
      image.values);
  if (labels) note_lost(image, out);
  return out;
}

}  // namespace octafront
