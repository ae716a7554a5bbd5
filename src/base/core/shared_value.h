#pragma once

namespace octafront {

/// A value that several threads read and change at a time, each in one step, while what else they do has no order: a
/// std::atomic_ref with relaxed order, which libc++ lacks before its version 19. The value must live as long.
template <class T>
class SharedValue {
 public:
  explicit SharedValue(T& value) : value_(&value) {}

  T load() const {
    T value;
    __atomic_load(value_, &value, __ATOMIC_RELAXED);
    return value;
  }
  void store(T value) const { __atomic_store(value_, &value, __ATOMIC_RELAXED); }
  /// Whether it was `known`, and is `value` now.
  bool exchange_if(T known, T value) const {
    return __atomic_compare_exchange(value_, &known, &value, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
  }
  /// What it was.
  T exchange(T value) const { return __atomic_exchange_n(value_, value, __ATOMIC_RELAXED); }
  void lower_to(T value) const {
    T known = load();
    while (value < known &&
           !__atomic_compare_exchange(value_, &known, &value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
    }
  }

 private:
  T* value_;
};

}  // namespace octafront
