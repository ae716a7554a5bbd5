#pragma once

#include <octafront/error.h>
#include <octafront/tet_mesh.h>

#include <cstdint>
#include <string>

namespace octafront {

/// Indices are 32 bits wide and kNone is no index. A half-face is four times a tetrahedron and a bit.
inline constexpr std::uint64_t kMostVertices = kNone;
inline constexpr std::uint64_t kMostTets = kNone;
inline constexpr std::uint64_t kMostTetsWithHalfFaces = std::uint64_t{kNone} / 4;
/// What improvement takes: it tells boundary triangles from half-faces by the topmost numbers, and wants room for new
/// elements.
inline constexpr std::uint64_t kMostTetsToImprove = std::uint64_t{1} << 29;

/// What a run may make at most: improvement holds a half-face and one bit more in 32 bits. Asked before work begins, by
/// everything that knows how many elements it will take.
inline constexpr std::int64_t kMostElements = std::int64_t{1} << 29;

/// Throws MeshingError if there are more than fit. `what` is in the plural.
inline void require_in_range(std::uint64_t count, std::uint64_t most, const char* what) {
  if (count > most)
    throw MeshingError("the mesh needs " + std::to_string(count) + " " + what + ", more than the " +
                       std::to_string(most) + " that indices of 32 bits can tell apart: choose a larger element size");
}

}  // namespace octafront
