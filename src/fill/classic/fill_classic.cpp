#include "fill/classic/fill_classic.h"

#include <octafront/error.h>

#include "base/core/stage_timer.h"
#include "base/core/validate.h"
#include "fill/classic/classic_attempt.h"
#include "fill/classic/classic_front.h"
#include "fill/classic/surface_sizes.h"
#include "fill/front/bind_to_surface.h"
#include "fill/front/ladder.h"

#include <algorithm>
#include <queue>
#include <utility>

namespace octafront {

namespace {

using Face = ClassicFront::Face;

/// The front fills no more than the surface encloses, up to rounding: more means that it leaks.
constexpr double kClassicVolumeSlack = 1.0001;
constexpr int kMostClassicRounds = 8;

/// The smallest face advances first; among equal ones the oldest.
class Advance {
 public:
  Advance(ClassicFront& front, const FrontTask& task, double volume, ClassicCounters& counters)
      : front_(front), volume_(volume), stage_(task.stage), attempt_(front, task, counters) {}

  /// The faces that found no tetrahedron at any level.
  std::vector<Face> run() {
    validate(front_);
    for (Face f = 0; f < front_.face_count(); ++f) queue_.emplace(front_.size_of(f), f);
    work_off(0);
    // Each round lets the faces that wait try all levels; a success may have made room for others.
    for (int round = 0; round < kMostClassicRounds; ++round) {
      const std::size_t before = front_.tets().size();
      for (std::size_t level = 1; level < kClassicLimits.size(); ++level) {
        for (const Face f : std::exchange(held_, {}))
          if (front_.alive(f)) queue_.emplace(front_.size_of(f), f);
        work_off(level);
      }
      if (front_.tets().size() == before) break;
    }
    std::erase_if(held_, [&](Face f) { return !front_.alive(f); });
    return std::move(held_);
  }

 private:
  /// Faces made on the way begin with the strictest limits: they wait for the next turn if these are too strict.
  void work_off(std::size_t level) {
    const auto first_new = static_cast<Face>(front_.face_count());
    std::vector<Face> created;
    while (!queue_.empty()) {
      const Face face = queue_.top().second;
      queue_.pop();
      if (!front_.alive(face)) continue;
      if (++steps_ % 256 == 0) check();
      created.clear();
      if (!attempt_.advance(face, kClassicLimits[face < first_new ? level : 0], created)) held_.push_back(face);
      for (const Face f : created) queue_.emplace(front_.size_of(f), f);
    }
    validate(front_);
  }

  void check() {
    stage_.check();
    if (steps_ % 8192 == 0) stage_.progress(front_.filled_volume() / volume_);
    if (front_.filled_volume() > kClassicVolumeSlack * volume_)
      throw MeshingError(
          "the front has filled more than the surface encloses; check the surface for self-intersections, "
          "or choose a larger element size");
  }

  using Entry = std::pair<double, Face>;
  ClassicFront& front_;
  double volume_;
  const Stage& stage_;
  ClassicAttempt attempt_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::vector<Face> held_;
  std::uint64_t steps_ = 0;
};

void report_classic_front(const Stage& stage, const ClassicCounters& c, std::size_t tets, std::size_t left) {
  stage.count("front tetrahedra", static_cast<double>(tets));
  stage.count("attempts", static_cast<double>(c.attempts));
  stage.count("faces found", static_cast<double>(c.found_faces));
  stage.count("candidates tried", static_cast<double>(c.candidates));
  stage.count("refused: volume", static_cast<double>(c.too_flat));
  stage.count("refused: distance", static_cast<double>(c.too_near));
  stage.count("refused: angle", static_cast<double>(c.too_sharp));
  stage.count("refused: inclusion", static_cast<double>(c.including));
  stage.count("refused: intersection", static_cast<double>(c.intersecting));
  stage.count("ideal points", static_cast<double>(c.ideal_points));
  stage.count("faces left", static_cast<double>(left));
}

}  // namespace

TetMesh fill_volume_classic(const SurfaceMesh& surface, const VolumeOptions& options, const Stage& stage) {
  if (surface.triangles.empty()) throw InputError("the surface has no triangles: nothing to fill");
  const SizeField sizes = sizes_from_surface(surface);
  const FrontTask task{sizes, options, stage};
  TetMesh mesh;
  std::vector<Wall> walls;
  {
    ClassicFront front(bounding_box(surface.points));
    for (const Vec3 p : surface.points) front.add_vertex(p);
    for (const auto& [a, b, c] : surface.triangles) front.add_face({a, c, b});
    ClassicCounters counters;
    const double start = process_cpu_seconds();
    const std::vector<Face> left = Advance(front, task, enclosed_volume(surface), counters).run();
    stage.count("advance CPU seconds", process_cpu_seconds() - start);
    report_classic_front(stage, counters, front.tets().size(), left.size());
    for (const Face f : left) walls.push_back(front.corners(f));
    mesh.points = front.points();
    mesh.tets = front.tets();
  }
  close_cavities(mesh, walls, surface, task);
  bind_to_surface(mesh, surface);
  return mesh;
}

}  // namespace octafront
