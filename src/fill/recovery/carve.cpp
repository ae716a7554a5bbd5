#include "fill/recovery/carve.h"

#include <octafront/error.h>
#include <octafront/surface_mesh.h>

#include <algorithm>

#include <fmt/core.h>

namespace octafront::recovery {

namespace {

// What lies in a tet: kNone outside, else a region.
constexpr std::uint32_t kUnknown = kNone - 1;

bool same_turn(const Triangle& a, const Triangle& b) {
  return a == b || a == Triangle{b[1], b[2], b[0]} || a == Triangle{b[2], b[0], b[1]};
}

/// Spreads what the facets say of the tets beside them.
class Spreading {
 public:
  Spreading(const ExactPoints& points, const SubdividedSurface& surface, const SurfaceMesh& input,
            const LabelledComplex& mesh)
      : points_(points), surface_(surface), input_(input), mesh_(mesh), holds_(mesh.slots(), kUnknown) {}

  std::vector<std::uint32_t> run() {
    for (TetIndex t = 0; t < mesh_.slots(); ++t) {
      for (HalfFace h = 4 * t; mesh_.alive(t) && h < 4 * t + 4; ++h) {
        if (is_outside(mesh_.across[h])) claim(t, kNone);
        if (const std::uint32_t f = mesh_.label(h); f != kNone) claim(t, behind_facet(h, f));
      }
    }
    while (!work_.empty()) {
      const TetIndex t = work_.back();
      work_.pop_back();
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
        const HalfFace o = mesh_.across[h];
        if (!is_outside(o) && mesh_.label(h) == kNone) claim(o / 4, holds_[t]);
      }
    }
    return std::move(holds_);
  }

 private:
  /// Seen from inside, outward is away: the tet behind a facet sees it as its own outward face.
  std::uint32_t behind_facet(HalfFace h, std::uint32_t f) const {
    const auto& [corners, parent] = surface_.facets()[f];
    return input_.sides_of(parent)[same_turn(mesh_.face(h), corners)];
  }

  void claim(TetIndex t, std::uint32_t region) {
    if (holds_[t] == region) return;
    if (holds_[t] != kUnknown) {
      const Vec3 p = points_.at(mesh_.tets[t][0]);
      throw MeshingError(
          fmt::format("the surface does not separate {} near ({}, {}, {}): it is open, "
                      "or {}",
                      input_.sides.empty() ? "inside from outside" : "its regions", p.x, p.y, p.z,
                      input_.sides.empty() ? "not oriented outward" : "the sides of its triangles do not agree"));
    }
    holds_[t] = region;
    work_.push_back(t);
  }

  const ExactPoints& points_;
  const SubdividedSurface& surface_;
  const SurfaceMesh& input_;
  const LabelledComplex& mesh_;
  std::vector<std::uint32_t> holds_;
  std::vector<TetIndex> work_;
};

/// For each triangle with a region in front the number of its back.
std::vector<std::uint32_t> numbers_of_backs(const SurfaceMesh& input) {
  std::vector<std::uint32_t> number(input.triangles.size(), kNone);
  auto next = static_cast<std::uint32_t>(number.size());
  for (std::size_t t = 0; t < number.size(); ++t)
    if (input.sides_of(t)[0] != kNone) number[t] = next++;
  return number;
}

}  // namespace

std::vector<Triangle> with_backs(std::vector<Triangle> triangles, const SurfaceMesh& surface) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (surface.sides_of(t)[0] != kNone) triangles.push_back({triangles[t][0], triangles[t][2], triangles[t][1]});
  return triangles;
}

void carve(const ExactPoints& points, const SubdividedSurface& surface, const SurfaceMesh& input,
           LabelledComplex& mesh) {
  const std::vector<std::uint32_t> holds = Spreading(points, surface, input, mesh).run();
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    if (mesh.alive(t) && (holds[t] == kNone || holds[t] == kUnknown)) mesh.destroy(t);
  }
  const std::vector<std::uint32_t> back = numbers_of_backs(input);
  std::ranges::fill(mesh.tet_at, kNone);
  for (TetIndex t = 0; t < mesh.slots(); ++t) {
    if (!mesh.alive(t)) continue;
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      mesh.tet_at[mesh.apex(h)] = t;
      const std::uint32_t f = mesh.label(h);
      if (f == kNone) continue;
      const auto& [corners, parent] = surface.facets()[f];
      mesh.across[h] = kFirstOutside + (same_turn(mesh.face(h), corners) ? parent : back[parent]);
    }
  }
}

}  // namespace octafront::recovery
