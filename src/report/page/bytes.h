#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

/// Bytes of whole numbers that are mostly small; assets/decode.js reads them.
class Bytes {
 public:
  void byte(std::uint8_t value) { all_.push_back(value); }
  /// Seven bits a byte, the lowest first; the eighth says that more follow.
  void number(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) byte(static_cast<std::uint8_t>(value | 0x80));
    byte(static_cast<std::uint8_t>(value));
  }
  /// Small numbers of either sign stay small: 0, -1, 1, -2 become 0, 1, 2, 3.
  void difference(std::int64_t value) {
    number((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
  }
  const std::vector<std::uint8_t>& all() const { return all_; }

 private:
  std::vector<std::uint8_t> all_;
};

/// Compressed by deflate (with zlib's frame), in base64.
std::string packed(const Bytes& bytes);

}  // namespace octafront
