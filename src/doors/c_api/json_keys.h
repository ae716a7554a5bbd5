#pragma once

// Arguments and reports as JSON.

#include <octafront/domain.h>
#include <octafront/error.h>
#include <octafront/option_table.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>

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

/// The single value of an option. Throws OptionError for anything else.
OptionValue value_of(const std::string& name, const nlohmann::ordered_json& json);

/// What is asked on the way in, by the names of intake_table() and the keys that take more than one value.
IntakeOptions intake_from(const nlohmann::ordered_json& json);

}  // namespace octafront::c_api
