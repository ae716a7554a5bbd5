#pragma once

#include <octafront/run_context.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::io {

// formats/containers: what many formats are made of: bytes of a file and complaints about places in them (input.h),
// words and numbers of a text (scanner.h), XML, HDF5, netCDF; files written beside and renamed into place
// (atomic_file.h).

/// The bytes of a file and its name, and how to complain about a place in it. Does not own the bytes.
struct Input {
  std::string name;
  std::string_view bytes;
  RunContext context = {};
  /// The name of a field of numbers that is read along with a mesh, into RawMesh::field; empty: of the only one there
  /// is; null: none is.
  const std::string* field = nullptr;
  /// Fields of tensors at points are asked for: of 6 or 9 numbers; of single numbers those that are named.
  bool wants_tensors = false;
  /// Of a field that is asked for by its name also elements may have several numbers.
  bool wants_element_tensors = false;

  /// Throws InputError "NAME: message".
  [[noreturn]] void fail(std::string_view message) const;
  /// Throws InputError "NAME, line N: message"; `at` points into `bytes` (or to its end).
  [[noreturn]] void fail_at_line(const char* at, std::string_view message) const;
  /// Throws InputError "NAME, byte N: message".
  [[noreturn]] void fail_at_byte(const char* at, std::string_view message) const;
};

/// Asks every few milliseconds of reading whether to go on, and tells how far it is.
class ReadingProgress {
 public:
  explicit ReadingProgress(const Input& input) : ReadingProgress(input, input.bytes.data()) {}
  /// From a place on.
  ReadingProgress(const Input& input, const char* at) : input_(&input) { set_next(at); }
  /// To be told of every place that is reached.
  void reach(const char* at) {
    if (at >= next_) [[unlikely]]
      tell(at);
  }

 private:
  void set_next(const char* at) {
    constexpr std::ptrdiff_t kStride = std::ptrdiff_t{1} << 18;
    next_ = at + std::min(kStride, input_->bytes.data() + input_->bytes.size() - at);
  }
  /// Throws Cancelled.
  void tell(const char* at);

  const Input* input_;
  const char* next_;
};

/// A file read whole. Reading is preferred to mapping: a file that shrinks while it is mapped kills the process.
class LoadedFile {
 public:
  /// Throws InputError for a missing file, a directory, a device, an empty file, or one too large for the memory;
  /// Cancelled, also while a pipe has nothing to read.
  explicit LoadedFile(const std::filesystem::path& file, const RunContext& context = {});
  const Input& input() const { return input_; }

 private:
  std::unique_ptr<char[]> bytes_;
  Input input_;
};

/// `text` in quotes for a message: cut to some forty characters, unprintable bytes as \xNN.
std::string in_quotes(std::string_view text);
/// The names, each in quotes, with commas between them.
std::string names_in_quotes(std::span<const std::string> names);

/// A text in ranges of whole lines, in their order, each for a thread of its own. Lines that end with CR alone are not
/// told apart: they are all in one range.
///
/// Readers go through ranges as far as a text is as nearly all are. Where it is not, or anything is wrong with it, they
/// read it once more from its begin to its end: who reads all knows the line, and says what has always been said.
std::vector<std::string_view> line_ranges(std::string_view text);

/// Whether it is worth it: several threads, and a text of some size.
bool reads_in_ranges(std::string_view text);

/// A range of the lines of an input as one by itself: it shows no progress and never ends the run.
Input input_of_range(const Input& input, std::string_view range);

}  // namespace octafront::io
