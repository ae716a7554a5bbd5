#pragma once

#include "formats/containers/input.h"

#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace octafront::io {

/// How sure a format is that a file is one of its own. What is told by less counts where none is told by more.
enum class Told {
  kNot,
  kFirstLetter,
  kLines,    ///< some of its lines
  kEnding,   ///< its name alone
  kKeyword,  ///< first words that others might have
  kMagic,
};

/// The beginning of a file, as formats tell theirs by.
struct FileHead {
  explicit FileHead(const Input& file);

  bool ends_in(std::initializer_list<std::string_view> endings) const;
  /// A line of the first ones that begins with a word.
  bool has_line(std::string_view word) const;

  const Input& input;
  std::string_view first, second;  ///< words
  std::string_view kind;           ///< well_known_kind()
  bool is_binary;                  ///< looks_binary()
};

/// Whether a file of that size is binary STL, by its first bytes; the size settles it.
bool is_binary_stl(std::string_view head, std::uint64_t size);

/// "a PNG image" and the like, or empty if it is no well-known kind of file.
std::string_view well_known_kind(std::string_view bytes);

/// True if there is a byte among the first few thousand that no text has.
bool looks_binary(std::string_view bytes);

/// Digits only.
bool is_plain_number(std::string_view word);

}  // namespace octafront::io
