#pragma once

#include "fill/front/front_limits.h"
#include "fill/front/front_task.h"
#include "fill/front/neighborhood.h"

#include <optional>
#include <vector>

namespace octafront {

/// Tries to advance one face: ideal point, candidates in order, validity, levers. Keeps its scratch between calls.
class Attempt {
 public:
  enum class Outcome {
    kAdvanced,
    kStuck,  ///< no acceptable tetrahedron within the limits: nothing has changed
    kBeyond  ///< what it may reach is not strictly inside the territory: not tried
  };

  /// No tetrahedron will touch the border of `territory` or what lies beyond it.
  Attempt(Front& front, const FrontTask& task, const Box3& territory, FrontCounters& counters);

  /// Builds the first acceptable tetrahedron on `face` and updates the front; the faces that it adds go to `created`.
  Outcome advance(FaceIndex face, const Limits& limits, std::vector<QueuedFace>& created);

  /// Candidates times the faces around them, over all calls: what an advance costs.
  std::uint64_t face_tests() const { return face_tests_; }

 private:
  using Index = Neighborhood::Index;
  struct Candidate {
    Index index;
    double rank;
    double quality;
  };
  /// How the front already touches the tetrahedron on the base face with a given apex.
  struct Contact {
    std::array<FaceIndex, 3> face{kNone, kNone, kNone};  // front face that side i (opposite corner i) closes
    std::array<bool, 3> edge{};                          // edge corner i - apex is on the front
    int closed = 0;
  };

  SearchRegion region_to_search(double radius) const;
  /// False if the face may reach beyond the territory.
  bool place(FaceIndex face, const Limits& limits);
  void collect_candidates(const Limits& limits);
  /// What it touches, if it makes an acceptable tetrahedron.
  std::optional<Contact> try_candidate(const Candidate& candidate, const Limits& limits);
  bool try_ideal_point(const Limits& limits);
  Contact contact_of(Index apex) const;
  bool edges_short_enough(Vec3 apex, const Contact& contact, double longest) const;
  bool is_back_of_wall(const std::array<Index, 3>& corners, Index apex) const;
  bool is_valid(Index apex, Vec3 apex_at, VertexIndex apex_id);
  bool blocks(const Neighborhood::LocalFace& face, Index apex, Vec3 apex_at, VertexIndex apex_id);
  bool keeps_clear(Index apex, Vec3 apex_local, const Contact& contact, const Limits& limits) const;
  bool clear_of_faces(Vec3 apex_local, float least) const;
  void commit(FaceIndex face, VertexIndex apex, const Contact& contact, std::vector<QueuedFace>& created);

  Front& front_;
  const SizeField& sizes_;
  const VolumeOptions& options_;
  const Box3 territory_;
  FrontCounters& counters_;
  const bool sizes_vary_;
  Neighborhood near_;
  std::uint64_t face_tests_ = 0;
  std::vector<Candidate> candidates_;

  // The base face of the current attempt.
  Triangle base_{};
  std::array<Vec3, 3> at_{};
  Vec3 normal_;  // unit, local
  Vec3 ideal_;   // local
  Vec3 ideal_at_;
  double ideal_distance_ = 0;  // local
  std::size_t blocker_ = 0;    // face that the last candidate met
};

}  // namespace octafront
