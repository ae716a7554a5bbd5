#pragma once

// What `periodic` says: axes of a box, or other maps.

#include "periodic/periodic_map.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace octafront {

/// A map, and the names of the patches that it leads from and to; empty: they are sought.
struct AskedMap {
  PeriodicMap map;
  std::string low, high;
};

struct AskedPeriods {
  std::array<bool, 3> along = {};  ///< axes of a box
  std::vector<AskedMap> maps;      ///< if there are none
};

/// "xyz"; or maps between semicolons: "1,0,0" (a translation), "30@z" (degrees about an axis of space),
/// "360/7@0,0,0,1,1,1" (about the axis through a point along a direction), each with "LOW:HIGH=" before it or without.
/// Nothing of an empty text. Throws OptionError, which names the option, for anything else.
AskedPeriods periods_asked(std::string_view option, std::string_view text);

}  // namespace octafront
