#pragma once

// Arguments and reports as JSON.

#include <octafront/complex.h>
#include <octafront/error.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace octafront::c_api {

/// What a key of an object says; nothing if it is missing or null.
template <class Take>
void with(const nlohmann::ordered_json& object, const char* key, const Take& take) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return;
  try {
    take(*found);
  } catch (const nlohmann::ordered_json::exception&) {
    throw OptionError(fmt::format("`{}` is not understood: {}", key, found->dump()));
  }
}

/// The choice that is named; throws OptionError that lists them if there is none of that name.
template <class T>
T one_of(const std::map<std::string, T>& choices, const std::string& name, const char* key) {
  const auto found = choices.find(name);
  if (found != choices.end()) return found->second;
  std::string names;
  for (const auto& [known, choice] : choices) names += (names.empty() ? "" : ", ") + known;
  throw OptionError(fmt::format("`{}` is one of {}; \"{}\" is none of them", key, names, name));
}

/// Names and volumes.
inline nlohmann::ordered_json json_of_regions(const Complex& complex) {
  auto regions = nlohmann::ordered_json::array();
  const std::vector<std::string>& names = complex.surface.region_names;
  for (std::size_t r = 0; r < complex.volumes.size(); ++r)
    regions.push_back({{"name", r < names.size() ? names[r] : ""}, {"volume", complex.volumes[r]}});
  return regions;
}

}  // namespace octafront::c_api
