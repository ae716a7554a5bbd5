#include "adapt/schedule/balance_walls.h"

#include "adapt/ground/balance_steps.h"
#include "adapt/schedule/parts.h"
#include "base/core/parallel.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace octafront::adapt {
namespace {

/// Steps change what walls stand for: they are taken so many times.
constexpr int kMostBalancings = 2;
/// Elements keep this part of their scores, unless these are this good still.
constexpr float kKeptOfBalance = 0.9f, kGoodOfBalance = 0.6f, kGoodOfBalanceInMetric = 0.3f;

float score_in(const std::vector<Vertex>& vertices, const Tet& c, bool isotropic) {
  return score_of_corners({&vertices[c[0]], &vertices[c[1]], &vertices[c[2]], &vertices[c[3]]}, isotropic);
}

bool may_balance(const Vertex& v) {
  return v.kind == Kind::kSurface && !v.stays();
}

/// Others are where they belong since walls were balanced before.
bool waits(const Vertex& v) {
  return may_balance(v) && !v.balanced;
}

/// What lies around vertices that moved is to be balanced once more.
void wake_around(Parts& parts, const std::vector<std::uint8_t>& moves) {
  for (Vertex& v : parts.vertices) v.balanced = true;
  for (const Tet& c : parts.tets)
    if (std::any_of(c.begin(), c.end(), [&](VertexIndex v) { return moves[v] != 0; }))
      for (const VertexIndex v : c) parts.vertices[v].balanced = false;
}

/// Takes back what makes elements worse, until none is.
void take_back(const Parts& parts, std::vector<Vertex>& moved, std::vector<std::uint8_t>& moves) {
  const float good = parts.isotropic ? kGoodOfBalance : kGoodOfBalanceInMetric;
  for (bool is_done = false; !is_done;) {
    std::vector<std::uint8_t> bad(parts.tets.size(), 0);
    parallel_for(bad.size(), [&](std::size_t t) {
      const Tet& c = parts.tets[t];
      if (std::none_of(c.begin(), c.end(), [&](VertexIndex v) { return moves[v] != 0; })) return;
      const float had = score_in(parts.vertices, c, parts.isotropic), has = score_in(moved, c, parts.isotropic);
      bad[t] = !(has > 0) || has < std::min(kKeptOfBalance * had, good);
    });
    is_done = true;
    for (std::size_t t = 0; t < bad.size(); ++t)
      if (bad[t])
        for (const VertexIndex v : parts.tets[t])
          if (moves[v]) moves[v] = 0, moved[v] = parts.vertices[v], is_done = false;
  }
}

std::size_t balance_once(Parts& parts, const Guide& guide, double feature_angle) {
  // Lines on them are where they are when the mesh comes again.
  const WallsOfParts now = wall_triangles(parts, [](const Triangle&, std::uint32_t) { return false; });
  Walls walls;
  walls.surface = now.surface, walls.outer = now.outer;
  turn_alike(walls);
  walls.lines = detect_features(walls.surface, walls.edges, feature_angle);
  std::vector<std::uint8_t> may_move, waiting;
  std::vector<std::uint32_t> near;
  for (const VertexIndex v : now.vertex) {
    const Vertex& at = parts.vertices[v];
    may_move.push_back(may_balance(at)), waiting.push_back(waits(at)), near.push_back(at.near);
  }
  const std::vector<Vec3> steps = steps_to_balance(walls, may_move, waiting, near, guide.ground, guide.tolerances);
  std::vector<Vertex> moved = parts.vertices;
  std::vector<std::uint8_t> moves(moved.size(), 0);
  for (std::size_t p = 0; p < steps.size(); ++p) {
    Vertex& v = moved[now.vertex[p]];
    if (steps[p] == Vec3{}) continue;
    v.at += steps[p];
    guide.ask(v);
    v.calmness = Vertex::kStirred;
    moves[now.vertex[p]] = 1;
  }
  take_back(parts, moved, moves);
  parts.vertices = std::move(moved);
  wake_around(parts, moves);
  return static_cast<std::size_t>(std::count(moves.begin(), moves.end(), 1));
}

}  // namespace

std::size_t balance_walls(Parts& parts, const Guide& guide, double feature_angle) {
  if (guide.ground.given() || guide.tolerance <= 0) return 0;
  const auto any_waits = [&] { return std::any_of(parts.vertices.begin(), parts.vertices.end(), waits); };
  std::size_t moved = 0;
  for (int k = 0; k < kMostBalancings && any_waits(); ++k)
    moved = std::max(moved, balance_once(parts, guide, feature_angle));
  for (Vertex& v : parts.vertices) v.balanced = true;
  return moved;
}

}  // namespace octafront::adapt
