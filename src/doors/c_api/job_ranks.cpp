#include "doors/c_api/job_ranks.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

namespace octafront::c_api {

namespace {

std::size_t sum_of(std::span<const std::size_t> sizes) {
  return std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
}

/// What is left of `size` bytes behind the first ones, `most` of it.
std::size_t part_of(std::size_t size, std::size_t first, std::size_t most) {
  return first < size ? std::min(size - first, most) : 0;
}

}  // namespace

JobRanks::JobRanks(int rank, int size, std::function<void(const octafront_event&)> ask, std::size_t most_bytes)
    : rank_(rank), size_(size), ask_(std::move(ask)), most_bytes_(most_bytes) {}

void JobRanks::say(int kind, const std::byte* out, const std::size_t* out_sizes, std::byte* in,
                   const std::size_t* in_sizes) {
  octafront_event event{};
  event.kind = kind;
  event.out = out, event.out_sizes = out_sizes;
  event.in = in, event.in_sizes = in_sizes;
  ask_(event);
}

void JobRanks::gather(std::span<const std::byte> mine, std::span<const std::size_t> sizes, std::byte* all) {
  if (sum_of(sizes) <= most_bytes_) return say(OCTAFRONT_EVENT_GATHER, mine.data(), nullptr, all, sizes.data());
  // One process after the other, in parts.
  std::vector<std::size_t> part(sizes.size());
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    for (std::size_t first = 0; first < sizes[r]; first += most_bytes_) {
      part[r] = part_of(sizes[r], first, most_bytes_);
      const std::byte* const out = std::cmp_equal(r, rank_) ? mine.data() + first : mine.data();
      say(OCTAFRONT_EVENT_GATHER, out, nullptr, all + first, part.data());
    }
    part[r] = 0;
    all += sizes[r];
  }
}

void JobRanks::exchange(const std::byte* out, std::span<const std::size_t> out_sizes, std::byte* in,
                        std::span<const std::size_t> in_sizes) {
  // All take the same way.
  const std::array<std::size_t, 2> mine{sum_of(out_sizes) + sum_of(in_sizes), std::ranges::max(out_sizes)};
  std::vector<std::array<std::size_t, 2>> of_all(out_sizes.size());
  const std::vector<std::size_t> each(of_all.size(), sizeof mine);
  say(OCTAFRONT_EVENT_GATHER, reinterpret_cast<const std::byte*>(&mine), nullptr,
      reinterpret_cast<std::byte*>(of_all.data()), each.data());
  std::size_t most = 0, longest = 0;
  for (const auto& [together, one] : of_all) most = std::max(most, together), longest = std::max(longest, one);
  if (most <= most_bytes_) return say(OCTAFRONT_EVENT_EXCHANGE, out, out_sizes.data(), in, in_sizes.data());
  exchange_in_parts(out, out_sizes, in, in_sizes, longest);
}

// In each round everyone sends to who is so many places further, and takes from who is so many places before.
void JobRanks::exchange_in_parts(const std::byte* out, std::span<const std::size_t> out_sizes, std::byte* in,
                                 std::span<const std::size_t> in_sizes, std::size_t longest) {
  const std::size_t count = out_sizes.size(), most = std::max<std::size_t>(1, most_bytes_ / 2);
  const auto self = static_cast<std::size_t>(rank_);
  for (std::size_t places = 0; places < count; ++places) {
    const std::size_t to = (self + places) % count, from = (self + count - places) % count;
    const std::byte* const out_of = out + sum_of(out_sizes.first(to));
    std::byte* const in_of = in + sum_of(in_sizes.first(from));
    for (std::size_t first = 0; first < longest; first += most) {
      std::vector<std::size_t> out_part(count), in_part(count);
      out_part[to] = part_of(out_sizes[to], first, most);
      in_part[from] = part_of(in_sizes[from], first, most);
      say(OCTAFRONT_EVENT_EXCHANGE, out_of + std::min(first, out_sizes[to]), out_part.data(),
          in_of + std::min(first, in_sizes[from]), in_part.data());
    }
  }
}

}  // namespace octafront::c_api
