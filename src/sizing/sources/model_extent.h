#pragma once

namespace octafront {

struct SurfaceMesh;

/// A measure of the model that neither rotation nor triangulation changes: 2 sqrt(3) times the root mean square
/// distance of the surface from its centre of gravity. A sphere's is the diagonal of its bounding box, a rod's is its
/// length.
double model_extent(const SurfaceMesh& surface);
/// The size of elements that nothing speaks against: extent / 30 makes some 20,000 elements of a ball.
double base_size(const SurfaceMesh& surface);

/// The length over the radius of a rod of the same volume and area: 4.5 of a ball.
double slenderness(const SurfaceMesh& surface);
/// Rods twenty times as long as thick, and all that is more slender, have a rule of their own for what chords may cut
/// off; animals and machine parts are far below.
inline constexpr double kSlender = 40;

}  // namespace octafront
