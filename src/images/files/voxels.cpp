#include "images/files/voxels.h"

#include <octafront/limits.h>

#include "base/core/parallel.h"
#include "base/core/wording.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <type_traits>

#include <fmt/core.h>

namespace octafront::image {
namespace {

static_assert(std::endian::native == std::endian::little, "values are copied as they are");

template <class T>
T stored_at(const char* at, bool big_endian) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, at, sizeof(T));
  if (big_endian) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// What all voxels lie between, as real numbers; of those that are finite.
struct Range {
  double least = std::numeric_limits<double>::infinity(), largest = -std::numeric_limits<double>::infinity();
  std::uint64_t not_finite = 0, rounded = 0;
  double off_whole = 0;  ///< the farthest that a value is from a whole number

  Range& operator+=(const Range& b) {
    least = std::min(least, b.least);
    largest = std::max(largest, b.largest);
    not_finite += b.not_finite;
    rounded += b.rounded;
    off_whole = std::max(off_whole, b.off_whole);
    return *this;
  }
  void add(double v) {
    if (!std::isfinite(v)) {
      ++not_finite;
      return;
    }
    least = std::min(least, v);
    largest = std::max(largest, v);
    rounded += static_cast<double>(static_cast<float>(v)) != v;
    off_whole = std::max(off_whole, std::abs(v - std::round(v)));
  }
  template <class T>
  bool fits() const {
    return least >= static_cast<double>(std::numeric_limits<T>::min()) &&
           largest <= static_cast<double>(std::numeric_limits<T>::max());
  }
};

template <class Value, class At>
std::vector<Value> collected(std::size_t n, const At& at) {
  std::vector<Value> values(n);
  parallel_for(n, [&](std::size_t i) { values[i] = static_cast<Value>(at(i)); });
  return values;
}

template <class At>
Range range_of(std::size_t n, const At& at) {
  return parallel_sum(n, [&](std::size_t begin, std::size_t end) {
    Range range;
    for (std::size_t i = begin; i < end; ++i) range.add(static_cast<double>(at(i)));
    return range;
  });
}

template <class At>
Image::Values as_integers(std::size_t n, const At& at, std::vector<std::string>& notes);

/// Whether values are whole numbers but for what scaling and single precision leave: labels. More than one number,
/// since small grey values are all near 0.
bool is_nearly_whole(const Range& range) {
  constexpr double kNearlyWhole = 1e-3;
  return range.not_finite == 0 && range.off_whole > 0 && range.off_whole <= kNearlyWhole &&
         std::round(range.least) != std::round(range.largest);
}

template <class At>
Image::Values as_floats(std::size_t n, const At& at, const Range& range, std::vector<std::string>& notes) {
  if (is_nearly_whole(range)) {
    notes.push_back(fmt::format("values are whole numbers but for {:.2g}: they are rounded", range.off_whole));
    // One type for all: a lambda would make another as_integers() of itself without end.
    const std::function<double(std::size_t)> rounded = [&](std::size_t i) {
      return std::round(static_cast<double>(at(i)));
    };
    return as_integers(n, rounded, notes);
  }
  // Beyond single precision is as good as not finite.
  constexpr double kMost = std::numeric_limits<float>::max();
  const double least = std::clamp(range.least, -kMost, kMost), largest = std::clamp(range.largest, -kMost, kMost);
  if (range.not_finite > 0)
    notes.push_back(
        fmt::format("{} no finite value; not-a-number counts as the least value of the image, infinity as "
                    "the largest",
                    counted(range.not_finite, "voxel has", "voxels have")));
  if (range.rounded > 0)
    notes.push_back(fmt::format("{} rounded to single precision", counted(range.rounded, "value is", "values are")));
  if (range.least > range.largest) return std::vector<float>(n, 0);
  return collected<float>(n, [&](std::size_t i) {
    const auto v = static_cast<double>(at(i));
    return std::isnan(v) ? least : std::clamp(v, least, largest);
  });
}

/// Of whole numbers.
template <class At>
Image::Values as_integers(std::size_t n, const At& at, std::vector<std::string>& notes) {
  const Range range = range_of(n, at);
  if (n == 0 || range.fits<std::uint8_t>()) return collected<std::uint8_t>(n, at);
  if (range.fits<std::int16_t>()) return collected<std::int16_t>(n, at);
  if (range.fits<std::uint16_t>()) return collected<std::uint16_t>(n, at);
  if (range.fits<std::int32_t>()) return collected<std::int32_t>(n, at);
  return as_floats(n, at, range, notes);
}

bool is_whole_of_32_bits(double x) {
  return x == std::floor(x) && std::abs(x) < 0x1p31;
}

template <class T>
Image::Values decoded(std::string_view bytes, const StoredVoxels& stored, std::vector<std::string>& notes) {
  const std::size_t n = bytes.size() / sizeof(T);
  const auto at = [&](std::size_t i) { return stored_at<T>(bytes.data() + i * sizeof(T), stored.big_endian); };
  const bool is_scaled = stored.slope != 1 || stored.intercept != 0;
  const auto scaled = [&](std::size_t i) { return stored.slope * static_cast<double>(at(i)) + stored.intercept; };
  if constexpr (std::is_integral_v<T>) {
    if constexpr (std::is_same_v<T, std::uint8_t> || std::is_same_v<T, std::int16_t> ||
                  std::is_same_v<T, std::uint16_t> || std::is_same_v<T, std::int32_t>) {
      if (!is_scaled) return collected<T>(n, at);
    }
    if (!is_scaled) return as_integers(n, at, notes);
    if (is_whole_of_32_bits(stored.slope) && is_whole_of_32_bits(stored.intercept))
      return as_integers(n, scaled, notes);
  }
  if (!is_scaled) return as_floats(n, at, range_of(n, at), notes);
  Range range = range_of(n, scaled);
  range.rounded = 0;  // who scales values has rounded them before
  return as_floats(n, scaled, range, notes);
}

/// Calls visit(T{}) with the type of number that voxels are stored as.
template <class Visit>
auto with_stored(VoxelType type, const Visit& visit) {
  switch (type) {
    case VoxelType::kInt8:
      return visit(std::int8_t{});
    case VoxelType::kUInt8:
      return visit(std::uint8_t{});
    case VoxelType::kInt16:
      return visit(std::int16_t{});
    case VoxelType::kUInt16:
      return visit(std::uint16_t{});
    case VoxelType::kInt32:
      return visit(std::int32_t{});
    case VoxelType::kUInt32:
      return visit(std::uint32_t{});
    case VoxelType::kInt64:
      return visit(std::int64_t{});
    case VoxelType::kUInt64:
      return visit(std::uint64_t{});
    case VoxelType::kFloat32:
      return visit(float{});
    default:
      return visit(double{});
  }
}

}  // namespace

std::uint64_t bytes_of(VoxelType type) {
  return with_stored(type, [](auto stored) { return sizeof stored; });
}

bool is_integer(VoxelType type) {
  return type != VoxelType::kFloat32 && type != VoxelType::kFloat64;
}

void require_memory_for(const io::Input& input, std::uint64_t voxels, VoxelType type) {
  constexpr double kCopies = 3;  // as they are stored, twice while room for them grows, and as values
  require_memory(kCopies * static_cast<double>(voxels * bytes_of(type)),
                 fmt::format("{}: reading its {} voxels", input.name, voxels));
}

Image::Values values_of(std::string_view bytes, const StoredVoxels& stored, std::vector<std::string>& notes) {
  return with_stored(stored.type, [&](auto as) { return decoded<decltype(as)>(bytes, stored, notes); });
}

Image::Values narrowed(const std::vector<std::int32_t>& values, std::vector<std::string>& notes) {
  const auto at = [&](std::size_t i) { return values[i]; };
  return as_integers(values.size(), at, notes);
}

Image::Values values_of(const std::vector<double>& numbers, VoxelType type, std::vector<std::string>& notes) {
  const auto at = [&](std::size_t i) { return numbers[i]; };
  const bool all_whole =
      is_integer(type) && std::all_of(numbers.begin(), numbers.end(), [](double v) { return v == std::floor(v); });
  if (all_whole) return as_integers(numbers.size(), at, notes);
  return as_floats(numbers.size(), at, range_of(numbers.size(), at), notes);
}

}  // namespace octafront::image
