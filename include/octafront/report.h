#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace octafront {

/// What one stage did: its time, and counters that do not jitter between runs.
struct StageReport {
  std::string name;
  double wall_seconds = 0;
  double cpu_seconds = 0;  ///< user and system time of the whole process during the stage
  std::vector<std::pair<std::string, double>> counters;  ///< e.g. {"candidates tried", 1.2e6}, in a fixed order
  std::vector<std::string> notes;  ///< sentences for the user: what was changed or given up, and where

  void count(std::string key, double value) { counters.emplace_back(std::move(key), value); }
};

}  // namespace octafront
