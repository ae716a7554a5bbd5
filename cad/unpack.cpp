#include "unpack.h"

#include "part.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>
#include <zlib.h>

namespace octafront::cad {

namespace {

/// Text of CAD files is packed to a fifth or a tenth; what is packed much better is made to fill memory.
constexpr double kMostRatio = 100, kAlwaysTaken = 1 << 26;

double plausible_size(const std::string& file) {
  std::error_code error;
  const auto size = static_cast<double>(std::filesystem::file_size(file, error));
  return error ? kAlwaysTaken : std::max(kAlwaysTaken, kMostRatio * size);
}

/// A file without a name that takes what is unpacked.
class Unpacked {
 public:
  Unpacked(const std::string& file, double most_bytes)
      : file_(file),
        most_bytes_(most_bytes),
        plausible_(plausible_size(file)),
        memory_(memfd_create("octafront-cad", MFD_CLOEXEC)) {
    if (memory_ < 0) throw Refusal(fmt::format("{} cannot be unpacked: {}", file, std::strerror(errno)));
  }

  void add(const char* bytes, std::size_t n) {
    total_ += static_cast<double>(n);
    if (most_bytes_ > 0 && total_ > most_bytes_)
      throw Refusal(fmt::format("{} unpacks to more than the memory that it may take", file_));
    if (total_ > plausible_)
      throw Refusal(
          fmt::format("{} unpacks to more than {:g} times its size, as no CAD file does; if it is meant so, "
                      "unpack it first",
                      file_, kMostRatio));
    while (n > 0) {
      const ssize_t written = write(memory_, bytes, n);
      if (written <= 0) throw Refusal(fmt::format("{} cannot be unpacked: {}", file_, std::strerror(errno)));
      bytes += written, n -= static_cast<std::size_t>(written);
    }
  }

  std::string path() const { return fmt::format("/proc/self/fd/{}", memory_); }
  [[noreturn]] void fail() const {
    throw Refusal(fmt::format("{} is damaged: it cannot be unpacked to its end", file_));
  }

 private:
  const std::string& file_;
  const double most_bytes_, plausible_;
  const int memory_;
  double total_ = 0;
};

using Buffer = std::array<char, 1 << 16>;

void take_gzip(const std::string& file, Unpacked& out) {
  const gzFile in = gzopen(file.c_str(), "rb");
  if (in == nullptr) throw Refusal(fmt::format("{} cannot be opened", file));
  Buffer buffer;
  int n = 0;
  while ((n = gzread(in, buffer.data(), buffer.size())) > 0) out.add(buffer.data(), static_cast<std::size_t>(n));
  const bool whole = n == 0 && gzclose(in) == Z_OK;
  if (!whole) out.fail();
}

/// A zip archive in memory, as PKWARE's APPNOTE describes it. Numbers beyond its end are 0.
class Zip {
 public:
  explicit Zip(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    bytes_.assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }

  /// The compressed bytes of the first file that is no folder; empty if there is none that can be taken.
  std::string_view first(bool& deflated) const {
    for (std::size_t at = directory(); number(at, 4) == kEntry; at += 46 + lengths(at)) {
      const std::size_t size = number(at + 20, 4), method = number(at + 10, 2), local = number(at + 42, 4);
      const bool encrypted = (number(at + 8, 2) & 1) != 0;
      if (size == 0 || encrypted || (method != 0 && method != Z_DEFLATED)) continue;
      const std::size_t begin = local + 30 + number(local + 26, 2) + number(local + 28, 2);
      if (begin + size > bytes_.size()) return {};
      deflated = method == Z_DEFLATED;
      return std::string_view(bytes_).substr(begin, size);
    }
    return {};
  }

 private:
  static constexpr std::size_t kEntry = 0x02014b50;

  std::size_t number(std::size_t at, std::size_t n) const {
    std::size_t value = 0;
    if (at + n > bytes_.size()) return 0;
    for (std::size_t k = n; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes_[at + k]);
    return value;
  }
  std::size_t lengths(std::size_t at) const { return number(at + 28, 2) + number(at + 30, 2) + number(at + 32, 2); }
  /// Where the list of files begins, which the end of the archive says.
  std::size_t directory() const {
    const std::size_t end = bytes_.rfind("PK\x05\x06");
    return end == std::string::npos ? bytes_.size() : number(end + 16, 4);
  }

  std::string bytes_;
};

void take_deflated(std::string_view bytes, Unpacked& out) {
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) out.fail();
  Buffer buffer;
  int status = Z_OK;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  while (status == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
    stream.avail_out = static_cast<uInt>(buffer.size());
    status = inflate(&stream, Z_NO_FLUSH);
    out.add(buffer.data(), buffer.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END) out.fail();
}

void take_zip(const std::string& file, Unpacked& out) {
  const Zip zip(file);
  bool deflated = false;
  const std::string_view bytes = zip.first(deflated);
  if (bytes.empty()) out.fail();
  if (deflated)
    take_deflated(bytes, out);
  else
    out.add(bytes.data(), bytes.size());
}

}  // namespace

std::string unpacked(const std::string& file, double most_bytes) {
  char head[4] = {};
  std::ifstream(file, std::ios::binary).read(head, sizeof head);
  const std::string_view begin(head, sizeof head);
  const bool gzip = begin.starts_with("\x1f\x8b"), zip = begin == "PK\x03\x04";
  if (!gzip && !zip) return file;
  Unpacked out(file, most_bytes);
  if (gzip)
    take_gzip(file, out);
  else
    take_zip(file, out);
  return out.path();
}

}  // namespace octafront::cad
