#pragma once

#include <octafront/tet_mesh.h>

#include <cstdint>
#include <string>
#include <vector>

namespace octafront::adapt {

/// The regions of two meshes by common numbers.
class MatchedRegions {
 public:
  /// By name where all regions of both have one, else by number; unless each has its partner so, each mesh is one body,
  /// and `note` says so.
  MatchedRegions(const TetMesh& before, const TetMesh& now);

  std::uint32_t count() const { return count_; }
  std::uint32_t of_old(TetIndex t) const { return number(before_, old_, t); }
  std::uint32_t of_new(TetIndex t) const { return number(now_, new_, t); }
  bool is_matched = true;
  std::string note;

 private:
  static std::uint32_t number(const TetMesh& mesh, const std::vector<std::uint32_t>& common, TetIndex t) {
    return mesh.region.empty() ? common.front() : common[mesh.region[t]];
  }

  const TetMesh &before_, &now_;
  std::uint32_t count_ = 1;
  std::vector<std::uint32_t> old_, new_;  ///< by number in the mesh
};

}  // namespace octafront::adapt
