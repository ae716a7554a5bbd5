#include "sizing/sources/surface_samples.h"

#include <octafront/error.h>
#include <octafront/surface_mesh.h>

#include "base/core/parallel_arrays.h"
#include "base/geometry/measures.h"
#include "base/geometry/needle.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>

#include <fmt/core.h>

namespace octafront {

namespace {

constexpr std::size_t kMostSamples = 50'000'000;
/// A triangle lies within this part of its longest edge about its centroid.
constexpr double kReachOfEdge = 0.6;
/// Triangles that are sampled together, by one thread or for one batch of sizes.
constexpr std::size_t kFacesAtOnce = 4096;
/// Few triangles are large ones, with many samples each: they are divided among threads too.
constexpr std::size_t kLeastRanges = 256;

/// Strips are sampled at longer steps where all samples, as far as the sizes of faces foretell them, would be more.
constexpr double kManySamples = 1e5;
constexpr double kLongestStep = 64;

/// How many times as long as its size may be what one sample stands for, if it is as many times narrower.
double step_on_strips(const SurfaceMesh& surface, const std::vector<double>& face_size, double spacing) {
  const double count = sum_in_order(face_size.size(), [&](std::size_t f) {
    const auto [i, j, k] = surface.triangles[f];
    const Vec3 a = surface.points[i], b = surface.points[j], c = surface.points[k];
    const double longest =
        std::sqrt(std::max({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)}));
    return longest / std::min(face_size[f], spacing);
  });
  return std::clamp(count / kManySamples, 1.0, kLongestStep);
}

template <class Samples>
class Sampler {
 public:
  Sampler(const std::vector<double>& face_size, const SizeAtPlace& size_at, double step, Samples& samples)
      : face_size_(face_size), size_at_(size_at), step_(step), samples_(samples) {}

  void sample(Vec3 a, Vec3 b, Vec3 c, Vec3 n, std::uint32_t face) {
    const Vec3 p = centroid(a, b, c);
    const double h = size_at(p, n, face), most = std::min(h, size_at_.spacing);
    const double ab = squared_distance(a, b), bc = squared_distance(b, c), ca = squared_distance(c, a);
    const double longest = std::max({ab, bc, ca}), area = triangle_area(a, b, c);
    if (longest <= most * most || is_short_strip(longest, area, most)) {
      add({p, n, h, kReachOfEdge * std::sqrt(longest), area});
    } else if (const Needle needle({a, b, c}); needle.is_one() && needle.height() <= most) {
      sample_along(needle, 0, 1, n, face);
    } else if (longest == ab) {
      halve(c, a, b, n, face);
    } else if (longest == bc) {
      halve(a, b, c, n, face);
    } else {
      halve(b, c, a, n, face);
    }
  }

 private:
  double size_at(Vec3 p, Vec3 n, std::uint32_t face) const {
    return size_at_ ? std::min(face_size_[face], size_at_({p, n, face})) : face_size_[face];
  }

  void add(const SizeSample& s) {
    if (samples_.size() == kMostSamples) {
      throw OptionError(fmt::format(
          "sizes as small as {:.4g} near ({:.6g}, {:.6g}, {:.6g}) are too small for this surface: its "
          "background grid alone would need more than {} samples; ask for larger sizes or give a `min_size`",
          s.h, s.p.x, s.p.y, s.p.z, kMostSamples));
    }
    samples_.push_back(s);
  }

  void sample_along(const Needle& needle, double t0, double t1, Vec3 n, std::uint32_t face) {
    const double middle = 0.5 * (t0 + t1), length = (t1 - t0) * needle.length();
    const Vec3 p = needle.middle(middle);
    const double h = size_at(p, n, face);
    const double most = std::min(h, size_at_.spacing);
    if (length <= most || (length <= step_ * most && step_ * needle.height() <= most))
      return add({p, n, h, kReachOfEdge * length, needle.area(t0, t1)});
    if (middle == t0 || middle == t1) refuse_steps(p);
    sample_along(needle, t0, middle, n, face);
    sample_along(needle, middle, t1, n, face);
  }

  [[noreturn]] static void refuse_steps(Vec3 p) {
    throw OptionError(fmt::format(
        "sizes near ({:.6g}, {:.6g}, {:.6g}) are smaller than the steps between doubles there; ask for larger "
        "sizes, or move the model to the origin",
        p.x, p.y, p.z));
  }

  bool is_short_strip(double squared_length, double area, double size) const {
    return step_ > 1 && squared_length <= step_ * step_ * size * size &&
           2 * step_ * area <= size * std::sqrt(squared_length);
  }

  void halve(Vec3 apex, Vec3 from, Vec3 to, Vec3 n, std::uint32_t face) {
    const Vec3 middle = 0.5 * (from + to);
    if (middle == from || middle == to) refuse_steps(middle);
    sample(apex, from, middle, n, face);
    sample(apex, middle, to, n, face);
  }

  const std::vector<double>& face_size_;
  const SizeAtPlace& size_at_;
  double step_;
  Samples& samples_;
};

}  // namespace

std::size_t BatchedSizes::Hash::operator()(const Vec3& p) const {
  std::uint64_t hash = 0;
  for (int axis = 0; axis < 3; ++axis)
    hash = (hash ^ std::bit_cast<std::uint64_t>(p[axis])) * 0x9e3779b97f4a7c15u, hash ^= hash >> 32;
  return static_cast<std::size_t>(hash);
}

double BatchedSizes::at(Vec3 p) {
  const Vec3 positive_zeros = p + Vec3{};
  const auto [it, is_new] = known_.try_emplace(positive_zeros, std::numeric_limits<double>::infinity());
  if (is_new) missing_.push_back(positive_zeros);
  return it->second;
}

bool BatchedSizes::fetch() {
  if (missing_.empty()) return false;
  std::vector<double> sizes(missing_.size());
  ask_(missing_, sizes);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const Vec3 p = missing_[i];
    if (!(sizes[i] > 0)) {
      throw OptionError(fmt::format("the size callback returned {} at ({:.6g}, {:.6g}, {:.6g}): sizes must be above 0",
                                    sizes[i], p.x, p.y, p.z));
    }
    known_[p] = sizes[i];
  }
  missing_.clear();
  return true;
}

namespace {

/// The samples of some triangles, behind those that there are.
template <class Samples>
void sample_faces(const SurfaceMesh& surface, Sampler<Samples> sampler, std::size_t begin, std::size_t end) {
  for (std::size_t f = begin; f < end; ++f) {
    const Triangle& t = surface.triangles[f];
    const Vec3 a = surface.points[t[0]], b = surface.points[t[1]], c = surface.points[t[2]];
    sampler.sample(a, b, c, unit_normal(a, b, c), static_cast<std::uint32_t>(f));
  }
}

// Each round knows the sizes of one more level of halves.
RawVector<SizeSample> sample_in_batches(const SurfaceMesh& surface, const std::vector<double>& face_size,
                                        const SizeAtPlace& size_at, double step, const RunContext& context) {
  RawVector<SizeSample> samples;
  for (std::size_t begin = 0; begin < surface.triangles.size(); begin += kFacesAtOnce) {
    const std::size_t finished = samples.size(), end = std::min(surface.triangles.size(), begin + kFacesAtOnce);
    do {
      context.check();
      samples.erase(samples.begin() + static_cast<std::ptrdiff_t>(finished), samples.end());
      sample_faces(surface, Sampler(face_size, size_at, step, samples), begin, end);
    } while (size_at.batched->fetch());
  }
  return samples;
}

}  // namespace

SizeAtPlace least_of(const SizeAtPlace& a, const SizeAtPlace& b) {
  if (!a || !b) return a ? a : b;
  return {[a = a.at, b = b.at](const PlaceOnSurface& s) { return std::min(a(s), b(s)); },
          a.batched ? a.batched : b.batched, std::min(a.spacing, b.spacing)};
}

RawVector<SizeSample> sample_surface(const SurfaceMesh& surface, const std::vector<double>& face_size,
                                     const SizeAtPlace& size_at, const RunContext& context) {
  const double step = step_on_strips(surface, face_size, size_at.spacing);
  if (size_at.batched) return sample_in_batches(surface, face_size, size_at, step, context);
  std::atomic<std::size_t> total{0};
  const std::size_t range = std::clamp<std::size_t>(surface.triangles.size() / kLeastRanges, 1, kFacesAtOnce);
  auto samples = parallel_collect<SizeSample, RawVector<SizeSample>>(
      surface.triangles.size(), range, [&](std::size_t begin, std::size_t end, std::vector<SizeSample>& part) {
        context.check();
        if (total > kMostSamples) return;
        sample_faces(surface, Sampler(face_size, size_at, step, part), begin, end);
        total += part.size();
      });
  if (total <= kMostSamples) return samples;
  // One after the other, so that the place named is the same on any number of threads.
  samples = {};
  sample_faces(surface, Sampler(face_size, size_at, step, samples), 0, surface.triangles.size());
  return samples;
}

}  // namespace octafront
