#pragma once

#include "formats/containers/input.h"

#include <map>
#include <string>
#include <vector>

namespace octafront::image {

/// A value of a property list in XML: a dictionary, an array, or what stands in any other tag as text ("true" for an
/// empty tag <true/>).
struct Plist {
  std::map<std::string, Plist> dictionary;
  std::vector<Plist> array;
  std::string text;

  /// The value of a key, or an empty one.
  const Plist& at(const std::string& key) const;
};

/// Throws InputError for what is no property list in XML.
Plist parse_plist(const io::Input& input);

}  // namespace octafront::image
