#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace octafront {

/// Leaves plain items that nobody gives a value as the memory is: an array that several threads are to fill is not
/// zeroed by one of them first, which would also make that one take its pages from the system.
template <class Item>
struct LeftAsIs : std::allocator<Item> {
  template <class Other>
  struct rebind {
    using other = LeftAsIs<Other>;
  };
  LeftAsIs() = default;
  template <class Other>
  explicit LeftAsIs(const LeftAsIs<Other>&) {}

  template <class Made>
  void construct([[maybe_unused]] Made* at) noexcept(std::is_nothrow_default_constructible_v<Made> ||
                                                     std::is_trivially_copyable_v<Made>) {
    if constexpr (!std::is_trivially_copyable_v<Made>) ::new (static_cast<void*>(at)) Made;
  }
  template <class Made, class... Arguments>
  void construct(Made* at, Arguments&&... arguments) {
    ::new (static_cast<void*>(at)) Made(std::forward<Arguments>(arguments)...);
  }
};

/// A vector whose resize() leaves new items without a value. REQUIRES: each is given one before it is read.
template <class Item>
using RawVector = std::vector<Item, LeftAsIs<Item>>;

}  // namespace octafront
