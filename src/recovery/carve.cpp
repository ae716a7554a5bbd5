#include "recovery/carve.h"

#include <octafront/error.h>

#include <algorithm>

#include <fmt/core.h>

namespace octafront::recovery {

namespace {

enum class Side : unsigned char { kUnknown, kInside, kOutside };

bool same_turn(const Triangle& a, const Triangle& b) {
  return a == b || a == Triangle{b[1], b[2], b[0]} || a == Triangle{b[2], b[0], b[1]};
}

}  // namespace

void carve(const ExactPoints& points, const SubdividedSurface& surface, LabelledComplex& mesh) {
  std::vector<Side> side(mesh.slots(), Side::kUnknown);
  std::vector<TetIndex> work;
  const auto claim = [&](TetIndex t, Side s) {
    if (side[t] == s) return;
    if (side[t] != Side::kUnknown) {
      const Vec3 p = points.at(mesh.tets[t][0]);
      throw MeshingError(
          fmt::format("the surface does not separate inside from outside near ({}, {}, {}): it is open, "
                      "or not oriented outward",
                      p.x, p.y, p.z));
    }
    side[t] = s;
    work.push_back(t);
  };
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    for (HalfFace h = 4 * t; mesh.alive(t) && h < 4 * t + 4; ++h) {
      const std::uint32_t f = mesh.label(h);
      if (is_outside(mesh.across[h])) claim(t, Side::kOutside);
      if (f == kNone) continue;
      // Seen from inside, outward is away: the tet inside sees the facet as its own outward face.
      claim(t, same_turn(mesh.face(h), surface.facets()[f].corners) ? Side::kInside : Side::kOutside);
    }
  }
  while (!work.empty()) {
    const TetIndex t = work.back();
    work.pop_back();
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      const HalfFace o = mesh.across[h];
      if (!is_outside(o) && mesh.label(h) == kNone) claim(o / 4, side[t]);
    }
  }
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    if (mesh.alive(t) && side[t] != Side::kInside) mesh.destroy(t);
  }
  std::ranges::fill(mesh.tet_at, kNone);
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    if (!mesh.alive(t)) continue;
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      mesh.tet_at[mesh.apex(h)] = t;
      if (const std::uint32_t f = mesh.label(h); f != kNone)
        mesh.across[h] = kFirstOutside + surface.facets()[f].parent;
    }
  }
}

}  // namespace octafront::recovery
