#include "base/core/parallel.h"
#include "formats/containers/input.h"

#include <cstring>

namespace octafront::io {
namespace {

constexpr std::size_t kMostLineRanges = 1024, kLeastBytesOfRange = std::size_t{1} << 14;

}  // namespace

std::vector<std::string_view> line_ranges(std::string_view text) {
  const std::size_t wanted = std::clamp<std::size_t>(text.size() / kLeastBytesOfRange, 1, kMostLineRanges);
  const std::size_t least = text.size() / wanted;
  std::vector<std::string_view> ranges;
  while (!text.empty()) {
    const std::size_t end = text.size() > least ? text.find('\n', least) : std::string_view::npos;
    const std::size_t size = end == std::string_view::npos ? text.size() : end + 1;
    ranges.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return ranges;
}

bool reads_in_ranges(std::string_view text) {
  return thread_count() > 1 && text.size() > 4 * kLeastBytesOfRange;
}

Input input_of_range(const Input& input, std::string_view range) {
  Input part;
  part.name = input.name;
  part.bytes = range;
  return part;
}

}  // namespace octafront::io
