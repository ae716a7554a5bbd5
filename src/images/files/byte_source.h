#pragma once

#include "formats/containers/input.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace octafront::image {

enum class Packing {
  kNone,
  kZlib,    ///< gzip or zlib, told by the first bytes; gzip of several members too
  kDetect,  ///< gzip where the first two bytes say so, else none
};

/// Bytes of a file one after another, unpacked on the way. Believes no count: memory grows with what really comes.
class ByteSource {
 public:
  /// The bytes of `input` from `offset` on, which must not lie behind its end. Refers to `input`.
  ByteSource(const io::Input& input, std::size_t offset, Packing packing);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /// The next `count` bytes, fewer at the end; good until the next call. Throws InputError for a damaged stream.
  std::string_view take(std::uint64_t count);
  /// The next `count` bytes. Throws InputError if there are fewer, with `what` they are.
  std::string_view require(std::uint64_t count, std::string_view what);
  void skip(std::uint64_t count, std::string_view what);
  /// To be called when nothing more is wanted: throws InputError if a packed stream ends here and is not what was
  /// packed, by its checksum.
  void check_end();

  /// No more can come: of a packed stream by what deflate can do.
  std::uint64_t most_bytes_left() const;
  const io::Input& input() const { return input_; }
  bool is_packed() const { return stream_ != nullptr; }
  /// Throws InputError "NAME, byte N [of the unpacked data]: message" at the next byte.
  [[noreturn]] void fail(std::string_view message) const;

 private:
  struct Stream;
  std::size_t unpack(char* to, std::size_t count);
  [[noreturn]] void fail_packed() const;

  const io::Input& input_;
  io::ReadingProgress progress_;
  std::size_t at_;              ///< in the file
  std::uint64_t unpacked_ = 0;  ///< bytes that were handed out
  std::unique_ptr<Stream> stream_;
  std::vector<char> buffer_;
};

/// Whether bytes begin as gzip does.
bool is_gzip(std::string_view bytes);

}  // namespace octafront::image
