#include "images/files/byte_source.h"

#include <algorithm>

#include <fmt/core.h>
#include <zlib.h>

namespace octafront::image {

/// zlib's state, and whether the stream has ended.
struct ByteSource::Stream {
  z_stream z{};
  bool ended = false;
};

bool is_gzip(std::string_view bytes) {
  return bytes.starts_with("\x1f\x8b");
}

ByteSource::ByteSource(const io::Input& input, std::size_t offset, Packing packing)
    : input_(input), progress_(input), at_(offset) {
  const bool packed = packing == Packing::kZlib || (packing == Packing::kDetect && is_gzip(input.bytes.substr(offset)));
  if (!packed) return;
  stream_ = std::make_unique<Stream>();
  constexpr int kGzipOrZlib = 15 + 32;
  if (inflateInit2(&stream_->z, kGzipOrZlib) != Z_OK) throw std::bad_alloc();
}

ByteSource::~ByteSource() {
  if (stream_) inflateEnd(&stream_->z);
}

std::string_view ByteSource::take(std::uint64_t count) {
  if (!stream_) {
    const std::string_view bytes = input_.bytes.substr(at_, count);
    at_ += bytes.size();
    unpacked_ += bytes.size();
    progress_.reach(input_.bytes.data() + at_);
    return bytes;
  }
  constexpr std::size_t kStep = std::size_t{1} << 20;
  std::size_t have = 0;
  while (have < count) {
    const std::size_t step = static_cast<std::size_t>(std::min<std::uint64_t>(count - have, std::max(kStep, have)));
    if (buffer_.size() < have + step) buffer_.resize(have + step);
    const std::size_t got = unpack(buffer_.data() + have, step);
    have += got;
    if (got < step) break;
  }
  unpacked_ += have;
  return {buffer_.data(), have};
}

std::string_view ByteSource::require(std::uint64_t count, std::string_view what) {
  const std::string_view bytes = take(count);
  if (bytes.size() < count)
    fail(fmt::format("the file ends here, {} bytes before the end of {}; it is truncated: copy or export it again",
                     count - bytes.size(), what));
  return bytes;
}

void ByteSource::skip(std::uint64_t count, std::string_view what) {
  constexpr std::uint64_t kStep = std::uint64_t{1} << 20;
  if (count > most_bytes_left())
    fail(fmt::format("the file ends before {}; it is truncated: copy or export it again", what));
  for (; count > kStep; count -= kStep) require(kStep, what);
  require(count, what);
}

void ByteSource::check_end() {
  // zlib compares sums when it is asked for more than there is.
  char more = 0;
  if (stream_) unpack(&more, 1);
}

std::size_t ByteSource::unpack(char* to, std::size_t count) {
  z_stream& z = stream_->z;
  std::size_t done = 0;
  while (done < count && !stream_->ended) {
    constexpr std::size_t kMostAtOnce = std::size_t{1} << 20;
    const std::string_view packed = input_.bytes.substr(at_, kMostAtOnce);
    const std::size_t room = std::min(count - done, kMostAtOnce);
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    z.avail_in = static_cast<uInt>(packed.size());
    z.next_out = reinterpret_cast<Bytef*>(to + done);
    z.avail_out = static_cast<uInt>(room);
    const int status = inflate(&z, Z_NO_FLUSH);
    at_ += packed.size() - z.avail_in;
    done += room - z.avail_out;
    progress_.reach(input_.bytes.data() + at_);
    if (status == Z_STREAM_END) {
      // Another member of gzip may follow.
      stream_->ended = !is_gzip(input_.bytes.substr(at_)) || inflateReset(&z) != Z_OK;
    } else if (status != Z_OK && !(status == Z_BUF_ERROR && packed.empty())) {
      fail_packed();
    } else if (packed.empty()) {
      break;  // the stream is cut off
    }
  }
  return done;
}

std::uint64_t ByteSource::most_bytes_left() const {
  const std::uint64_t left = input_.bytes.size() - at_;
  if (!stream_) return left;
  // Deflate makes at most 1032 bytes of one; what zlib holds back is a window of 32 kB.
  constexpr std::uint64_t kMostRatio = 1032, kWindow = std::uint64_t{1} << 16;
  return kMostRatio * left + kWindow;
}

void ByteSource::fail_packed() const {
  input_.fail_at_byte(input_.bytes.data() + at_, "the compressed data are damaged here; copy or export the file again");
}

void ByteSource::fail(std::string_view message) const {
  if (!stream_) input_.fail_at_byte(input_.bytes.data() + at_, message);
  input_.fail(fmt::format("byte {} of the unpacked data: {}", unpacked_, message));
}

}  // namespace octafront::image
