#pragma once

#include <octafront/octafront_c.h>
#include <octafront/vec.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace octafront::c_api {

/// The numbers of which an element of a list consists.
template <class Element>
struct Layout {
  static constexpr std::uint32_t kType = OCTAFRONT_U32, kColumns = sizeof(Element) / sizeof(std::uint32_t);
};
template <>
struct Layout<Vec3> {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  static constexpr std::uint32_t kType = OCTAFRONT_F64, kColumns = 3;
};
template <>
struct Layout<std::array<Vec3, 3>> {
  static_assert(sizeof(std::array<Vec3, 3>) == 9 * sizeof(double));
  static constexpr std::uint32_t kType = OCTAFRONT_F64, kColumns = 9;
};
template <>
struct Layout<double> {
  static constexpr std::uint32_t kType = OCTAFRONT_F64, kColumns = 1;
};

template <class Element>
octafront_array array_of(const std::vector<Element>& list) {
  return {list.data(), list.size(), Layout<Element>::kColumns, Layout<Element>::kType};
}

template <class Element>
void assign(std::vector<Element>& list, const void* data, std::size_t rows) {
  list.resize(rows);
  if (rows > 0) std::memcpy(list.data(), data, rows * sizeof(Element));
}

}  // namespace octafront::c_api
