#pragma once

#include "base/core/buckets.h"
#include "base/core/parallel_arrays.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace octafront {

/// The items of each owner, side by side in one array: the triangles at each vertex, the leaves at each corner. Made by
/// a counting sort, in two passes over the items and no other memory than the result's. An `Offset` counts all items.
template <class Item = std::uint32_t, class Offset = std::uint32_t>
class Groups {
 public:
  Groups() : first_(1, 0) {}

  /// visit(add) calls add(owner, item) for every item, owner < owners. It is called twice and must visit the same both
  /// times; in each group the items stand in the order of the visits.
  template <class Visit>
  Groups(std::size_t owners, const Visit& visit) : first_(owners + 2, Offset{0}) {
    // Counts stand two places ahead: after the sums place owner + 1 is the cursor of the owner, at the end its end.
    visit([this](std::size_t owner, const Item&) { ++first_[owner + 2]; });
    for (std::size_t i = 2; i < first_.size(); ++i) first_[i] += first_[i - 1];
    items_.resize(first_.back());
    visit([this](std::size_t owner, const Item& item) { items_[first_[owner + 1]++] = item; });
    first_.pop_back();
  }

  /// Those of an owner begin at first[owner]; first[owners] is the end.
  Groups(RawVector<Offset> first, RawVector<Item> items) : first_(std::move(first)), items_(std::move(items)) {}

  std::size_t size() const { return first_.size() - 1; }
  /// The items of one owner.
  std::span<const Item> operator[](std::size_t owner) const {
    return {items_.data() + first_[owner], items_.data() + first_[owner + 1]};
  }
  std::span<Item> operator[](std::size_t owner) {
    return {items_.data() + first_[owner], items_.data() + first_[owner + 1]};
  }
  /// All items, owner by owner; those of an owner begin at first(owner), those of the last one end at first(size()).
  std::span<const Item> items() const { return items_; }
  Offset first(std::size_t owner) const { return first_[owner]; }

 private:
  RawVector<Offset> first_;
  RawVector<Item> items_;
};

/// An item that is in no group.
inline constexpr std::uint32_t kNoOwner = 0xffffffffu;

/// The same as group_by_owner: a counting sort of stretches of the numbers, each of which counts apart. Those of
/// no owner are counted as those of one more, and put one over the other.
template <class OwnerOf>
Groups<> group_in_stretches(std::size_t owners, std::uint32_t items, const OwnerOf& owner_of, std::size_t stretches) {
  constexpr std::size_t kApart = 16;  // numbers of a cache line: no thread waits for another's
  const auto nobody = static_cast<std::uint32_t>(owners);
  std::vector<std::vector<std::uint32_t>> next(stretches);
  // visit(i, its owner, the numbers of the stretch)
  const auto for_each = [&](const auto& visit) {
    const auto begin = [&](std::size_t s) { return static_cast<std::uint32_t>(std::uint64_t{items} * s / stretches); };
    const auto visit_stretch = [&, nobody](std::size_t s) {
      std::uint32_t* of_stretch = next[s].data();
      for (std::uint32_t i = begin(s), end = begin(s + 1); i < end; ++i)
        visit(i, std::min<std::uint32_t>(owner_of(i), nobody), of_stretch);
    };
    parallel_for(stretches, visit_stretch, Split::kSingly);
  };
  parallel_for(
      stretches, [&](std::size_t s) { next[s].resize(owners + 1); }, Split::kSingly);
  for_each([](std::uint32_t, std::uint32_t owner, std::uint32_t* count) { ++count[owner]; });
  RawVector<std::uint32_t> first(owners + 1);
  const auto count = [&](std::size_t begin, std::size_t end) {
    std::size_t sum = 0;
    for (const auto& of_stretch : next)
      for (std::size_t o = begin; o < end; ++o) sum += of_stretch[o];
    return sum;
  };
  const std::size_t sum = number_in_blocks(owners, count, [&](std::size_t begin, std::size_t end, std::size_t from) {
    auto number = static_cast<std::uint32_t>(from);
    for (std::size_t o = begin; o < end; ++o) {
      first[o] = number;
      for (auto& of_stretch : next) number += std::exchange(of_stretch[o], number);
    }
    return number;
  });
  first[owners] = static_cast<std::uint32_t>(sum);
  RawVector<std::uint32_t> grouped(sum + kApart * stretches);
  for (std::size_t s = 0; s < stretches; ++s) next[s][owners] = static_cast<std::uint32_t>(sum + kApart * s);
  for_each([nobody, to = grouped.data()](std::uint32_t i, std::uint32_t owner, std::uint32_t* at) {
    to[at[owner]] = i;
    at[owner] += owner != nobody;
  });
  grouped.resize(sum);
  return {std::move(first), std::move(grouped)};
}

/// The numbers 0 ... items - 1 by owner_of(number), ascending in each group, without those of kNoOwner. By several
/// threads: in stretches of the numbers if there are enough of them to make up for counting in each; else first into
/// ranges of owners, then range by range. One thread is faster without, and without a branch where some have no owner:
/// they are counted as those of one owner more, and put one over the other.
template <class OwnerOf>
Groups<> group_by_owner(std::size_t owners, std::uint32_t items, const OwnerOf& owner_of) {
  constexpr std::uint32_t kFewItems = 4096;
  if (thread_count() == 1 || items < kFewItems) {
    const auto nobody = static_cast<std::uint32_t>(owners);
    RawVector<std::uint32_t> first(owners + 1, 0);
    for (std::uint32_t i = 0; i < items; ++i) ++first[std::min<std::uint32_t>(owner_of(i), nobody)];
    std::uint32_t sum = 0;
    for (std::size_t o = 0; o < owners; ++o) sum += std::exchange(first[o], sum);
    first[owners] = sum;
    RawVector<std::uint32_t> next = first, grouped(sum + std::size_t{1});
    for (std::uint32_t i = 0; i < items; ++i) {
      const std::uint32_t owner = std::min<std::uint32_t>(owner_of(i), nobody);
      grouped[next[owner]] = i;
      next[owner] += owner != nobody;
    }
    grouped.pop_back();
    return {std::move(first), std::move(grouped)};
  }
  if (const std::size_t threads = thread_count(); 2 * threads * owners <= items)
    return group_in_stretches(owners, items, owner_of,
                              std::clamp<std::size_t>(items / (2 * owners + 1), threads, 4 * threads));
  const RangeBuckets ranges(owners);
  Buckets<> by_range(items, ranges.count(), [&](std::size_t i, const auto& add) {
    const std::uint32_t owner = owner_of(static_cast<std::uint32_t>(i));
    if (owner != kNoOwner) add(ranges.of(owner), static_cast<std::uint32_t>(i));
  });
  RawVector<std::uint32_t> first(owners + 1);
  first[owners] = static_cast<std::uint32_t>(by_range.items());
  parallel_for(ranges.count(), [&](std::size_t r) {
    const std::size_t begin = ranges.begin(r);
    const Groups<> in_range(ranges.end(r) - begin, [&](const auto& add) {
      for (const std::uint32_t i : by_range[r]) add(owner_of(i) - begin, i);
    });
    const std::size_t before = by_range.first(r);
    for (std::size_t k = 0; k < in_range.size(); ++k)
      first[begin + k] = static_cast<std::uint32_t>(before + in_range.first(k));
    std::copy(in_range.items().begin(), in_range.items().end(), by_range[r].begin());
  });
  return {std::move(first), by_range.release()};
}

/// The rows (triangles, tets, edges) at each of the vertices that they name, ascending for each vertex.
template <class Rows>
Groups<> rows_at_vertices(std::size_t vertices, const Rows& rows) {
  return {vertices, [&](const auto& add) {
            for (std::uint32_t i = 0; i < rows.size(); ++i)
              for (const std::uint32_t v : rows[i]) add(v, i);
          }};
}

}  // namespace octafront
