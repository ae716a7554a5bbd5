#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace octafront {

/// How a FlatMap treats its keys: `kEmpty` is no key, the upper bits of hash(key) spread well.
template <class Key>
struct FlatKeys;

template <>
struct FlatKeys<std::uint64_t> {
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
  static constexpr std::uint64_t hash(std::uint64_t key) { return key * 0x9e3779b97f4a7c15u; }
};

template <>
struct FlatKeys<std::uint32_t> {
  static constexpr std::uint32_t kEmpty = ~std::uint32_t{0};
  static constexpr std::uint64_t hash(std::uint32_t key) { return key * 0x9e3779b97f4a7c15u; }
};

/// Edges and faces by their vertices, in ascending order.
template <>
struct FlatKeys<std::array<std::uint32_t, 2>> {
  static constexpr std::array<std::uint32_t, 2> kEmpty{~std::uint32_t{0}, ~std::uint32_t{0}};
  static constexpr std::uint64_t hash(const std::array<std::uint32_t, 2>& key) {
    return (std::uint64_t{key[0]} << 32 | key[1]) * 0x9e3779b97f4a7c15u;
  }
};
template <>
struct FlatKeys<std::array<std::uint32_t, 3>> {
  static constexpr std::array<std::uint32_t, 3> kEmpty{~std::uint32_t{0}, ~std::uint32_t{0}, ~std::uint32_t{0}};
  static constexpr std::uint64_t hash(const std::array<std::uint32_t, 3>& key) {
    return key[0] * 0x9e3779b97f4a7c15u + key[1] * 0xc2b2ae3d27d4eb4fu + key[2] * 0xd6e8feb86659fd93u;
  }
};

/// a == b; of vertices without a call.
template <class Key>
constexpr bool is_same_key(const Key& a, const Key& b) {
  return a == b;
}
constexpr bool is_same_key(const std::array<std::uint32_t, 2>& a, const std::array<std::uint32_t, 2>& b) {
  return a[0] == b[0] && a[1] == b[1];
}
constexpr bool is_same_key(const std::array<std::uint32_t, 3>& a, const std::array<std::uint32_t, 3>& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/// A hash map in one array: open addressing with linear steps, at most half full. Its order is seen by for_each()
/// alone, so it cannot change a result. References stay valid until the next find_or_add(), erase(), reserve() or
/// reset().
template <class Key, class Value, class Keys = FlatKeys<Key>>
class FlatMap {
 public:
  /// Makes room for `expected` keys.
  explicit FlatMap(std::size_t expected = 0) { reset(expected); }

  std::size_t size() const { return size_; }
  /// The value of the key, or nullptr.
  const Value* find(const Key& key) const {
    const Slot& slot = slots_[place(key)];
    return is_same_key(slot.key, key) ? &slot.value : nullptr;
  }
  Value* find(const Key& key) {
    Slot& slot = slots_[place(key)];
    return is_same_key(slot.key, key) ? &slot.value : nullptr;
  }
  bool contains(const Key& key) const { return find(key) != nullptr; }
  /// The value of the key, `initial` if it is new.
  Value& find_or_add(const Key& key, const Value& initial = {}) {
    std::size_t at = place(key);
    if (!is_same_key(slots_[at].key, key)) {
      if (2 * (size_ + 1) > slots_.size()) {
        rehash(2 * slots_.size());
        at = place(key);
      }
      ++size_;
      slots_[at] = {key, initial};
    }
    return slots_[at].value;
  }
  /// False if there is no such key.
  bool erase(const Key& key) {
    std::size_t hole = place(key);
    if (slots_[hole].key != key) return false;
    --size_;
    // Later entries of the run move up where the hole would cut them off from the place that they belong to.
    for (std::size_t i = next(hole); !is_same_key(slots_[i].key, Keys::kEmpty); i = next(i)) {
      const std::size_t home = home_of(slots_[i].key);
      if (((i - home) & (slots_.size() - 1)) < ((i - hole) & (slots_.size() - 1))) continue;
      slots_[hole] = slots_[i];
      hole = i;
    }
    slots_[hole].key = Keys::kEmpty;
    return true;
  }

  /// Calls visit(key, value) for all, in an order that tells of nothing: whoever shows what comes of it sorts it.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const Slot& s : slots_)
      if (!is_same_key(s.key, Keys::kEmpty)) visit(s.key, s.value);
  }

  /// Makes room for `expected` keys in all.
  void reserve(std::size_t expected) {
    if (slots_.size() < 2 * expected) rehash(std::bit_ceil(2 * expected));
  }
  /// Takes all keys out and makes room for `expected`, at the cost of that many: for maps that are used again and
  /// again.
  void reset(std::size_t expected) { clear_to(std::bit_ceil(std::max(kLeastSlots, 2 * expected))); }

 private:
  struct Slot {
    Key key = Keys::kEmpty;
    [[no_unique_address]] Value value{};
  };
  static constexpr std::size_t kLeastSlots = 16;

  void clear_to(std::size_t slots) {
    slots_.assign(slots, Slot{});
    shift_ = 64 - std::countr_zero(slots);
    size_ = 0;
  }
  void rehash(std::size_t slots) {
    std::vector<Slot> old(slots);
    old.swap(slots_);
    shift_ = 64 - std::countr_zero(slots);
    for (const Slot& s : old)
      if (!is_same_key(s.key, Keys::kEmpty)) slots_[place(s.key)] = s;
  }
  std::size_t next(std::size_t i) const { return (i + 1) & (slots_.size() - 1); }
  std::size_t home_of(const Key& key) const { return static_cast<std::size_t>(Keys::hash(key) >> shift_); }
  /// Where the key is, or where it would be put.
  std::size_t place(const Key& key) const {
    std::size_t i = home_of(key);
    while (!is_same_key(slots_[i].key, key) && !is_same_key(slots_[i].key, Keys::kEmpty)) i = next(i);
    return i;
  }

  std::vector<Slot> slots_;  ///< a power of two of them
  int shift_ = 0;            ///< the place of a key is its hash shifted by this
  std::size_t size_ = 0;
};

/// A FlatMap without values.
template <class Key, class Keys = FlatKeys<Key>>
class FlatSet {
 public:
  explicit FlatSet(std::size_t expected = 0) : map_(expected) {}

  std::size_t size() const { return map_.size(); }
  bool contains(const Key& key) const { return map_.contains(key); }
  /// False if it was there already.
  bool insert(const Key& key) {
    const std::size_t before = map_.size();
    map_.find_or_add(key);
    return map_.size() > before;
  }
  bool erase(const Key& key) { return map_.erase(key); }
  void reserve(std::size_t expected) { map_.reserve(expected); }
  void reset(std::size_t expected) { map_.reset(expected); }

 private:
  struct Nothing {};
  FlatMap<Key, Nothing, Keys> map_;
};

}  // namespace octafront
