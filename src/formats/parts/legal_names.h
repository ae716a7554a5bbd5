#pragma once

#include "formats/parts/mesh_parts.h"

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::io {

/// What a format asks of names.
struct NameRules {
  std::size_t longest = 80;
  std::string_view also = "_-";  ///< characters allowed beside letters and digits
  bool letter_first = true;
  bool upper_case = false;   ///< written in upper case
  bool ignores_case = true;  ///< two names must differ by more than case
  bool one_space = false;    ///< of faces and elements together: CalculiX mixes up a surface and a set of elements
};

/// Names that a format takes, each once, and a note where one had to change.
class LegalNames {
 public:
  explicit LegalNames(NameRules rules) : rules_(rules) {}

  /// The legal name of a part; made unique by a number behind it, where `apart` has it by "_surface".
  std::string legal(std::string_view name, const LegalNames* apart = nullptr);
  /// "names were made legal for the format: ..."; empty if all are as they were.
  std::string note() const;

 private:
  std::string fit(std::string_view name) const;
  std::string with_ending(const std::string& base, std::string_view ending) const;
  bool has(std::string_view name) const { return taken_.contains(key(name)); }
  std::string key(std::string_view name) const;

  NameRules rules_;
  std::set<std::string> taken_;
  std::vector<std::string> changed_;
};

/// Names cut to so many bytes, between letters of UTF-8, where the format takes all else: two that were different stay
/// so.
class ShortNames {
 public:
  explicit ShortNames(std::size_t longest) : longest_(longest) {}
  std::string fitting(const std::string& name);

 private:
  std::size_t longest_;
  std::map<std::string, std::string> known_;  ///< and what they became
  std::set<std::string> taken_;
};

class MeshOutput;

inline constexpr std::array kAllOrigins{Part::Origin::kRegion, Part::Origin::kPatch, Part::Origin::kCurve,
                                        Part::Origin::kSet};

/// A legal name for each part of the mesh that is of these origins (others have none); sets of elements, and all
/// others, each have a space of names of their own. In `one_space` faces called after elements are NAME_surface. What
/// had to change is noted.
std::vector<std::string> legal_names(MeshOutput& out, const MeshParts& mesh, const NameRules& rules,
                                     std::span<const Part::Origin> of = kAllOrigins);

/// Line ends and other control characters become blanks: for comments, and formats that quote names.
std::string one_line(std::string_view name);

}  // namespace octafront::io
