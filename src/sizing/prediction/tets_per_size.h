#pragma once

namespace octafront {

/// Tetrahedra per cube of the wanted edge length. Measured on uniform sizes of 1/20 and 1/50 of the diagonal over some
/// twenty models: 9.24 with a spread of 3 %. (Space filled by regular tetrahedra would have 6 sqrt(2) = 8.49, the
/// body-centred cubic lattice of that mean edge length has 9.45.)
inline constexpr double kTetsPerCube = 9.24;
/// Tetrahedra per square of the wanted edge length on the surface, where a wall has one layer of them: 1.47 for each
/// triangle.
inline constexpr double kTetsPerSquare = 3.4;

}  // namespace octafront
