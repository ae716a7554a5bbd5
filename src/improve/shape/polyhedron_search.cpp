#include "improve/shape/polyhedron_search.h"

#include <octafront/tet_mesh.h>

#include "base/geometry/predicates.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace octafront::improve {
namespace {

using Corner = PolyhedronSearch::Corner;

std::uint16_t key_of(Corner a, Corner b, Corner c) {
  while (a > b || a > c) std::tie(a, b, c) = std::tuple{b, c, a};
  return static_cast<std::uint16_t>(a << 8 | b << 4 | c);
}
PolyhedronSearch::Face unpacked(std::uint16_t face) {
  return {static_cast<Corner>(face >> 8), static_cast<Corner>(face >> 4 & 15), static_cast<Corner>(face & 15)};
}

/// The place of a < b < c < d among all sets of four, in the combinatorial number system.
int place_of(int a, int b, int c, int d) {
  return a + b * (b - 1) / 2 + c * (c - 1) * (c - 2) / 6 + d * (d - 1) * (d - 2) * (d - 3) / 24;
}

}  // namespace

bool PolyhedronSearch::Front::has(std::uint16_t face) const {
  return std::find(faces.begin(), faces.begin() + size, face) != faces.begin() + size;
}
bool PolyhedronSearch::Front::erase(std::uint16_t face) {
  const auto end = faces.begin() + size, at = std::find(faces.begin(), end, face);
  if (at == end) return false;
  *at = faces[--size];
  return true;
}

void PolyhedronSearch::value_fours(std::span<const Vec3> p, const Floor& floor) {
  std::vector<int> places;
  const auto evaluate = [&] {
    batch_.evaluate();
    for (int i = 0; i < batch_.size; ++i) {
      shape_[places[i]] = batch_.shape(i);
      if (!floor.below(shape_[places[i]]) || shape_[places[i]].score <= bound_) sign_[places[i]] = 0;
    }
    batch_.size = 0;
    places.clear();
  };
  batch_.size = 0;
  for (int d = 3; d < corner_count_; ++d)
    for (int c = 2; c < d; ++c)
      for (int b = 1; b < c; ++b)
        for (int a = 0; a < b; ++a) {
          const int at = place_of(a, b, c, d);
          sign_[at] = static_cast<std::int8_t>(orient3d(p[a], p[b], p[c], p[d]));
          if (sign_[at] == 0) continue;
          if (batch_.full()) evaluate();
          places.push_back(at);
          sign_[at] > 0 ? batch_.add(p[a], p[b], p[c], p[d]) : batch_.add(p[b], p[a], p[c], p[d]);
        }
  evaluate();
}

float PolyhedronSearch::value(Corner apex, std::uint16_t face, int& four) const {
  const auto [x, y, z] = unpacked(face);
  if (apex == x || apex == y || apex == z) return 0;
  std::array<Corner, 4> c{apex, x, y, z};
  int sign = 1;
  const auto order = [&](int i, int j) {
    if (c[i] > c[j]) std::swap(c[i], c[j]), sign = -sign;
  };
  order(0, 1), order(2, 3), order(0, 2), order(1, 3), order(1, 2);
  four = place_of(c[0], c[1], c[2], c[3]);
  return sign_[four] == sign ? shape_[four].score : 0;
}

/// Takes the tetrahedron (apex, face) out of what is open; false if part of it was not.
bool PolyhedronSearch::cover(Front& front, std::uint16_t face, Corner apex) const {
  front.erase(face);
  const auto [x, y, z] = unpacked(face);
  const std::array<Corner, 4> tet{apex, x, y, z};
  for (int i = 1; i < 4; ++i) {
    const auto& f = kTetFaces[i];
    if (front.erase(key_of(tet[f[0]], tet[f[1]], tet[f[2]]))) continue;
    // The face opens towards its other side.
    const std::uint16_t beyond = key_of(tet[f[0]], tet[f[2]], tet[f[1]]);
    if (front.has(beyond) || front.size >= kMostFaces) return false;
    front.faces[front.size++] = beyond;
  }
  return true;
}

void PolyhedronSearch::search(const Front& front, float worst) {
  if (front.size == 0) {
    best_ = stack_;
    bound_ = worst;
    found_ = true;
    return;
  }
  if (++steps_ > kSteps) return;
  struct Way {
    float value;
    Corner apex;
    int four;
  };
  std::array<Way, kMostCorners> ways, fewest;
  int fewest_count = kMostCorners + 1;
  std::uint16_t hardest = 0;
  for (int k = 0; k < front.size && fewest_count > 1; ++k) {
    int count = 0;
    for (Corner apex = 0; apex < corner_count_ && count < fewest_count; ++apex) {
      int four = 0;
      const float v = value(apex, front.faces[k], four);
      if (v > bound_) ways[count++] = {v, apex, four};
    }
    if (count == 0) return;
    if (count < fewest_count) fewest = ways, fewest_count = count, hardest = front.faces[k];
  }
  std::sort(fewest.begin(), fewest.begin() + fewest_count,
            [](const Way& a, const Way& b) { return a.value != b.value ? a.value > b.value : a.apex < b.apex; });
  const auto [x, y, z] = unpacked(hardest);
  for (int i = 0; i < fewest_count && fewest[i].value > bound_; ++i) {
    Front next = front;
    if (!cover(next, hardest, fewest[i].apex)) continue;
    stack_.push_back({{fewest[i].apex, x, y, z}, shape_[fewest[i].four]});
    search(next, std::min(worst, fewest[i].value));
    stack_.pop_back();
  }
}

bool PolyhedronSearch::fill(std::span<const Vec3> corners, std::span<const Face> faces, const Floor& floor,
                            float bound) {
  corner_count_ = static_cast<int>(corners.size());
  bound_ = std::max(bound, 0.0f);
  found_ = false;
  steps_ = 0;
  stack_.clear();
  value_fours(corners, floor);
  Front front;
  for (const Face& f : faces) front.faces[front.size++] = key_of(f[0], f[1], f[2]);
  search(front, 2);
  return found_;
}

}  // namespace octafront::improve
