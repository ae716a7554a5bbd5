#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace octafront {

/// Whether the bytes are well-formed UTF-8: no overlong forms, no halves of surrogate pairs, nothing above U+10FFFF.
bool is_utf8(std::string_view bytes);

/// The text of bytes in Latin-1 as UTF-8. Bytes 0x80 to 0x9f, which Latin-1 has no letters for, are read as
/// Windows-1252, as web browsers do.
std::string utf8_of_latin1(std::string_view bytes);

/// Names as every format, JSON and XML can hold them: in UTF-8, where they are not read as Latin-1, with blanks in
/// place of what XML 1.0 forbids, line ends and tabs. Counts what had to change, for a note.
class NameCleaning {
 public:
  void clean(std::string& name);
  void clean(std::vector<std::string>& names);
  /// "2 names were not in UTF-8, ..."; empty if all are as they were.
  std::string note() const;
  /// Adds the note to the list, if there is one.
  void tell(std::vector<std::string>& notes) const;

 private:
  std::size_t from_latin1_ = 0, with_controls_ = 0;
  std::string first_latin1_, first_control_;  ///< as they are now
};

}  // namespace octafront
