#include "adapt/carry/carry.h"

#include <octafront/vec.h>

#include "base/core/parallel.h"
#include "base/geometry/box_tree.h"
#include "base/geometry/measures.h"
#include "base/geometry/triangle_box.h"
#include "base/mesh/face_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace octafront::adapt {
namespace {

using Corners = std::array<Vec3, 4>;
using Weights = std::array<double, 4>;

/// Places beyond a face by no more than this part of the height of a tet are in it, for rounding's sake.
constexpr double kRoundingOfWeights = 1e-9;
/// How far out a tet speaks, in parts of its height.
constexpr double kFarthestOut = 1;
/// Tets that share less than this part of themselves with old ones share nothing.
constexpr double kLeastShared = 1e-9;

Corners corners_in(const TetMesh& mesh, TetIndex t) {
  const auto& [a, b, c, d] = mesh.tets[t];
  return {mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]};
}
double volume_of(const Corners& x) {
  return six_volumes(x[0], x[1], x[2], x[3]) / 6;
}
std::uint32_t region_in(const TetMesh& mesh, TetIndex t) {
  return mesh.region.empty() ? 0 : mesh.region[t];
}

Weights weights_in(const Corners& x, Vec3 p) {
  const double whole = six_volumes(x[0], x[1], x[2], x[3]);
  return {six_volumes(p, x[1], x[2], x[3]) / whole, six_volumes(x[0], p, x[2], x[3]) / whole,
          six_volumes(x[0], x[1], p, x[3]) / whole, six_volumes(x[0], x[1], x[2], p) / whole};
}

Vec3 nearest_on(const Corners& x, Vec3 p) {
  Vec3 best = p;
  double distance = HUGE_VAL;
  for (const auto& f : kTetFaces) {
    const auto corner = [&](int k) { return x[static_cast<std::size_t>(f[static_cast<std::size_t>(k)])]; };
    const Vec3 q = closest_point_on_triangle(p, corner(0), corner(1), corner(2));
    if (const double d = squared_distance(p, q); d < distance) distance = d, best = q;
  }
  return best;
}

/// The parts of tets on one side of a plane, as tets.
class Clipper {
 public:
  /// The volume that two tets share.
  double shared(const Corners& a, const Corners& b) {
    parts_.assign(1, a);
    for (const auto& f : kTetFaces) {
      const auto corner = [&](int k) { return b[static_cast<std::size_t>(f[static_cast<std::size_t>(k)])]; };
      clip(corner(0), corner(1), corner(2));
      if (parts_.empty()) return 0;
    }
    double sum = 0;
    for (const Corners& part : parts_) sum += std::abs(volume_of(part));
    return sum;
  }

 private:
  /// Keeps what is behind the triangle.
  void clip(Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 n = cross(b - a, c - a);
    kept_.clear();
    for (const Corners& part : parts_) {
      std::array<double, 4> height;
      std::array<std::size_t, 4> in{}, out{};
      std::size_t ins = 0, outs = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        height[k] = dot(n, part[k] - a);
        (height[k] <= 0 ? in[ins++] : out[outs++]) = k;
      }
      if (outs == 0) kept_.push_back(part);
      if (ins == 0 || outs == 0) continue;
      const auto cut = [&](std::size_t i, std::size_t o) {
        const double s = height[i] / (height[i] - height[o]);
        return part[i] + s * (part[o] - part[i]);
      };
      if (ins == 1) {
        kept_.push_back({part[in[0]], cut(in[0], out[0]), cut(in[0], out[1]), cut(in[0], out[2])});
      } else if (ins == 2) {
        const Vec3 p = part[in[0]], q = part[in[1]];
        add_prism({p, cut(in[0], out[0]), cut(in[0], out[1])}, {q, cut(in[1], out[0]), cut(in[1], out[1])});
      } else {
        add_prism({part[in[0]], part[in[1]], part[in[2]]},
                  {cut(in[0], out[0]), cut(in[1], out[0]), cut(in[2], out[0])});
      }
    }
    std::swap(parts_, kept_);
  }
  void add_prism(const std::array<Vec3, 3>& low, const std::array<Vec3, 3>& high) {
    kept_.push_back({low[0], low[1], low[2], high[0]});
    kept_.push_back({low[1], low[2], high[0], high[1]});
    kept_.push_back({low[2], high[0], high[1], high[2]});
  }

  std::vector<Corners> parts_, kept_;
};

}  // namespace

/// Tets by their boxes.
struct Carrier::Tree {
  Tree(const TetMesh& mesh, const std::vector<TetIndex>& tets) : mesh_(mesh), boxes_(items_of(mesh, tets)) {}

  /// visit(tet) for all whose boxes meet the box, in an order that depends on the tree only.
  template <class Visit>
  void for_each_near(const Box3& box, const Visit& visit) const {
    boxes_.for_each([&](const Box3& b) { return b.overlaps(box); }, [&](const auto& item) { visit(item.number); });
  }

  /// The tet nearest to p, of those wanted; kNone: there is none.
  template <class Wanted>
  TetIndex nearest(Vec3 p, const Wanted& wanted) const {
    TetIndex best = kNone;
    double distance = HUGE_VAL;
    boxes_.for_each(
        [&](const Box3& box) { return squared_distance(p, box) < distance; },
        [&](const auto& item) {
          if (!wanted(item.number)) return;
          const double d = squared_distance(p, nearest_on(corners_in(mesh_, item.number), p));
          if (d < distance) distance = d, best = item.number;
        },
        [&](const Box3& left, const Box3& right) { return squared_distance(p, left) <= squared_distance(p, right); });
    return best;
  }

 private:
  using Boxes = BoxTree<Box3>;
  static std::vector<Boxes::Item> items_of(const TetMesh& mesh, const std::vector<TetIndex>& tets) {
    std::vector<Boxes::Item> items;
    for (const TetIndex t : tets) {
      items.push_back({{}, t});
      for (const Vec3& p : corners_in(mesh, t)) items.back().bounds.add(p);
    }
    return items;
  }

  const TetMesh& mesh_;
  Boxes boxes_;
};

Carrier::Carrier(const TetMesh& before, const TetMesh& now, std::span<const VertexIndex> old_of_new,
                 std::span<const TetIndex> old_tet_of_new)
    : before_(before), now_(now), old_of_new_(old_of_new), old_tet_of_new_(old_tet_of_new) {
  std::vector<std::uint8_t> kept(before.tets.size(), 0);
  for (const TetIndex t : old_tet_of_new)
    if (t != kNone) kept[t] = 1;
  std::vector<TetIndex> gone;
  for (TetIndex t = 0; t < kept.size(); ++t)
    if (!kept[t]) gone.push_back(t);
  tree_ = std::make_unique<Tree>(before, gone);
}

Carrier::~Carrier() = default;

std::vector<double> Carrier::at_vertices(std::span<const double> values, std::size_t components) const {
  std::vector<double> made(now_.points.size() * components, 0);
  parallel_for(now_.points.size(), [&](std::size_t v) {
    const VertexIndex old = old_of_new_[v];
    const Vec3 p = now_.points[v];
    const auto own = [&](std::size_t k) -> double& { return made[v * components + k]; };
    if (old != kNone && before_.points[old] == p) {
      for (std::size_t k = 0; k < components; ++k) own(k) = values[old * components + k];
      return;
    }
    TetIndex holder = kNone;
    Weights weights{};
    double best = -kRoundingOfWeights;
    tree_->for_each_near({p, p}, [&](TetIndex t) {
      const Weights w = weights_in(corners_in(before_, t), p);
      const double least = *std::min_element(w.begin(), w.end());
      if (least > best || (least == best && holder != kNone && t < holder)) best = least, holder = t, weights = w;
    });
    if (holder == kNone) {
      holder = tree_->nearest(p, [](TetIndex) { return true; });
      if (holder == kNone) return;
      const Corners corners = corners_in(before_, holder);
      weights = weights_in(corners, p);
      if (*std::min_element(weights.begin(), weights.end()) < -kFarthestOut)
        weights = weights_in(corners, nearest_on(corners, p));
    }
    for (std::size_t k = 0; k < components; ++k)
      for (std::size_t i = 0; i < 4; ++i) own(k) += weights[i] * values[before_.tets[holder][i] * components + k];
  });
  return made;
}

std::vector<double> Carrier::of_tets(std::span<const double> values, std::size_t components) const {
  std::vector<double> made(now_.tets.size() * components, 0);
  PerThread<Clipper> clippers;
  parallel_for(now_.tets.size(), [&](std::size_t number) {
    const auto t = static_cast<TetIndex>(number);
    const auto own = [&](std::size_t k) -> double& { return made[number * components + k]; };
    const auto add = [&](TetIndex old, double weight) {
      for (std::size_t k = 0; k < components; ++k) own(k) += weight * values[old * components + k];
    };
    if (old_tet_of_new_[t] != kNone) {
      for (std::size_t k = 0; k < components; ++k) own(k) = values[old_tet_of_new_[t] * components + k];
      return;
    }
    const Corners corners = corners_in(now_, t);
    const auto is_of_region = [&](TetIndex old) { return region_in(before_, old) == region_in(now_, t); };
    Clipper& clipper = clippers.local([] { return Clipper(); });
    Box3 box;
    for (const Vec3& p : corners) box.add(p);
    double sum = 0;
    tree_->for_each_near(box, [&](TetIndex old) {
      if (!is_of_region(old)) return;
      const double shared = clipper.shared(corners, corners_in(before_, old));
      sum += shared;
      add(old, shared);
    });
    if (sum > kLeastShared * volume_of(corners)) {
      for (std::size_t k = 0; k < components; ++k) own(k) /= sum;
      return;
    }
    for (std::size_t k = 0; k < components; ++k) own(k) = 0;
    const Vec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    if (const TetIndex old = tree_->nearest(middle, is_of_region); old != kNone) add(old, 1);
  });
  spread_rest(values, components, made);
  return made;
}

void Carrier::spread_rest(std::span<const double> values, std::size_t components, std::vector<double>& made) const {
  std::uint32_t regions = 1;
  for (const std::uint32_t r : before_.region) regions = std::max(regions, r + 1);
  std::vector<std::uint8_t> kept(before_.tets.size(), 0);
  for (const TetIndex t : old_tet_of_new_)
    if (t != kNone) kept[t] = 1;
  std::vector<double> lacks(regions * components, 0), volumes(regions, 0);
  for (TetIndex t = 0; t < before_.tets.size(); ++t) {
    if (kept[t]) continue;
    const double volume = volume_of(corners_in(before_, t));
    for (std::size_t k = 0; k < components; ++k)
      lacks[region_in(before_, t) * components + k] += volume * values[t * components + k];
  }
  for (TetIndex t = 0; t < now_.tets.size(); ++t) {
    if (old_tet_of_new_[t] != kNone) continue;
    const double volume = volume_of(corners_in(now_, t));
    volumes[region_in(now_, t)] += volume;
    for (std::size_t k = 0; k < components; ++k)
      lacks[region_in(now_, t) * components + k] -= volume * made[t * components + k];
  }
  for (TetIndex t = 0; t < now_.tets.size(); ++t)
    if (const std::uint32_t r = region_in(now_, t); old_tet_of_new_[t] == kNone)
      for (std::size_t k = 0; k < components; ++k) made[t * components + k] += lacks[r * components + k] / volumes[r];
}

}  // namespace octafront::adapt
