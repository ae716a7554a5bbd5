#pragma once

namespace octafront {

struct SurfaceMesh;

/// A measure of the model that neither rotation nor triangulation changes: 2 sqrt(3) times the root mean square
/// distance of the surface from its centre of gravity. A sphere's is the diagonal of its bounding box, a rod's is its
/// length.
double model_extent(const SurfaceMesh& surface);
/// The size of elements that nothing speaks against: extent / 30 makes some 20,000 elements of a ball.
double base_size(const SurfaceMesh& surface);

}  // namespace octafront
