#pragma once

#include "lattice/graded_bcc.h"

#include <array>
#include <cstdint>
#include <vector>

namespace octafront {

/// Numbers lattice sites 0, 1, 2 ... in the order in which they are first asked for. The lattice asks for every site
/// some twenty times, mostly in a row: a small direct-mapped cache answers those, open addressing with linear steps the
/// rest.
class SiteTable {
 public:
  explicit SiteTable(std::size_t expected) {
    std::size_t capacity = 64;
    while (capacity < 2 * expected) capacity *= 2;
    slots_.resize(capacity, Slot{kNoSite, 0});
    sites_.reserve(expected);
    recent_.fill(Slot{kNoSite, 0});
  }

  std::uint32_t operator[](LatticeSite site) {
    Slot& recent = recent_[mixed(site) >> 55];
    if (recent.site != site) recent = {site, look_up(site)};
    return recent.index;
  }
  const std::vector<LatticeSite>& sites() const { return sites_; }

 private:
  struct Slot {
    LatticeSite site;
    std::uint32_t index;
  };
  static constexpr LatticeSite kNoSite = ~LatticeSite{0};

  static std::uint64_t mixed(LatticeSite site) { return site * 0x9e3779b97f4a7c15ull; }

  Slot& slot_of(LatticeSite site) {
    std::size_t at = mixed(site) >> 20 & (slots_.size() - 1);
    while (slots_[at].site != kNoSite && slots_[at].site != site) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
  }
  std::uint32_t look_up(LatticeSite site) {
    if (2 * sites_.size() >= slots_.size()) grow();
    Slot& slot = slot_of(site);
    if (slot.site == kNoSite) {
      slot = {site, static_cast<std::uint32_t>(sites_.size())};
      sites_.push_back(site);
    }
    return slot.index;
  }
  void grow() {
    slots_.assign(2 * slots_.size(), Slot{kNoSite, 0});
    for (std::uint32_t i = 0; i < sites_.size(); ++i) slot_of(sites_[i]) = {sites_[i], i};
  }

  std::vector<Slot> slots_;
  std::vector<LatticeSite> sites_;
  std::array<Slot, 512> recent_;
};

}  // namespace octafront
