#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace octafront::io {

/// The bytes of a file and its name, and how to complain about a place in it. Does not own the bytes.
struct Input {
  std::string name;
  std::string_view bytes;

  /// Throws InputError "NAME: message".
  [[noreturn]] void fail(std::string_view message) const;
  /// Throws InputError "NAME, line N: message"; `at` points into `bytes` (or to its end).
  [[noreturn]] void fail_at_line(const char* at, std::string_view message) const;
  /// Throws InputError "NAME, byte N: message".
  [[noreturn]] void fail_at_byte(const char* at, std::string_view message) const;
};

/// A file read whole. Reading is preferred to mapping: a file that shrinks while it is mapped kills the process.
class LoadedFile {
 public:
  /// Throws InputError for a missing file, a directory, a device, an empty file, or one too large for the memory.
  explicit LoadedFile(const std::filesystem::path& file);
  const Input& input() const { return input_; }

 private:
  std::unique_ptr<char[]> bytes_;
  Input input_;
};

/// `text` in quotes for a message: cut to some forty characters, unprintable bytes as \xNN.
std::string in_quotes(std::string_view text);

}  // namespace octafront::io
