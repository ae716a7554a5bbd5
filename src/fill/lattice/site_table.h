#pragma once

#include "base/core/flat_map.h"
#include "fill/lattice/graded_bcc.h"

#include <array>
#include <cstdint>
#include <vector>

namespace octafront {

/// Numbers lattice sites 0, 1, 2 ... in the order in which they are first asked for. The lattice asks for every site
/// some twenty times, mostly in a row: a small direct-mapped cache answers those, a hash map the rest.
class SiteTable {
 public:
  explicit SiteTable(std::size_t expected) : number_(expected) {
    sites_.reserve(expected);
    recent_.fill({kNoSite, 0});
  }

  std::uint32_t operator[](LatticeSite site) {
    Recent& recent = recent_[FlatKeys<LatticeSite>::hash(site) >> 55];
    if (recent.site != site) recent = {site, look_up(site)};
    return recent.number;
  }
  const std::vector<LatticeSite>& sites() const { return sites_; }

 private:
  struct Recent {
    LatticeSite site;
    std::uint32_t number;
  };
  static constexpr LatticeSite kNoSite = FlatKeys<LatticeSite>::kEmpty;

  std::uint32_t look_up(LatticeSite site) {
    const std::uint32_t number = number_.find_or_add(site, static_cast<std::uint32_t>(sites_.size()));
    if (number == sites_.size()) sites_.push_back(site);
    return number;
  }

  FlatMap<LatticeSite, std::uint32_t> number_;
  std::vector<LatticeSite> sites_;
  std::array<Recent, 512> recent_;
};

}  // namespace octafront
