// Deflated Explicit VR Little Endian (PS3.5, A.5): all behind the file's own header is one raw stream of deflate.

#include <octafront/limits.h>

#include "images/files/dicom/elements.h"
#include "images/files/dicom/unpack.h"

#include <algorithm>

#include <fmt/core.h>
#include <zlib.h>

namespace octafront::image {
namespace {

class RawInflate {
 public:
  RawInflate(const io::Input& input, std::size_t at) : input_(input) {
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(input.bytes.data() + at));
    left_ = input.bytes.size() - at;
    if (inflateInit2(&stream_, -MAX_WBITS) != Z_OK) input.fail("cannot be unpacked: zlib does not start");
  }
  ~RawInflate() { inflateEnd(&stream_); }
  RawInflate(const RawInflate&) = delete;
  RawInflate& operator=(const RawInflate&) = delete;

  void append_all(std::string& out) {
    for (int state = Z_OK; state != Z_STREAM_END;) {
      require_memory(2.0 * static_cast<double>(out.size()), fmt::format("{}: unpacking it", input_.name));
      const std::size_t before = out.size(), room = std::max<std::size_t>(before, 1 << 20);
      constexpr std::size_t kMostAtATime = 1 << 30;
      out.resize(before + std::min(room, kMostAtATime));
      stream_.next_out = reinterpret_cast<Bytef*>(out.data() + before);
      stream_.avail_out = static_cast<uInt>(out.size() - before);
      if (stream_.avail_in == 0) feed();
      state = inflate(&stream_, Z_NO_FLUSH);
      out.erase(out.size() - stream_.avail_out);
      const bool is_stuck = out.size() == before && stream_.avail_in == 0 && left_ == 0;
      if ((state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR) || (state != Z_STREAM_END && is_stuck))
        input_.fail("its deflated data are damaged or truncated: copy or export it again");
    }
  }

 private:
  void feed() {
    constexpr std::size_t kMostAtATime = 1 << 30;
    stream_.avail_in = static_cast<uInt>(std::min(left_, kMostAtATime));
    left_ -= stream_.avail_in;
  }

  const io::Input& input_;
  z_stream stream_{};
  std::size_t left_ = 0;
};

}  // namespace

KeptFile inflated(KeptFile file) {
  const std::size_t at = deflated_data_in(file.input.bytes);
  if (at == 0) return file;
  // Without a header of its own, which would name the syntax, elements are told by their looks.
  auto bytes = std::make_shared<std::string>(128, '\0');
  *bytes += "DICM";
  RawInflate(file.input, at).append_all(*bytes);
  io::Input input = file.input;
  input.bytes = *bytes;
  return {input, bytes};
}

}  // namespace octafront::image
