#pragma once

#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include "base/core/raw_vector.h"
#include "fill/front/front.h"
#include "fill/front/front_task.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace octafront {

/// A face of the front that waits for its turn, oriented like those of Front.
struct WaitingFace {
  FrontFace face;
  std::uint8_t level = 0;  ///< of kLimits: how strict its next attempt is
  bool deferred = false;   ///< its last turn came to nothing because it reached beyond its block
};

/// Tetrahedra that are done with. Those of a block stay with the rank that made them, until the front is done.
struct FilledPiece {
  static constexpr int kEveryRank = -1;
  std::vector<Tet> tets;  ///< empty on ranks that do not have it
  int rank = kEveryRank;  ///< that has it

  friend bool operator==(const FilledPiece&, const FilledPiece&) = default;
};

/// The whole front between two phases, and what has been made so far: plain lists, in an order that is part of the
/// result. What the next phase does depends on nothing else. While a phase runs, each block has a Front of its own.
struct FrontState {
  Box3 domain;                ///< all faces lie in it
  double finest_size = 1;     ///< > 0
  std::uint32_t regions = 1;  ///< those of faces are below it, or kNone
  std::vector<Vec3> points;
  RawVector<float> sizes;           ///< wanted edge length, per point
  RawVector<WaitingFace> queue;     ///< will try next (the paper's Qc and Qn)
  RawVector<FrontFace> held;        ///< found no tetrahedron at the level of the last try (Qh)
  RawVector<FrontFace> passive;     ///< only met by others so far
  std::vector<FilledPiece> filled;  ///< tetrahedra in order
  FrontWork work;                   ///< of all pieces together
  std::size_t phases = 0;           ///< that it has gone through

  std::size_t faces() const { return queue.size() + held.size() + passive.size(); }
  /// Face i of all: those of the queue come first, then the held ones, then the passive ones.
  const FrontFace& face(std::size_t i) const {
    if (i < queue.size()) return queue[i].face;
    i -= queue.size();
    return i < held.size() ? held[i] : passive[i - held.size()];
  }

  /// All faces together are closed and oriented alike, and the lists agree.
  std::optional<std::string> first_inconsistency() const;
};

}  // namespace octafront
