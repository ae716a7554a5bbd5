#include "compressed.h"

#include <cstdint>
#include <fstream>

#include <zlib.h>

namespace octafront::testing {

namespace {

std::string bytes_of(std::uint64_t value, int n) {
  std::string bytes;
  for (int k = 0; k < n; ++k) bytes += static_cast<char>(value >> (8 * k));
  return bytes;
}

std::string deflated(const std::string& content) {
  z_stream stream{};
  deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, content.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// What both heads of a file in an archive have in common: version, flags, method, time, checksum, sizes, lengths.
std::string head_of(const std::string& content, std::size_t packed, std::size_t name) {
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
  const int method = packed > 0 ? 8 : 0;
  return bytes_of(20, 2) + bytes_of(0, 2) + bytes_of(method, 2) + bytes_of(0, 4) + bytes_of(sum, 4) +
         bytes_of(packed, 4) + bytes_of(content.size(), 4) + bytes_of(name, 2) + bytes_of(0, 2);
}

}  // namespace

void write_gzip(const std::string& content, const std::string& file) {
  const gzFile out = gzopen(file.c_str(), "wb");
  gzwrite(out, content.data(), static_cast<unsigned>(content.size()));
  gzclose(out);
}

void write_zip(const std::string& content, const std::string& name, const std::string& file) {
  const std::string folder = "parts/", path = folder + name, packed = deflated(content);
  const std::string first = "PK\x03\x04" + head_of("", 0, folder.size()) + folder;
  const std::string second = "PK\x03\x04" + head_of(content, packed.size(), path.size()) + path + packed;
  const auto entry = [&](const std::string& head, std::size_t at, const std::string& called) {
    return "PK\x01\x02" + bytes_of(20, 2) + head + bytes_of(0, 10) + bytes_of(at, 4) + called;
  };
  const std::string list = entry(head_of("", 0, folder.size()), 0, folder) +
                           entry(head_of(content, packed.size(), path.size()), first.size(), path);
  std::ofstream(file, std::ios::binary) << first << second << list << "PK\x05\x06" << bytes_of(0, 4) << bytes_of(2, 2)
                                        << bytes_of(2, 2) << bytes_of(list.size(), 4)
                                        << bytes_of(first.size() + second.size(), 4) << bytes_of(0, 2);
}

}  // namespace octafront::testing
