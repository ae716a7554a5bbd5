#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace octafront {

/// A fingerprint of bytes, eight at a time (FNV-1a, and its upper bits brought down at the end): quick, for comparing
/// what processes of one run hold, not for files.
class BytesHash {
 public:
  template <class T>
  void add(const T& value) requires std::is_trivially_copyable_v<T> {
    take(std::as_bytes(std::span<const T, 1>(&value, 1)));
  }
  /// Its length too.
  template <class T>
  void add(const std::vector<T>& list) requires std::is_trivially_copyable_v<T> {
    add(static_cast<std::uint64_t>(list.size()));
    take(std::as_bytes(std::span(list)));
  }
  std::uint64_t value() const { return hash_ ^ hash_ >> 32; }

 private:
  void take(std::span<const std::byte> bytes) {
    for (; !bytes.empty(); bytes = bytes.subspan(std::min(bytes.size(), sizeof(std::uint64_t)))) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data(), std::min(bytes.size(), sizeof word));
      hash_ = (hash_ ^ word) * 0x100000001b3ull;
      hash_ ^= hash_ >> 47;
    }
  }
  std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

}  // namespace octafront
