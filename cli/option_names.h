#pragma once

#include <map>
#include <string>
#include <string_view>

namespace octafront::cli {

/// How the fields of Options are called on the command line. The library names fields, in backquotes; users know
/// options.
class OptionNames {
 public:
  void add(const std::string& field, const std::string& option) { option_of_[field] = option; }

  /// `text` with every field in backquotes replaced by its option: "`max_deviation`" becomes "--max-deviation". Fields
  /// that no option sets lose their backquotes.
  std::string translated(std::string_view text) const;

 private:
  std::map<std::string, std::string, std::less<>> option_of_;
};

}  // namespace octafront::cli
