#include "surface/remeshing/front_kind.h"

#include <algorithm>
#include <utility>

namespace octafront::surface {

void RoundSizes::cap(const std::vector<Vec3>& places, double factor) {
  add(smaller_at(places, factor, now_), {.reach = CapShape{}.reach / factor});
}

void RoundSizes::add(std::vector<PointSize> wanted, const CapShape& shape) {
  now_ = capped_at(now_, wanted, context_, shape);
  caps_.push_back({std::move(wanted), shape});
}

bool RoundSizes::cap_or_keep(const std::vector<Vec3>& places, double factor, bool grow_once, KeepAt returned) {
  std::vector<Vec3> to_cap;
  const std::size_t before = kept_places_.size();
  std::vector<std::uint8_t> has_grown(before, 0);
  bool in_vain = false, all_kept = true;
  for (const Vec3 p : places) {
    const auto around = kept_place_around(p);
    if (around != kept_places_.end()) {
      const auto i = static_cast<std::size_t>(around - kept_places_.begin());
      if (i < before && !(grow_once && has_grown[i])) around->radius *= kGrowthOfKeptPlaces, has_grown[i] = 1;
      in_vain |= around->in_vain;
      continue;
    }
    all_kept = false;
    if (const std::optional<KeptPlace> ball = returned(p)) {
      kept_places_.push_back(*ball);
      in_vain |= ball->in_vain;
    } else {
      to_cap.push_back(p);
    }
  }
  if (in_vain) forget_caps();
  if (!to_cap.empty()) cap(to_cap, factor);
  return all_kept;
}

std::vector<KeptPlace>::iterator RoundSizes::kept_place_around(Vec3 p) {
  return std::find_if(kept_places_.begin(), kept_places_.end(),
                      [&](const KeptPlace& b) { return distance(b.center, p) < b.radius; });
}

bool RoundSizes::is_kept_near(Vec3 p, double radii) const {
  return std::any_of(kept_places_.begin(), kept_places_.end(),
                     [&](const KeptPlace& b) { return distance(b.center, p) < radii * b.radius; });
}

/// The first sizes again, but for what was asked of them elsewhere.
void RoundSizes::forget_caps() {
  now_ = first_;
  for (Caps& caps : caps_) {
    std::erase_if(caps.places, [&](const PointSize& s) {
      return std::any_of(kept_places_.begin(), kept_places_.end(),
                         [&](const KeptPlace& b) { return b.in_vain && distance(b.center, s.p) < b.radius; });
    });
    now_ = capped_at(now_, caps.places, context_, caps.shape);
  }
}

}  // namespace octafront::surface
