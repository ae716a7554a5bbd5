#pragma once

#include <octafront/run_context.h>

#include "base/core/raw_vector.h"
#include "sizing/field/background_grid.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// What the sampling asks at a place of a triangle; at least one must answer. Input units.
struct PlaceOnSurface {
  Vec3 p, n;  ///< n: unit normal
  std::uint32_t face;
};

/// Sizes from far away, such as another language, that are asked for in batches: a place that is not known yet is
/// noted, and asked for with all the others that were met. Answers are kept.
class BatchedSizes {
 public:
  using Ask = std::function<void(std::span<const Vec3> points, std::span<double> sizes)>;
  explicit BatchedSizes(Ask ask) : ask_(std::move(ask)) {}

  /// Infinity if it is not known yet.
  double at(Vec3 p);
  /// Asks for what was missing; false if nothing was. Throws OptionError for sizes that are not above 0.
  bool fetch();

 private:
  struct Hash {
    std::size_t operator()(const Vec3& p) const;
  };
  Ask ask_;
  std::vector<Vec3> missing_;
  std::unordered_map<Vec3, double, Hash> known_;
};

/// The size that is wanted at a place of a surface.
struct SizeAtPlace {
  std::function<double(const PlaceOnSurface&)> at = {};  ///< may be empty
  std::shared_ptr<BatchedSizes> batched = {};            ///< after it has fetched, `at` answers better; may be null

  /// Places are no farther apart than this, so that none is missed where sizes are small amid large ones.
  double spacing = std::numeric_limits<double>::infinity();

  explicit operator bool() const { return static_cast<bool>(at); }
  double operator()(const PlaceOnSurface& place) const { return at(place); }
};

/// The smaller of two; where one is empty the other.
SizeAtPlace least_of(const SizeAtPlace& a, const SizeAtPlace& b);

/// Samples of a surface, dense enough for its sizes: triangles longer than the size at their centroid, or than
/// `size_at.spacing`, are halved along their longest edge until they are not. `face_size` bounds the size on each
/// triangle; `size_at`, which may be empty, may ask for less at a place. Of surfaces with very many samples on long and
/// narrow triangles, one stands for a longer part of these. Throws OptionError if more than 50 million
/// samples were needed.
RawVector<SizeSample> sample_surface(const SurfaceMesh& surface, const std::vector<double>& face_size,
                                     const SizeAtPlace& size_at, const RunContext& context);

}  // namespace octafront
