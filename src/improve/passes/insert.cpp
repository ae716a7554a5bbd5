// A new vertex in the place of a bad element: a cavity grows from the element, face by face, and is filled by the star
// of one point, put where the worst score of that star is greatest. The growth absorbs the neighbour behind the face
// whose new element is worst. (In the spirit of the insertion of Klingner & Shewchuk, "Aggressive tetrahedral mesh
// improvement", 2007.) Vertices that end up inside the cavity go: the same step removes vertices that are in the way.

#include "improve/passes/fewest_poor.h"
#include "improve/passes/passes.h"
#include "improve/passes/poor_tets.h"
#include "improve/shape/maximize_worst.h"

#include <algorithm>

namespace octafront::improve {
namespace {

constexpr int kLargestCavity = 48;           ///< tets
constexpr int kClimbSteps = 4;               ///< per growth step
constexpr int kLastSteps = 12;               ///< for the best cavity
constexpr float kLeastGainOfVertex = 0.02f;  ///< more elements must be worth it
constexpr float kLeastRelief = 0.3f;         ///< the same for what they lack
constexpr int kPatience = 10;                ///< growth steps without a better star before giving up
/// After so many elements in a row that could not be bettered the rest of a block is left: in walls thinner than their
/// elements all are poor, and none has room for a vertex. Elsewhere some tens in a row are the most.
constexpr int kHopeless = 256;

class Inserter {
 public:
  Inserter(EditMesh& mesh, Goal goal)
      : editor_(mesh), mesh_(mesh), floor_(mesh.floor()), goal_(goal), star_(mesh.objective()) {}

  /// Worst first.
  PassResult run(float threshold, const RunContext& context) {
    PassResult result;
    std::vector<TetIndex> bad = tets_below(mesh_, threshold);
    std::ranges::stable_sort(bad, {}, [&](TetIndex t) { return mesh_.shape(t).score; });
    int in_vain = 0;
    for (const TetIndex t : bad) {
      context.check();
      if (in_vain == kHopeless) break;
      if (!mesh_.alive(t) || mesh_.shape(t).score >= threshold) continue;
      ++result.tried;
      const bool done = improve(t);
      result.done += done;
      in_vain = done ? 0 : in_vain + 1;
    }
    return result;
  }

 private:
  /// True if tet t was replaced by something better.
  bool improve(TetIndex t) {
    find_best_cavity(t);
    if (best_size_ == 0) return false;
    tets_.resize(best_size_);
    load_star();
    const Vec3 p = climb(best_place_, kLastSteps);
    if (gain() <= (goal_ == Goal::kWorst ? kLeastGainOfVertex : kLeastRelief) || !star_.star_acceptable(p, floor_))
      return false;
    corners_.clear();
    for (const HalfFace h : faces_) corners_.push_back(face_of(mesh_.tet(h / 4), static_cast<int>(h % 4)));
    return editor_.replace_by_star(tets_, corners_, star_, p);
  }

  bool in_cavity(TetIndex t) const { return std::find(tets_.begin(), tets_.end(), t) != tets_.end(); }

  /// The best place near `start` for the apex of the star; the star is left as evaluated there.
  Vec3 climb(Vec3 start, int steps) {
    const auto anywhere = [](Vec3) { return true; };
    if (goal_ == Goal::kWorst) {
      maximizer_.climb(star_, start, steps, anywhere);
      start = maximizer_.place();
    } else {
      descent_.descend(star_, start, steps, anywhere);
      start = descent_.place();
    }
    star_.evaluate_star(start);
    return start;
  }

  /// What the star as evaluated is better by than the cavity that it fills.
  float gain() const {
    float worst = 1;
    double lack = 0;
    for (const TetIndex t : tets_) {
      worst = std::min(worst, mesh_.shape(t).score);
      lack += lack_of(mesh_.shape(t).score);
    }
    return goal_ == Goal::kWorst ? static_cast<float>(star_.worst()) - worst
                                 : static_cast<float>(lack - lack_of(star_));
  }

  /// Grows the cavity and notes how far it was when its star was best compared with what it replaces.
  void find_best_cavity(TetIndex t) {
    tets_.assign(1, t);
    best_size_ = 0;
    const Tet& c = mesh_.tet(t);
    Vec3 p = (mesh_.point(c[0]) + mesh_.point(c[1]) + mesh_.point(c[2]) + mesh_.point(c[3])) * 0.25;
    float best_gain = 0;
    for (int since_best = 0; since_best < kPatience && tets_.size() <= kLargestCavity; ++since_best) {
      load_star();
      if (faces_.size() > ShapeBatch::kBatch) return;
      p = climb(p, kClimbSteps);
      if (const float gained = gain(); gained > best_gain) {
        best_gain = gained;
        best_size_ = tets_.size();
        best_place_ = p;
        since_best = 0;
      }
      if (!absorb_behind_worst_face()) return;
    }
  }

  /// The outer faces of the cavity, seen from inside, as a star about a point to be chosen.
  void load_star() {
    faces_.clear();
    star_.size = 0;
    for (const TetIndex t : tets_)
      for (int i = 0; i < 4; ++i) {
        const HalfFace o = mesh_.across(4 * t + i);
        if (!is_outside(o) && in_cavity(o / 4)) continue;
        faces_.push_back(4 * t + i);
        if (faces_.size() > ShapeBatch::kBatch) return;
        const Triangle f = face_of(mesh_.tet(t), i);
        star_.add(mesh_.point(f[0]), mesh_.point(f[1]), mesh_.point(f[2]));
      }
  }

  bool absorb_behind_worst_face() {
    int worst = -1;
    for (int i = 0; i < star_.size; ++i)
      if (!is_outside(mesh_.across(faces_[i])) && (worst < 0 || star_.quality[i] < star_.quality[worst])) worst = i;
    const TetIndex behind = worst < 0 ? kNone : editor_.behind(faces_[worst]);
    if (behind != kNone) tets_.push_back(behind);
    return behind != kNone;
  }

  MeshEditor editor_;
  EditMesh& mesh_;
  Floor floor_;
  Goal goal_;
  std::vector<TetIndex> tets_;   ///< the cavity, in order of growth
  std::vector<HalfFace> faces_;  ///< its outer faces, as seen from the tets inside
  std::size_t best_size_ = 0;
  Vec3 best_place_;
  ShapeBatch star_;
  WorstMaximizer maximizer_;
  LackDescent descent_;
  std::vector<Triangle> corners_;
};

}  // namespace

PassResult insert_vertices(EditMesh& mesh, float threshold, Goal goal, const RunContext& context) {
  return Inserter(mesh, goal).run(threshold, context);
}

}  // namespace octafront::improve
