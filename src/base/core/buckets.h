#pragma once

#include "base/core/parallel.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace octafront {

/// Items by bucket, made by several threads: a counting sort in two passes. Unlike Groups it is meant for some hundred
/// buckets, whose items are then worked on by a thread each.
template <class Item = std::uint32_t>
class Buckets {
 public:
  /// visit(i, add) calls add(bucket, item), bucket < buckets, for each item of i < n. It is called twice for each i and
  /// must do the same both times; in each bucket the items stand in the order of i and of the calls.
  template <class Visit>
  Buckets(std::size_t n, std::size_t buckets, const Visit& visit) : first_(buckets + 1, 0) {
    constexpr std::size_t kMostChunks = 64, kLeastChunk = 4096;
    const std::size_t chunks = std::clamp<std::size_t>(n / kLeastChunk, 1, kMostChunks);
    std::vector<std::vector<std::size_t>> next(chunks, std::vector<std::size_t>(buckets, 0));
    const auto for_each = [&](std::size_t chunk, const auto& add) {
      for (std::size_t i = n * chunk / chunks; i < n * (chunk + 1) / chunks; ++i) visit(i, add);
    };
    parallel_for(chunks, [&](std::size_t c) { for_each(c, [&](std::size_t b, const Item&) { ++next[c][b]; }); });
    std::size_t sum = 0;
    for (std::size_t b = 0; b < buckets; ++b) {
      first_[b] = sum;
      for (auto& of_chunk : next) {
        const std::size_t count = of_chunk[b];
        of_chunk[b] = sum;
        sum += count;
      }
    }
    first_[buckets] = sum;
    items_.resize(sum);
    parallel_for(chunks, [&](std::size_t c) {
      for_each(c, [&](std::size_t b, const Item& item) { items_[next[c][b]++] = item; });
    });
  }

  std::size_t size() const { return first_.size() - 1; }
  std::span<const Item> operator[](std::size_t bucket) const {
    return {items_.data() + first_[bucket], items_.data() + first_[bucket + 1]};
  }
  std::span<Item> operator[](std::size_t bucket) {
    return {items_.data() + first_[bucket], items_.data() + first_[bucket + 1]};
  }
  std::size_t first(std::size_t bucket) const { return first_[bucket]; }
  std::size_t items() const { return items_.size(); }
  /// All items, bucket by bucket; none are left.
  RawVector<Item> release() { return std::move(items_); }

 private:
  std::vector<std::size_t> first_;
  RawVector<Item> items_;
};

/// The numbers 0 ... n - 1 in ranges of one length, a bucket each.
struct RangeBuckets {
  static constexpr int kMostBuckets = 256;
  int shift = 0;
  std::size_t n;

  explicit RangeBuckets(std::size_t numbers) : n(numbers) {
    while (n >> shift > kMostBuckets - 1) ++shift;
  }
  std::size_t count() const { return (n >> shift) + 1; }
  std::size_t of(std::size_t number) const { return number >> shift; }
  std::size_t begin(std::size_t bucket) const { return std::min(n, bucket << shift); }
  std::size_t end(std::size_t bucket) const { return std::min(n, (bucket + 1) << shift); }
};

}  // namespace octafront
