#include "fill/recovery/refine.h"

#include "base/core/validate.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/mesh/tet_complex.h"

#include <algorithm>
#include <deque>

namespace octafront {

namespace {

// All times the size: the largest sphere that stays (a regular element has .61), the nearest that a new point may come
// to a vertex, and to a boundary face. A closer spacing makes more elements and no better ones.
constexpr double kLargestSphere = 0.75, kSpacing = 0.7, kClearance = 0.3;
// Moves of a refused centre towards its element.
constexpr int kMoves = 4;
// A cavity larger than this, or a walk longer, comes of a mesh that is far from Delaunay: not worth it.
constexpr std::size_t kMaxCavityOfPoint = 300;
constexpr int kMaxWalk = 1000;

struct Sphere {
  Vec3 center;
  double squared_radius = 0;
};

Sphere circumscribed(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a, vw = cross(v, w);
  const Vec3 offset =
      (squared_length(u) * vw + squared_length(v) * cross(w, u) + squared_length(w) * cross(u, v)) / (2 * dot(u, vw));
  return {a + offset, squared_length(offset)};
}

class Refiner {
 public:
  Refiner(TetMesh& mesh, const SizeField& sizes, const RunContext& context)
      : mesh_(mesh), sizes_(sizes), context_(context) {
    complex_.tets = mesh.tets;
    complex_.connect(mesh.points.size(), mesh.boundary);
    complex_.part(mesh.points.size(), mesh.interfaces, kFirstOutside);
  }

  void run() {
    for (TetIndex t = 0; t < complex_.slots(); ++t) queue_.push_back({t, complex_.tets[t]});
    for (std::uint64_t worked = 0; !queue_.empty(); ++worked) {
      if (worked % 256 == 0) context_.check();
      const auto [t, corners] = queue_.front();
      queue_.pop_front();
      if (complex_.tets[t] == corners) left_ += !is_small_or_divided(t);
    }
    validate(complex_);
    mesh_.tets.clear();
    for (TetIndex t = 0; t < complex_.slots(); ++t) {
      if (complex_.alive(t)) mesh_.tets.push_back(complex_.tets[t]);
    }
    mesh_.region.clear();
  }

  std::uint64_t added() const { return added_; }
  std::uint64_t left() const { return left_; }

 private:
  struct Entry {
    TetIndex tet;
    Tet corners;  ///< as they were: the slot may hold another tet by now
  };

  Vec3 at(VertexIndex v) const { return mesh_.points[v]; }
  bool inside(HalfFace h) const { return !is_outside(h) && marked_ == complex_.marks[h / 4]; }
  /// +1 if p lies behind the face, outside its tet.
  int side(HalfFace h, Vec3 p) const {
    const Triangle f = complex_.face(h);
    return orient3d(at(f[0]), at(f[1]), at(f[2]), p);
  }

  bool is_small_or_divided(TetIndex t) {
    const Tet& c = complex_.tets[t];
    const Vec3 middle = (at(c[0]) + at(c[1]) + at(c[2]) + at(c[3])) / 4;
    const Sphere sphere = circumscribed(at(c[0]), at(c[1]), at(c[2]), at(c[3]));
    const double largest = kLargestSphere * sizes_.at(middle);
    if (sphere.squared_radius <= largest * largest) return true;
    if (!is_finite(sphere.center)) return false;
    Vec3 p = sphere.center;
    for (int move = 0; move < kMoves; ++move, p = (p + middle) / 2) {
      const TetIndex holder = locate(t, p);
      if (holder != kNone && insert(holder, p)) return true;
    }
    return false;
  }

  /// The tet that holds p, by a walk from t; kNone if the walk meets the boundary.
  TetIndex locate(TetIndex t, Vec3 p) const {
    for (int step = 0; step < kMaxWalk; ++step) {
      HalfFace out = 4 * t;
      while (out < 4 * t + 4 && side(out, p) <= 0) ++out;
      if (out == 4 * t + 4) return t;
      const HalfFace o = complex_.across[out];
      if (is_outside(o)) return kNone;
      t = o / 4;
    }
    return kNone;
  }

  bool insert(TetIndex holder, Vec3 p) {
    if (!find_cavity(holder, p)) return false;
    const double h = sizes_.at(p);
    corners_.clear();
    rim_.clear();
    for (const TetIndex t : cavity_) {
      corners_.insert(corners_.end(), complex_.tets[t].begin(), complex_.tets[t].end());
      for (HalfFace g = 4 * t; g < 4 * t + 4; ++g) {
        const HalfFace o = complex_.across[g];
        if (inside(o)) continue;
        if (is_outside(o) && height(g, p) < kClearance * h) return false;
        const Triangle f = complex_.face(g);
        rim_.insert(rim_.end(), f.begin(), f.end());
      }
    }
    const auto is_near = [&](VertexIndex v) { return squared_length(at(v) - p) < kSpacing * kSpacing * h * h; };
    if (std::ranges::any_of(corners_, is_near) || loses_a_vertex()) return false;
    fill_cavity(p);
    return true;
  }

  /// Fills cavity_ with tets around p in whose spheres it lies, such that p sees all outer faces strictly.
  bool find_cavity(TetIndex holder, Vec3 p) {
    cavity_.assign(1, holder);
    marked_ = complex_.new_mark();
    complex_.marks[holder] = marked_;
    for (std::size_t k = 0; k < cavity_.size(); ++k) {
      for (HalfFace h = 4 * cavity_[k]; h < 4 * cavity_[k] + 4; ++h) {
        const HalfFace o = complex_.across[h];
        if (is_outside(o) || inside(o) || !in_sphere(o / 4, p)) continue;
        if (cavity_.size() >= kMaxCavityOfPoint) return false;
        complex_.marks[o / 4] = marked_;
        cavity_.push_back(o / 4);
      }
    }
    for (std::size_t before = 0; before != cavity_.size();) {
      before = cavity_.size();
      std::erase_if(cavity_, [&](TetIndex t) {
        const bool hidden = hides_outer_face(t, p);
        if (hidden) complex_.marks[t] = 0;
        return hidden;
      });
      if (!inside(4 * holder)) return false;
    }
    keep_part_of(holder);
    return true;
  }

  bool in_sphere(TetIndex t, Vec3 p) const {
    const Tet& c = complex_.tets[t];
    return insphere(at(c[0]), at(c[1]), at(c[2]), at(c[3]), p) > 0;
  }

  bool hides_outer_face(TetIndex t, Vec3 p) const {
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      if (!inside(complex_.across[h]) && side(h, p) >= 0) return true;
    }
    return false;
  }

  /// What was taken out may have cut the cavity; all outer faces of each part are seen.
  void keep_part_of(TetIndex holder) {
    const std::uint32_t whole = marked_;
    marked_ = complex_.new_mark();
    complex_.marks[holder] = marked_;
    cavity_.assign(1, holder);
    for (std::size_t k = 0; k < cavity_.size(); ++k) {
      for (HalfFace h = 4 * cavity_[k]; h < 4 * cavity_[k] + 4; ++h) {
        const HalfFace o = complex_.across[h];
        if (is_outside(o) || complex_.marks[o / 4] != whole) continue;
        complex_.marks[o / 4] = marked_;
        cavity_.push_back(o / 4);
      }
    }
  }

  double height(HalfFace h, Vec3 p) const {
    const Triangle f = complex_.face(h);
    return -dot(p - at(f[0]), unit_normal(at(f[0]), at(f[1]), at(f[2])));
  }

  /// A vertex that no outer face of the cavity has would be lost with it.
  bool loses_a_vertex() {
    const auto distinct = [](std::vector<VertexIndex>& v) {
      std::ranges::sort(v);
      v.erase(std::unique(v.begin(), v.end()), v.end());
      return v.size();
    };
    on_rim_ = rim_;
    return distinct(on_rim_) != distinct(corners_);
  }

  void fill_cavity(Vec3 p) {
    const auto v = static_cast<VertexIndex>(mesh_.points.size());
    mesh_.points.push_back(p);
    complex_.tet_at.push_back(kNone);
    fresh_.clear();
    for (std::size_t i = 0; i < rim_.size(); i += 3) fresh_.push_back({rim_[i], rim_[i + 2], rim_[i + 1], v});
    complex_.replace(cavity_, fresh_);
    for (const TetIndex t : complex_.created()) queue_.push_back({t, complex_.tets[t]});
    ++added_;
  }

  TetMesh& mesh_;
  const SizeField& sizes_;
  const RunContext& context_;
  TetComplex complex_;
  std::deque<Entry> queue_;
  std::uint32_t marked_ = 0;  ///< what the tets of cavity_ are marked with
  std::vector<TetIndex> cavity_;
  std::vector<VertexIndex> corners_, rim_, on_rim_;  ///< of the cavity, and of its outer faces, three each
  std::vector<Tet> fresh_;
  std::uint64_t added_ = 0, left_ = 0;
};

}  // namespace

void refine_interior(TetMesh& mesh, const SizeField& sizes, const Stage& stage) {
  Refiner refiner(mesh, sizes, stage.context());
  refiner.run();
  stage.count("points added", static_cast<double>(refiner.added()));
  stage.count("elements left too large", static_cast<double>(refiner.left()));
}

}  // namespace octafront
