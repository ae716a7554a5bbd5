#include "mend/separate.h"

#include "cells/side_graph.h"
#include "core/disjoint_sets.h"
#include "geometry/measures.h"
#include "geometry/self_intersection.h"
#include "mesh/surface_topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace octafront::mend {
namespace {

/// A copy moves by a part of the shortest edge beside it at most, and half as far again where it still touches.
constexpr double kStep = 0.2;
constexpr int kRounds = 10;

/// A vertex of a part: where it was, which way it goes, how far.
struct Copy {
  VertexIndex vertex, original;
  Vec3 from, way;
  double step;
};

/// A direction that leads behind all of the planes, or nearly.
Vec3 way_behind(const std::vector<Vec3>& normals) {
  Vec3 way;
  for (const Vec3 n : normals) way -= n;
  way = normalized(way);
  constexpr int kTries = 40;
  constexpr double kEnough = 0.15;
  for (int i = 0; i < kTries; ++i) {
    const Vec3 worst = *std::max_element(normals.begin(), normals.end(),
                                         [&](Vec3 a, Vec3 b) { return dot(a, way) < dot(b, way); });
    if (dot(worst, way) < -kEnough) break;
    way = normalized(way - 0.3 * worst);
  }
  return way;
}

class Separation {
 public:
  Separation(SurfaceMesh& surface, double most, const RunContext& context)
      : surface_(surface), most_(most), context_(context), fan_(3 * surface.triangles.size()) {}

  Separated result() {
    Separated done;
    join_fans();
    const std::vector<Vec3> points = surface_.points;
    const std::vector<Triangle> triangles = surface_.triangles;
    make_copies();
    if (copies_.empty()) return done;
    find_ways();
    done.done = move_apart();
    if (!done.done) {
      surface_.points = points;
      surface_.triangles = triangles;
      return done;
    }
    note_moves(done);
    return done;
  }

 private:
  /// Corners of triangles that hang together through the inside.
  void join_fans() {
    const cells::SideGraph graph = cells::make_side_graph(surface_.points, surface_.triangles, context_);
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t other = cells::triangle_of(graph.next[cells::behind(t)][i]);
        for (const VertexIndex v : {surface_.triangles[t][i], surface_.triangles[t][(i + 1) % 3]})
          fan_.join(corner(t, v), corner(other, v));
      }
  }

  std::uint32_t corner(std::uint32_t t, VertexIndex v) const {
    const Triangle& c = surface_.triangles[t];
    return 3 * t + static_cast<std::uint32_t>(std::find(c.begin(), c.end(), v) - c.begin());
  }

  /// The first fan of a vertex keeps it; all that share it move.
  void make_copies() {
    std::vector<std::uint32_t> first(surface_.points.size(), kNone), copy(3 * surface_.triangles.size(), kNone);
    std::vector<char> is_shared(surface_.points.size(), 0);
    for (std::uint32_t c = 0; c < copy.size(); ++c) {
      if (fan_.find(c) != c) continue;
      const VertexIndex v = surface_.triangles[c / 3][c % 3];
      if (first[v] == kNone) {
        first[v] = c;
      } else {
        is_shared[v] = 1;
      }
    }
    const std::vector<Triangle> before = surface_.triangles;
    for (std::uint32_t c = 0; c < copy.size(); ++c) {
      const VertexIndex v = before[c / 3][c % 3];
      if (!is_shared[v]) continue;
      const std::uint32_t f = fan_.find(c);
      if (copy[f] == kNone) {
        VertexIndex number = v;
        if (first[v] != f) {
          number = static_cast<VertexIndex>(surface_.points.size());
          surface_.points.push_back(Vec3(surface_.points[v]));
        }
        copy[f] = static_cast<std::uint32_t>(copies_.size());
        copies_.push_back({number, v, surface_.points[v], {}, most_});
      }
      surface_.triangles[c / 3][c % 3] = copies_[copy[f]].vertex;
    }
    copy_of_.assign(surface_.points.size(), kNone);
    for (std::uint32_t k = 0; k < copies_.size(); ++k) copy_of_[copies_[k].vertex] = k;
  }

  void find_ways() {
    std::vector<std::vector<Vec3>> normals(copies_.size());
    for (const Triangle& t : surface_.triangles) {
      const std::array<Vec3, 3> p{surface_.points[t[0]], surface_.points[t[1]], surface_.points[t[2]]};
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t k = copy_of_[t[i]];
        if (k == kNone) continue;
        normals[k].push_back(unit_normal(p[0], p[1], p[2]));
        for (const int j : {(i + 1) % 3, (i + 2) % 3})
          copies_[k].step = std::min(copies_[k].step, kStep * distance(p[i], p[j]));
      }
    }
    for (std::size_t k = 0; k < copies_.size(); ++k) copies_[k].way = way_behind(normals[k]);
  }

  bool move_apart() {
    for (int round = 0; round < kRounds; ++round) {
      for (const Copy& c : copies_) surface_.points[c.vertex] = c.from + c.step * c.way;
      const auto pairs = self_intersections(surface_.points, surface_.triangles, kMostPairs, context_);
      if (pairs.empty()) return true;
      std::vector<char> shorter(copies_.size(), 0);
      for (const auto& pair : pairs)
        for (const std::uint32_t t : pair)
          for (const VertexIndex v : surface_.triangles[t])
            if (copy_of_[v] != kNone) shorter[copy_of_[v]] = 1;
      for (std::size_t k = 0; k < copies_.size(); ++k)
        if (shorter[k]) copies_[k].step *= 0.5;
    }
    return false;
  }

  void note_moves(Separated& done) const {
    std::vector<std::pair<VertexIndex, std::size_t>> order;
    for (std::size_t k = 0; k < copies_.size(); ++k) order.push_back({copies_[k].original, k});
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Copy& c = copies_[order[i].second];
      if (i == 0 || order[i - 1].first != c.original) {
        done.places.push_back(c.from);
        done.moves.push_back(0);
      }
      done.moves.back() = std::max(done.moves.back(), c.step);
    }
  }

  static constexpr std::size_t kMostPairs = 1u << 20;

  SurfaceMesh& surface_;
  double most_;
  const RunContext& context_;
  DisjointSets fan_;  ///< of corners 3 t + i
  std::vector<Copy> copies_;
  std::vector<std::uint32_t> copy_of_;  ///< per vertex
};

}  // namespace

Separated separate_contacts(SurfaceMesh& surface, double most, const RunContext& context) {
  if (is_closed_manifold(surface.triangles, surface.points.size())) return {};
  return Separation(surface, most, context).result();
}

}  // namespace octafront::mend
