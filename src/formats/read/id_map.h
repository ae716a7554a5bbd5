#pragma once

#include <octafront/ids.h>

#include <cstdint>
#include <unordered_map>

namespace octafront::io {

/// From the numbers that a file gives its items to their places, 0, 1, 2 ... in the order of add(). Numbers that count
/// through cost no memory.
class IdMap {
 public:
  /// False if the number is there already.
  bool add(std::int64_t id) {
    if (count_ == 0) first_ = id;
    if (ids_.empty() && static_cast<std::uint64_t>(id) - static_cast<std::uint64_t>(first_) == count_) {
      ++count_;
      return true;
    }
    if (ids_.empty())
      for (std::uint32_t i = 0; i < count_; ++i) ids_.emplace(first_ + std::int64_t{i}, i);
    return ids_.emplace(id, count_++).second;
  }
  /// kNone if there is none.
  std::uint32_t find(std::int64_t id) const {
    if (!ids_.empty()) {
      const auto found = ids_.find(id);
      return found != ids_.end() ? found->second : kNone;
    }
    return id >= first_ && static_cast<std::uint64_t>(id) - static_cast<std::uint64_t>(first_) < count_
               ? static_cast<std::uint32_t>(id - first_)
               : kNone;
  }
  std::uint32_t size() const { return count_; }

 private:
  std::int64_t first_ = 0;
  std::uint32_t count_ = 0;
  std::unordered_map<std::int64_t, std::uint32_t> ids_;
};

}  // namespace octafront::io
