#include "formats/containers/scanner.h"

#include <algorithm>
#include <limits>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// from_chars says "out of range" of 1e-400 and of 1e400 alike: only the first is a usable number, namely 0.
bool is_tiny(std::string_view digits) {
  const std::size_t e = digits.find_first_of("eE");
  if (e != std::string_view::npos) return digits.size() > e + 1 && digits[e + 1] == '-';
  return digits.find_first_of("123456789.") < digits.size() && digits[digits.find_first_of("123456789.")] == '.';
}

}  // namespace

bool parse_number(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto [stop, error] = double_from_chars(word.data(), end, value);
  if (stop != end || word.empty()) return false;
  if (error == std::errc()) return true;
  if (error != std::errc::result_out_of_range) return false;
  value = is_tiny(word) ? 0 : std::numeric_limits<double>::infinity();
  return true;
}

std::string_view Scanner::rest_of_line() {
  at_line_end();
  const char* const start = at_;
  skip_line();
  const char* stop = at_;
  while (stop != start && is_blank(stop[-1])) --stop;
  return {start, static_cast<std::size_t>(stop - start)};
}

double Scanner::unusual_number(std::string_view what) {
  const std::string_view found = peek_word();
  double value = 0;
  if (!parse_number(found, value)) fail_expected(what);
  if (!std::isfinite(value))
    fail(fmt::format("expected {}, found {}, which is not a finite number; repair the model where it was made", what,
                     in_quotes(found)));
  word();
  return value;
}

std::int64_t Scanner::unusual_integer(std::string_view what) {
  std::string_view found = peek_word();
  if (found.starts_with('+') && !found.starts_with("+-")) {
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(found.data() + 1, found.data() + found.size(), value);
    if (error == std::errc() && stop == found.data() + found.size()) {
      word();
      return value;
    }
  }
  fail_expected(what);
}

void Scanner::fail_expected(std::string_view what) {
  if (at_end())
    fail(fmt::format("expected {}, but the file ends here; it is truncated: copy or export it again", what));
  fail(fmt::format("expected {}, found {}; the file is damaged: export it again", what, in_quotes(peek_word())));
}

std::vector<std::string_view> table_words(std::string_view line) {
  constexpr std::string_view kBetween = " \t,;\r";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kBetween); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.size(), line.find_first_of(kBetween, at));
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBetween, end);
  }
  return words;
}

}  // namespace octafront::io
