#pragma once

#include <octafront/options.h>
#include <octafront/size_field.h>
#include <octafront/vec.h>

#include "base/core/stage.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace octafront {

/// By what a front advances; all of it outlives the advance.
struct FrontTask {
  const SizeField& sizes;
  const VolumeOptions& options;
  const Stage& stage;
  Ranks* ranks = nullptr;  ///< that share its blocks; null: none
};

/// A volume as a whole number of 2^-50 of that of a box: a sum of such depends on no order.
inline std::int64_t volume_part(double volume, const Box3& box) {
  const Vec3 e = box.extent();
  const double whole = e.x * e.y * e.z;
  return whole > 0 ? static_cast<std::int64_t>(std::min(volume / whole, 2.0) * 0x1p50) : 0;
}

/// What a front has done: it decides when a run stops, and is counted in work, not in time, so that the result never
/// depends on the machine.
struct FrontWork {
  std::size_t tets = 0;          ///< made
  std::int64_t volume = 0;       ///< filled, as volume_part() of the front's domain
  std::uint64_t face_tests = 0;  ///< candidates times the faces around them

  FrontWork& operator+=(const FrontWork& more) {
    tets += more.tets;
    volume += more.volume;
    face_tests += more.face_tests;
    return *this;
  }
};

inline constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max();

/// Where a run stops, whatever remains.
struct AdvanceBudget {
  std::size_t tets = 0;
  std::int64_t volume = kNoLimit;  ///< more means that the front leaks
  std::uint64_t face_tests = std::numeric_limits<std::uint64_t>::max();

  bool exceeded_by(const FrontWork& work) const {
    return work.tets > tets || work.volume > volume || work.face_tests > face_tests;
  }
  /// What is left after work that has not exceeded it.
  AdvanceBudget after(const FrontWork& work) const {
    return {tets - work.tets, volume == kNoLimit ? kNoLimit : volume - work.volume, face_tests - work.face_tests};
  }
};

/// Statistics for reports. They depend on input and options alone, and nothing depends on them.
struct FrontCounters {
  std::uint64_t attempts = 0, candidates = 0, exact_tests = 0, ideal_points = 0, retries = 0, faces_found = 0,
                deferred = 0;

  FrontCounters& operator+=(const FrontCounters& more) {
    attempts += more.attempts;
    candidates += more.candidates;
    exact_tests += more.exact_tests;
    ideal_points += more.ideal_points;
    retries += more.retries;
    faces_found += more.faces_found;
    deferred += more.deferred;
    return *this;
  }
};

}  // namespace octafront
