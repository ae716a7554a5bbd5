#pragma once

#include <octafront/ids.h>
#include <octafront/options.h>
#include <octafront/run_context.h>
#include <octafront/size_field.h>

#include "base/mesh/known_surface.h"
#include "sizing/field/affordable.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// Per triangle and corner i: the triangle across the edge from corner i to corner (i + 1) % 3; kNone where there is
/// not exactly one other.
using FaceNeighbours = std::vector<std::array<std::uint32_t, 3>>;

/// Edges of `features` count as boundaries: nothing lies across them.
FaceNeighbours smooth_face_neighbours(const EdgeTable& table, const std::vector<Edge>& features);

/// Curvature of the smooth parts of a surface, per triangle; unit 1 / input unit.
struct SurfaceCurvature {
  std::vector<double> largest;  ///< the larger magnitude of the two principal curvatures
  std::vector<double> sum;      ///< their sum, signed: positive where the surface is convex seen from outside
};

/// The curvature tensor of a polyhedron averaged over a ball of a few mean edges about each place, within the part of
/// the surface that can be reached without crossing a feature edge (D. Cohen-Steiner, J.-M. Morvan, "Restricted
/// Delaunay triangulations and normal cycle", 2003). Turning at feature edges does not count. Exact on prisms and
/// cylinders cut into strips; noise of the vertices cancels inside the ball. O(triangles).
SurfaceCurvature surface_curvature(const SurfaceMesh& surface, const FaceNeighbours& across, const RunContext& context);

/// Lowers the size of each face to so many elements per full turn of the surface there, but not below `floor`.
void apply_curvature(const SurfaceCurvature& curvature, double elements, double floor, std::vector<double>& face);
/// Lowers the size of each face until its chords lie no deeper than `error_of(face)`, but not below `floor`.
void apply_chord_errors(const SurfaceCurvature& curvature, const std::function<double(std::size_t face)>& error_of,
                        double floor, std::vector<double>& face);

/// Throws OptionError if options.curvature or options.chord_error would give more elements than a mesh can hold.
void refuse_huge_curvature(const Affordable& affordable, const SizeOptions& options, const SurfaceCurvature& curvature);
/// The same for triangles that turn by no more than so many degrees against the surface.
void refuse_huge_turning(const KnownSurface& surface, const SizeOptions& options, double degrees,
                         const RunContext& context);

/// The volume that a surface made by these sizes loses, by its curvature: chords cut it off.
double predicted_volume_loss(const SurfaceMesh& surface, const SurfaceCurvature& curvature,
                             const std::vector<double>& face);
/// The same as a part of the volume.
double predicted_volume_loss(const KnownSurface& surface, const SizeField& sizes, const RunContext& context);

}  // namespace octafront
