#pragma once

#include <octafront/vec.h>

#include "base/core/ascii.h"
#include "base/core/doubles.h"
#include "formats/containers/input.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

namespace octafront::io {

/// Reads words and numbers of a text, without locale and without copies. Lines end with LF, CR LF or CR. Errors are
/// InputErrors with the line.
class Scanner {
 public:
  /// With `comment` set, what follows that character at the start of a word counts as blank, up to the end of the line.
  explicit Scanner(const Input& input, char comment = '\0')
      : input_(&input), progress_(input), at_(input.bytes.data()), end_(at_ + input.bytes.size()), comment_(comment) {}

  const char* position() const { return at_; }
  void set_position(const char* at) { at_ = at; }
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

  /// True if nothing but blanks (and comments) is left; moves to the next word otherwise.
  bool at_end() {
    skip_blanks();
    return at_ == end_;
  }
  /// As at_end(), for this line.
  bool at_line_end() {
    while (at_ != end_ && is_blank(*at_) && !is_line_end(*at_)) ++at_;
    return at_ == end_ || is_line_end(*at_) || (comment_ != '\0' && *at_ == comment_);
  }
  /// The next word, empty at the end of the text.
  std::string_view word() {
    skip_blanks();
    const char* const start = at_;
    while (at_ != end_ && !is_blank(*at_)) ++at_;
    return {start, static_cast<std::size_t>(at_ - start)};
  }
  std::string_view peek_word() {
    skip_blanks();
    const char* const start = at_;
    const std::string_view w = word();
    at_ = start;
    return w;
  }
  /// What is left of this line, without its end and without blanks around it.
  std::string_view rest_of_line();
  /// Moves to the end of this line (the next word is then the first of the next line).
  void skip_line() {
    while (at_ != end_ && !is_line_end(*at_)) ++at_;
  }
  /// Behind it: what binary values begin with is passed over by neither.
  void skip_line_end() {
    if (at_ != end_ && *at_ == '\r') ++at_;
    if (at_ != end_ && *at_ == '\n') ++at_;
  }

  /// A finite number; `what` completes the sentence "expected ...".
  double number(std::string_view what) {
    skip_blanks();
    double value = 0;
    const auto [stop, error] = double_from_chars(at_, end_, value);
    if (error == std::errc() && (stop == end_ || is_blank(*stop)) && std::isfinite(value)) [[likely]] {
      at_ = stop;
      return value;
    }
    return unusual_number(what);
  }
  /// Three of them.
  Vec3 point(std::string_view what = "a coordinate") {
    const double x = number(what), y = number(what), z = number(what);
    return {x, y, z};
  }
  std::int64_t integer(std::string_view what) {
    skip_blanks();
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(at_, end_, value);
    if (error == std::errc() && (stop == end_ || is_blank(*stop))) [[likely]] {
      at_ = stop;
      return value;
    }
    return unusual_integer(what);
  }

  /// Throws InputError at the line of the next word: "expected WHAT, found THAT".
  [[noreturn]] void fail_expected(std::string_view what);
  [[noreturn]] void fail(std::string_view message) const { input_->fail_at_line(at_, message); }

 private:
  void skip_blanks() {
    progress_.reach(at_);
    for (;;) {
      while (at_ != end_ && is_blank(*at_)) ++at_;
      if (comment_ == '\0' || at_ == end_ || *at_ != comment_) return;
      skip_line();
    }
  }
  double unusual_number(std::string_view what);
  std::int64_t unusual_integer(std::string_view what);

  const Input* input_;
  ReadingProgress progress_;
  const char* at_;
  const char* end_;
  char comment_;
};

/// A word as a number: a sign of either kind, infinities and not-a-number allowed; true on success.
bool parse_number(std::string_view word, double& value);

/// The words of a line of a table, by commas, semicolons or blanks.
std::vector<std::string_view> table_words(std::string_view line);

}  // namespace octafront::io
