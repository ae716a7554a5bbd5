#pragma once

namespace octafront {

/// Boxes of faces, coordinate by coordinate. Unused ones have lo > hi: they reach into nothing.
struct BoxBlock {
  static constexpr int kWidth = 16;
  alignas(32) float lo[3][kWidth], hi[3][kWidth];
};

/// A search region in single precision: boxes reach into it that overlap [lo, hi], come as near to `center` as the root
/// of `squared_radius`, and have a corner with normal . x >= behind.
struct CullingRegion {
  float lo[3], hi[3], center[3], normal[3], squared_radius, behind;
};

/// One bit for each box that reaches into the region. All versions do the same operations in the same order and answer
/// alike, so that a mesh does not depend on the processor.
using BoxCulling = unsigned (*)(const BoxBlock&, const CullingRegion&);
unsigned cull_boxes_portable(const BoxBlock& boxes, const CullingRegion& region);
/// The fastest version that this processor runs.
extern const BoxCulling cull_boxes;

}  // namespace octafront
