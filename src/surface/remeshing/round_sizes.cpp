#include "surface/remeshing/round_sizes.h"

#include "base/geometry/measures.h"
#include "surface/sizes/thinned.h"

#include <algorithm>
#include <utility>

namespace octafront::remeshing {

void RoundSizes::cap(const std::vector<Vec3>& places, double factor) {
  std::vector<PointSize> wanted;
  for (const Vec3 p : thinned(now_, places)) wanted.push_back({p, factor * now_.at(p)});
  add(std::move(wanted), {.reach = CapShape{}.reach / factor});
}

void RoundSizes::add(std::vector<PointSize> wanted, const CapShape& shape) {
  now_ = capped_at(now_, wanted, context_, shape);
  caps_.push_back({std::move(wanted), shape});
}

bool RoundSizes::cap_or_restore(const std::vector<Vec3>& places, double factor, bool grow_once, ReturnAt returned) {
  std::vector<Vec3> to_cap;
  const std::size_t before = restored_.size();
  std::vector<std::uint8_t> has_grown(before, 0);
  bool in_vain = false, all_restored = true;
  for (const Vec3 p : places) {
    const auto around = restored_around(p);
    if (around != restored_.end()) {
      const auto i = static_cast<std::size_t>(around - restored_.begin());
      if (i < before && !(grow_once && has_grown[i])) around->radius *= kGrowthOfBalls, has_grown[i] = 1;
      in_vain |= around->in_vain;
      continue;
    }
    all_restored = false;
    if (const std::optional<Ball> ball = returned(p)) {
      restored_.push_back(*ball);
      in_vain |= ball->in_vain;
    } else {
      to_cap.push_back(p);
    }
  }
  if (in_vain) forget_caps();
  if (!to_cap.empty()) cap(to_cap, factor);
  return all_restored;
}

std::vector<Ball>::iterator RoundSizes::restored_around(Vec3 p) {
  return std::find_if(restored_.begin(), restored_.end(),
                      [&](const Ball& b) { return distance(b.center, p) < b.radius; });
}

bool RoundSizes::is_restored_near(Vec3 p, double radii) const {
  return std::any_of(restored_.begin(), restored_.end(),
                     [&](const Ball& b) { return distance(b.center, p) < radii * b.radius; });
}

/// The first sizes again, but for what was asked of them elsewhere.
void RoundSizes::forget_caps() {
  now_ = first_;
  for (Caps& caps : caps_) {
    std::erase_if(caps.places, [&](const PointSize& s) {
      return std::any_of(restored_.begin(), restored_.end(),
                         [&](const Ball& b) { return b.in_vain && distance(b.center, s.p) < b.radius; });
    });
    now_ = capped_at(now_, caps.places, context_, caps.shape);
  }
}

}  // namespace octafront::remeshing
