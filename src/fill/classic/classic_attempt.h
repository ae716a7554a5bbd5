#pragma once

#include "fill/classic/classic_front.h"
#include "fill/front/front_task.h"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace octafront {

/// What a new tetrahedron of the classical front must keep to; lengths in units of the wanted size.
struct ClassicLimits {
  double search_radius;     ///< of the sphere of candidates around the ideal point
  double ideal_factor;      ///< shortens the distance of the ideal point
  double longest_edge;      ///< of edges that are new to the front
  double vertex_clearance;  ///< distance of a new vertex from those of the front
  double face_clearance;    ///< distance of a new vertex from the faces of the front
  double edge_clearance;    ///< distance of new edges from the edges of the front
  double least_angle;       ///< degrees between a new face and the front's face across an edge
  double least_quality;     ///< beta of the tetrahedron
  bool new_points;          ///< the ideal point may become a vertex
};

/// One for each attempt: a face that finds no tetrahedron waits until all others are done, then tries the next.
inline constexpr std::array<ClassicLimits, 5> kClassicLimits{{
    {0.7, 1.0, 1.5, 0.5, 0.3, 0.25, 20, 0.2, true},
    {1.0, 0.8, 1.6, 0.3, 0.15, 0.15, 10, 0.1, true},
    {1.3, 0.6, 2.0, 0.2, 0.1, 0.1, 5, 0.03, true},
    {2.0, 0.5, std::numeric_limits<double>::infinity(), 0.1, 0.02, 0.02, 1, 0.01, false},
    {3.0, 0.35, std::numeric_limits<double>::infinity(), 0, 0, 0, 0, 0, false},
}};

struct ClassicCounters {
  std::uint64_t attempts = 0, candidates = 0, found_faces = 0, too_flat = 0, too_near = 0, too_sharp = 0, including = 0,
                intersecting = 0, ideal_points = 0;
};

/// Tries to advance one face by the classical method: candidates by distance from the ideal point, then the ideal point
/// itself; each must pass the tests of volume, distance, angle, inclusion and intersection, the last two by exact
/// signs.
class ClassicAttempt {
 public:
  ClassicAttempt(ClassicFront& front, const FrontTask& task, ClassicCounters& counters)
      : front_(front), sizes_(task.sizes), options_(task.options), counters_(counters) {}

  /// Builds the first acceptable tetrahedron on `face` and updates the front; the faces that it adds go to `created`.
  bool advance(ClassicFront::Face face, const ClassicLimits& limits, std::vector<ClassicFront::Face>& created);

 private:
  struct NearFace {
    ClassicFront::Face face;
    Triangle id;
    std::array<Vec3, 3> at;
    Box3 box;
  };
  /// The tetrahedron that is tried.
  struct Trial {
    VertexIndex apex;  ///< kNone: a new vertex
    Vec3 at;
    std::array<ClassicFront::Face, 3> side{kNone, kNone, kNone};  ///< the front's face on side i, opposite corner i
    std::array<bool, 3> edge{};                                   ///< edge corner i - apex is on the front
    bool closes_all() const { return side[0] != kNone && side[1] != kNone && side[2] != kNone; }
  };

  void place(ClassicFront::Face face, const ClassicLimits& limits);
  bool accept(Trial& trial, const ClassicLimits& limits);
  void find_contact(Trial& trial) const;
  bool has_volume(const Trial& trial, const ClassicLimits& limits) const;
  bool keeps_distance(const Trial& trial, const ClassicLimits& limits) const;
  bool new_vertex_is_clear(Vec3 p, const ClassicLimits& limits) const;
  bool edges_are_clear(const Trial& trial, double clearance) const;
  bool keeps_angles(const Trial& trial, double least_degrees) const;
  bool includes_vertex(const Trial& trial) const;
  bool intersects(const Trial& trial) const;
  void commit(ClassicFront::Face face, const Trial& trial, std::vector<ClassicFront::Face>& created);

  ClassicFront& front_;
  const SizeField& sizes_;
  const VolumeOptions& options_;
  ClassicCounters& counters_;

  // Around the base face of the current attempt.
  ClassicFront::Face face_ = kNone;
  Triangle base_{};
  std::array<Vec3, 3> at_{};
  Vec3 ideal_;
  double size_ = 0;
  std::vector<NearFace> near_;
  std::vector<ClassicFront::Face> found_;
  std::vector<VertexIndex> vertices_;
};

}  // namespace octafront
