#include "images/files/slice_files.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront::image {
namespace {

/// Moves over lines of a file that is not packed yet.
std::size_t behind_lines(const io::Input& input, std::size_t at, std::uint64_t lines) {
  for (; lines > 0; --lines) {
    const std::size_t end = input.bytes.find('\n', at);
    if (end == std::string_view::npos) input.fail("has fewer lines than its header skips");
    at = end + 1;
  }
  return at;
}

/// Appends the voxels of one file that were picked. `before`: how many voxels earlier files held.
void append_picked(std::string_view bytes, std::uint64_t before, std::uint64_t size, const Picked& picked,
                   std::vector<char>& out) {
  const std::uint64_t voxels = bytes.size() / size;
  // The first picked voxel that is not in an earlier file.
  std::uint64_t n = before > picked.first ? (before - picked.first + picked.stride - 1) / picked.stride : 0;
  for (; n < picked.count; ++n) {
    const std::uint64_t at = picked.first + n * picked.stride - before;
    if (at >= voxels) return;
    const std::uint64_t run = picked.stride == 1 ? std::min(picked.count - n, voxels - at) : 1;
    const char* const from = bytes.data() + at * size;
    out.insert(out.end(), from, from + run * size);
    n += run - 1;
  }
}

void read_share(const io::Input& input, std::size_t offset, const DataFiles& files, std::uint64_t before,
                std::uint64_t voxels, std::uint64_t size, const Picked& picked, std::vector<char>& out) {
  const std::uint64_t bytes = voxels * size;
  std::size_t at = behind_lines(input, offset, files.skipped_lines);
  if (files.at_end) {
    if (bytes > input.bytes.size() - at)
      input.fail(fmt::format("has {} bytes, but its voxels take {}; it is truncated", input.bytes.size(), bytes));
    at = input.bytes.size() - bytes;
  }
  ByteSource source(input, at, files.packing);
  if (files.skipped_bytes > 0) source.skip(files.skipped_bytes, "the voxels");
  if (bytes > source.most_bytes_left())
    source.fail(
        fmt::format("{} voxels take {} bytes, but {} {} can follow; the file is truncated or damaged: copy or "
                    "export it again",
                    voxels, bytes, source.is_packed() ? "at most" : "only", source.most_bytes_left()));
  append_picked(source.require(bytes, "the voxels"), before, size, picked, out);
  source.check_end();
}

}  // namespace

Image::Values read_data_files(const Reading& reading, const DataFiles& files, std::uint64_t total, const Picked& picked,
                              const StoredVoxels& stored, std::vector<std::string>& notes) {
  const std::uint64_t count = files.names.size(), size = bytes_of(stored.type);
  if (count == 0 || total % count != 0)
    reading.input.fail(fmt::format("names {} files for {} voxels, which cannot be equal shares", count, total));
  require_memory_for(reading.input, total, stored.type);
  std::vector<char> bytes;
  for (std::uint64_t f = 0; f < count; ++f) {
    reading.input.context.check();
    const KeptFile file = reading.beside(files.names[f]);
    read_share(file.input, 0, files, f * (total / count), total / count, size, picked, bytes);
  }
  return values_of({bytes.data(), bytes.size()}, stored, notes);
}

Image::Values read_attached(const Reading& reading, std::size_t offset, const DataFiles& how, std::uint64_t total,
                            const Picked& picked, const StoredVoxels& stored, std::vector<std::string>& notes) {
  require_memory_for(reading.input, total, stored.type);
  std::vector<char> bytes;
  read_share(reading.input, offset, how, 0, total, bytes_of(stored.type), picked, bytes);
  return values_of({bytes.data(), bytes.size()}, stored, notes);
}

std::vector<std::string> numbered_names(const io::Input& input, const std::string& pattern, std::int64_t first,
                                        std::int64_t last, std::int64_t step) {
  constexpr std::int64_t kMostFiles = 1 << 20;
  const std::size_t percent = pattern.find('%');
  const std::size_t d = pattern.find('d', percent);
  const bool is_plain = percent != std::string::npos && d != std::string::npos &&
                        pattern.find('%', percent + 1) == std::string::npos &&
                        pattern.find_first_not_of("0123456789", percent + 1) == d && d - percent <= 3;
  if (!is_plain || step == 0 || (last - first) / step < 0 || (last - first) / step >= kMostFiles)
    input.fail(
        fmt::format("names its files by {} from {} to {} in steps of {}; expected a pattern such as %03d and a "
                    "range",
                    io::in_quotes(pattern), first, last, step));
  const std::string digits = pattern.substr(percent + 1, d - percent - 1);
  const std::size_t width = digits.empty() ? 0 : std::stoul(digits);
  const char fill = digits.starts_with('0') ? '0' : ' ';
  std::vector<std::string> names;
  for (std::int64_t n = first; step > 0 ? n <= last : n >= last; n += step) {
    std::string number = std::to_string(n);
    if (number.size() < width) number.insert(0, width - number.size(), fill);
    names.push_back(pattern.substr(0, percent) + number + pattern.substr(d + 1));
  }
  return names;
}

}  // namespace octafront::image
