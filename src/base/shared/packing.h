#pragma once

#include "base/shared/comm.h"

#include <cstring>
#include <type_traits>

namespace octafront {

/// Numbers and lists of plain things as bytes, for processes of one program on like machines.
class Packer {
 public:
  template <class T>
  void add(const T& value) requires std::is_trivially_copyable_v<T> {
    append(std::as_bytes(std::span<const T, 1>(&value, 1)));
  }
  template <class T>
  void add(const std::vector<T>& list) requires std::is_trivially_copyable_v<T> {
    add(static_cast<std::uint64_t>(list.size()));
    append(std::as_bytes(std::span(list)));
  }
  void add_text(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    append(std::as_bytes(std::span(text.data(), text.size())));
  }
  Bytes& bytes() { return bytes_; }

 private:
  void append(std::span<const std::byte> more) {
    const std::size_t size = bytes_.size();
    bytes_.resize(size + more.size());
    if (!more.empty()) std::memcpy(bytes_.data() + size, more.data(), more.size());
  }
  Bytes bytes_;
};

/// Gives back in the same order what a Packer took.
class Unpacker {
 public:
  explicit Unpacker(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  T take() requires std::is_trivially_copyable_v<T> {
    T value;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_ = bytes_.subspan(sizeof value);
    return value;
  }
  template <class T>
  void take(std::vector<T>& list) requires std::is_trivially_copyable_v<T> {
    const auto size = static_cast<std::size_t>(take<std::uint64_t>());
    list.resize(size);
    if (size == 0) return;
    std::memcpy(list.data(), bytes_.data(), size * sizeof(T));
    bytes_ = bytes_.subspan(size * sizeof(T));
  }
  std::string take_text() {
    std::vector<char> text;
    take(text);
    return {text.begin(), text.end()};
  }
  bool is_empty() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
};

/// The lists of all ranks in one, that of rank 0 first.
template <class List>
List gathered_lists(const Comm& comm, List mine, std::string_view what) {
  using T = typename List::value_type;
  if (comm.alone()) return mine;
  const auto bytes = std::as_bytes(std::span(mine));
  List all;
  comm.gather({bytes.begin(), bytes.end()}, what).for_each([&](int, std::span<const std::byte> list) {
    const std::size_t first = all.size();
    all.resize(first + list.size() / sizeof(T));
    if (!list.empty()) std::memcpy(all.data() + first, list.data(), list.size());
  });
  return all;
}

}  // namespace octafront
