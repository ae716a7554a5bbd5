#include "sizing/surface_samples.h"

#include <octafront/error.h>

#include "geometry/measures.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront {

namespace {

constexpr std::size_t kMostSamples = 50'000'000;
/// A triangle lies within this part of its longest edge about its centroid.
constexpr double kReachOfEdge = 0.6;

class Sampler {
 public:
  Sampler(const std::vector<double>& face_size, const SizeAtPlace& size_at, std::vector<SizeSample>& samples)
      : face_size_(face_size), size_at_(size_at), samples_(samples) {}

  void sample(Vec3 a, Vec3 b, Vec3 c, Vec3 n, std::uint32_t face) {
    const Vec3 p = centroid(a, b, c);
    double h = face_size_[face];
    if (size_at_) h = std::min(h, size_at_({p, n, face}));
    const double ab = squared_distance(a, b), bc = squared_distance(b, c), ca = squared_distance(c, a);
    const double longest = std::max({ab, bc, ca});
    if (longest <= h * h) {
      if (samples_.size() == kMostSamples) {
        throw OptionError(fmt::format(
            "sizes as small as {:.4g} near ({:.6g}, {:.6g}, {:.6g}) are too small for this surface: its "
            "background grid alone would need more than {} samples; ask for larger sizes or give a `min_size`",
            h, p.x, p.y, p.z, kMostSamples));
      }
      samples_.push_back({p, n, h, kReachOfEdge * std::sqrt(longest), triangle_area(a, b, c)});
    } else if (longest == ab) {
      halve(c, a, b, n, face);
    } else if (longest == bc) {
      halve(a, b, c, n, face);
    } else {
      halve(b, c, a, n, face);
    }
  }

 private:
  void halve(Vec3 apex, Vec3 from, Vec3 to, Vec3 n, std::uint32_t face) {
    const Vec3 middle = 0.5 * (from + to);
    if (middle == from || middle == to)
      throw OptionError(fmt::format(
          "sizes near ({:.6g}, {:.6g}, {:.6g}) are smaller than the steps between doubles there; ask for larger "
          "sizes, or move the model to the origin",
          middle.x, middle.y, middle.z));
    sample(apex, from, middle, n, face);
    sample(apex, middle, to, n, face);
  }

  const std::vector<double>& face_size_;
  const SizeAtPlace& size_at_;
  std::vector<SizeSample>& samples_;
};

}  // namespace

std::vector<SizeSample> sample_surface(const SurfaceMesh& surface, const std::vector<double>& face_size,
                                       const SizeAtPlace& size_at, const RunContext& context) {
  std::vector<SizeSample> samples;
  samples.reserve(surface.triangles.size());
  Sampler sampler(face_size, size_at, samples);
  for (std::uint32_t f = 0; f < surface.triangles.size(); ++f) {
    if (f % 1024 == 0) context.check();
    const Triangle& t = surface.triangles[f];
    const Vec3 a = surface.points[t[0]], b = surface.points[t[1]], c = surface.points[t[2]];
    sampler.sample(a, b, c, unit_normal(a, b, c), f);
  }
  return samples;
}

}  // namespace octafront
