#include "formats/parts/msh_stream.h"

#include "formats/parts/surface_builder.h"

#include <cstring>
#include <string>

#include <fmt/core.h>

namespace octafront::io {

std::string_view MshStream::next_section() {
  if (scan_.at_end()) return {};
  const std::string_view name = scan_.peek_word();
  if (!name.starts_with('$') || name.starts_with("$End")) scan_.fail_expected("a section such as \"$Nodes\"");
  scan_.word();
  scan_.skip_line();
  // Binary values begin right behind the line end.
  const char* at = scan_.position();
  const char* const end = input_.bytes.data() + input_.bytes.size();
  if (at != end && *at == '\r') ++at;
  if (at != end && *at == '\n') ++at;
  scan_.set_position(at);
  return name.substr(1);
}

void MshStream::end_section(std::string_view name) {
  const std::string wanted = fmt::format("$End{}", name);
  if (scan_.peek_word() != wanted) scan_.fail_expected(wanted);
  scan_.word();
}

void MshStream::skip_section(std::string_view name) {
  const std::string wanted = fmt::format("$End{}", name);
  const std::size_t from = static_cast<std::size_t>(scan_.position() - input_.bytes.data());
  const std::size_t at = input_.bytes.find(wanted, from);
  if (at == std::string_view::npos)
    scan_.fail(fmt::format("the section ${} does not end; the file is truncated: copy or export it again", name));
  scan_.set_position(input_.bytes.data() + at + wanted.size());
}

template <class T>
T MshStream::get(std::string_view what) {
  if (scan_.bytes_left() < sizeof(T))
    fail(fmt::format("expected {}, but the file ends here; it is truncated: copy or export it again", what));
  progress_.reach(scan_.position());
  T value;
  std::memcpy(&value, scan_.position(), sizeof(T));
  scan_.set_position(scan_.position() + sizeof(T));
  return value;
}

std::int64_t MshStream::int32(std::string_view what) {
  return binary_ ? std::int64_t{get<std::int32_t>(what)} : scan_.integer(what);
}

std::uint64_t MshStream::size(std::string_view what) {
  if (binary_) return get<std::uint64_t>(what);
  const std::int64_t value = scan_.integer(what);
  if (value < 0) fail(fmt::format("expected {}, found {}; the file is damaged: export it again", what, value));
  return static_cast<std::uint64_t>(value);
}

double MshStream::real(std::string_view what) {
  if (!binary_) return scan_.number(what);
  const auto value = get<double>(what);
  if (!std::isfinite(value)) fail(fmt::format("expected {}, found {}, which is not a finite number", what, value));
  return value;
}

void MshStream::skip(std::uint64_t count, std::uint64_t binary_bytes) {
  if (count > scan_.bytes_left() / least_bytes(binary_bytes) + 1)
    fail("expected more values, but the file ends before; it is truncated: copy or export it again");
  if (!binary_) {
    for (; count > 0; --count) scan_.word();
  } else if (count * binary_bytes > scan_.bytes_left()) {
    fail("expected more values, but the file ends before; it is truncated: copy or export it again");
  } else {
    scan_.set_position(scan_.position() + count * binary_bytes);
  }
}

void MshStream::skip_int32(std::uint64_t count) {
  skip(count, 4);
}
void MshStream::skip_size(std::uint64_t count) {
  skip(count, 8);
}
void MshStream::skip_real(std::uint64_t count) {
  skip(count, 8);
}

void MshStream::check_count(std::uint64_t count, std::uint64_t reals, std::uint64_t sizes, std::uint64_t ints,
                            std::string_view what) const {
  const std::uint64_t bytes = binary_ ? 8 * reals + 8 * sizes + 4 * ints : 2 * (reals + sizes + ints);
  check_claim(input_, scan_.position(), {count, bytes, what}, scan_.bytes_left());
}

void MshStream::fail(std::string_view message) const {
  if (binary_) input_.fail_at_byte(scan_.position(), message);
  input_.fail_at_line(scan_.position(), message);
}

void MshStream::skip_line_end() {
  if (!is_binary()) return;
  text().skip_line();
  text().set_position(position() + std::min<std::size_t>(1, text().bytes_left()));
}

}  // namespace octafront::io
