#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::cli {

/// `text` as it may go to a terminal: control characters, which names of files may hold, as \xNN; line ends stay.
std::string printable(std::string_view text);

/// The same with line ends as \n where they belong to one of these words: names must not begin lines of their own.
std::string printable(std::string text, const std::vector<std::string>& words);

/// Of the words of a command line, and the names in them, those with line ends; the longest first.
std::vector<std::string> words_with_line_ends(int argc, const char* const* argv);

/// Text of JSON with control characters as \u00NN where JSON itself lets them be.
std::string printable_json(const std::string& text);

/// `text` as one word of a command line for a POSIX shell.
std::string quoted_for_shell(const std::string& text);

/// The word among `words` that `typed` is a slip of the finger away from, or empty.
std::string nearest_word(std::string_view typed, const std::vector<std::string>& words);

/// As the library wants them: in UTF-8 everywhere.
std::vector<std::string> in_utf8(const std::vector<std::filesystem::path>& files);

/// "1 triangle", "2 triangles".
std::string counted(std::size_t n, const std::string& one);

}  // namespace octafront::cli
