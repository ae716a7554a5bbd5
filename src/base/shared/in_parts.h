#pragma once

#include "base/shared/comm.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace octafront {

/// Lists travel so many bytes of a rank at a time: what is on its way is small beside what the ranks hold.
inline constexpr std::size_t kBytesAtATime = std::size_t{1} << 22;

namespace in_parts {

template <class Item>
Bytes bytes_of(std::span<const Item> items) {
  const auto bytes = std::as_bytes(items);
  return {bytes.begin(), bytes.end()};
}

template <class Item>
std::vector<Item> items_of(std::span<const std::byte> bytes) {
  std::vector<Item> items(bytes.size() / sizeof(Item));
  if (!bytes.empty()) std::memcpy(items.data(), bytes.data(), bytes.size());
  return items;
}

/// How many rounds the longest list of any rank takes.
inline std::size_t rounds(const Comm& comm, std::size_t items, std::size_t at_a_time, std::string_view what) {
  std::array<double, 1> most{-static_cast<double>((items + at_a_time - 1) / at_a_time)};
  comm.least(most, what);
  return static_cast<std::size_t>(-most[0]);
}

}  // namespace in_parts

/// visit(rank, part) for parts of the lists of all ranks, those of one rank in their order.
template <class Item, class Visit>
void gather_in_parts(const Comm& comm, const std::vector<Item>& mine, std::string_view what,
                     const Visit& visit) requires std::is_trivially_copyable_v<Item> {
  if (comm.alone()) return visit(0, std::span<const Item>(mine));
  constexpr std::size_t kItems = kBytesAtATime / sizeof(Item);
  const std::size_t rounds = in_parts::rounds(comm, mine.size(), kItems, what);
  for (std::size_t k = 0; k < rounds; ++k) {
    const std::size_t first = std::min(k * kItems, mine.size());
    const auto part = std::span(mine).subspan(first, std::min(kItems, mine.size() - first));
    comm.gather(in_parts::bytes_of(part), what).for_each([&](int rank, std::span<const std::byte> bytes) {
      const std::vector<Item> items = in_parts::items_of<Item>(bytes);
      visit(rank, std::span<const Item>(items));
    });
  }
}

/// visit(rank, part) for parts of what the ranks send here, as above: out[r] goes to rank r.
template <class Item, class Visit>
void exchange_in_parts(const Comm& comm, std::vector<std::vector<Item>> out, std::string_view what,
                       const Visit& visit) requires std::is_trivially_copyable_v<Item> {
  if (comm.alone()) return visit(0, std::span<const Item>(out[0]));
  const std::size_t at_a_time = std::max<std::size_t>(1, kBytesAtATime / sizeof(Item) / out.size());
  std::size_t longest = 0;
  for (const std::vector<Item>& list : out) longest = std::max(longest, list.size());
  const std::size_t rounds = in_parts::rounds(comm, longest, at_a_time, what);
  for (std::size_t k = 0; k < rounds; ++k) {
    std::vector<Bytes> parts;
    for (const std::vector<Item>& list : out) {
      const std::size_t first = std::min(k * at_a_time, list.size());
      parts.push_back(in_parts::bytes_of(std::span(list).subspan(first, std::min(at_a_time, list.size() - first))));
    }
    comm.exchange(std::move(parts), what).for_each([&](int rank, std::span<const std::byte> bytes) {
      const std::vector<Item> items = in_parts::items_of<Item>(bytes);
      visit(rank, std::span<const Item>(items));
    });
  }
}

}  // namespace octafront
