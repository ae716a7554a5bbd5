#pragma once

#include <octafront/ids.h>
#include <octafront/run_context.h>
#include <octafront/tet_mesh.h>
#include <octafront/vec.h>

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace octafront {

/// A symmetric 3 x 3 tensor. As a metric it is positive definite, in 1 / (input unit)^2, and asks for elements whose
/// edges e have e^T M e = 1: its eigenvectors are directions, its eigenvalues 1 / h^2 of the lengths h wanted there.
struct Metric {
  double xx = 1, xy = 0, xz = 0, yy = 1, yz = 0, zz = 1;

  static constexpr Metric of_size(double h) { return {1 / (h * h), 0, 0, 1 / (h * h), 0, 1 / (h * h)}; }
  constexpr Vec3 times(Vec3 e) const {
    return {xx * e.x + xy * e.y + xz * e.z, xy * e.x + yy * e.y + yz * e.z, xz * e.x + yz * e.y + zz * e.z};
  }
  /// e^T M e: the squared length of e in this metric.
  constexpr double squared(Vec3 e) const { return dot(e, times(e)); }
  constexpr double determinant() const {
    return xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  }
  friend constexpr bool operator==(const Metric&, const Metric&) = default;
};
constexpr Metric operator+(const Metric& a, const Metric& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}
constexpr Metric operator*(double s, const Metric& a) {
  return {s * a.xx, s * a.xy, s * a.xz, s * a.yy, s * a.yz, s * a.zz};
}

/// A metric on a background mesh of tetrahedra, or of triangles: the logarithms of the tensors are linear in the
/// element that holds a place; elsewhere what the nearest point of the mesh says.
struct MetricMesh {
  std::vector<Vec3> points;         ///< input units
  std::vector<Tet> tets;            ///< indices into `points`
  std::vector<Triangle> triangles;  ///< counted only where there are no tetrahedra
  std::vector<Metric> metrics;      ///< one per point
  std::string name = {};            ///< for messages: the file and its field
};

/// What is done with metrics at the points of a mesh before it is adapted to them. All functions are the same for any
/// number of threads, and throw InputError where the number of metrics or values is not that of mesh.points, or a
/// metric is not positive definite (the first ones, with their places), OptionError for other arguments, Cancelled.
namespace metrics {

/// Bounds of the lengths that a metric asks for, in all directions; input units.
struct Bounds {
  double min_size = 0;
  double max_size = std::numeric_limits<double>::infinity();
};

/// The metric in which the edges of the mesh are 1, as nearly as the elements around each point agree: the mean of the
/// logarithms of those in which all edges of an element are, by volume.
std::vector<Metric> implied(const TetMesh& mesh);

/// The lengths that the mesh has: at each point the mean of the edges there, in all directions.
std::vector<Metric> of_edges(const TetMesh& mesh);

/// The coarsest metric at each place that asks for no longer elements than both, in any of the directions in which both
/// are diagonal (simultaneous reduction). Both have one entry per place.
std::vector<Metric> intersected(std::span<const Metric> a, std::span<const Metric> b);

/// Lengths cut to the bounds, along each eigenvector.
std::vector<Metric> bounded(std::span<const Metric> metrics, const Bounds& bounds);

/// The same metrics made finer until lengths grow by no more than `gradation` for each length of 1 on the way (in (0,
/// 10]; .4: by 40 % from one element to the next), seen along the edges of the mesh: each end of an edge is intersected
/// with what the other one allows there, which gets rounder with distance (F. Alauzet, "Size gradation control of
/// anisotropic meshes", 2010; the mixed space, exponent 1/8). Ends after kMostSweeps at the latest.
std::vector<Metric> graded(const TetMesh& mesh, std::span<const Metric> metrics, double gradation = 0.4,
                           const RunContext& context = {});
inline constexpr int kMostSweeps = 20;

/// The integral of sqrt(det M) over the mesh: the elements that fit a metric are about kElementsPerComplexity times as
/// many.
double complexity(const TetMesh& mesh, std::span<const Metric> metrics);
inline constexpr double kElementsPerComplexity = 10.2;

/// The same metrics, all lengths scaled by one number and cut to the bounds, so that the complexity is this one, as
/// nearly as the bounds allow. `complexity` > 0.
std::vector<Metric> with_complexity(const TetMesh& mesh, std::span<const Metric> metrics, double complexity,
                                    const Bounds& bounds = {});

/// Second derivatives of a field from its values at the points, one tensor (not positive) each: those of the quadratic
/// that fits the values around best, on two rings of neighbours and more at the boundary, so that a quadratic field
/// has its own everywhere.
std::vector<Metric> hessians(const TetMesh& mesh, std::span<const double> values, const RunContext& context = {});

/// How a metric comes from a field.
struct FromField {
  double elements = 0;     ///< how many the mesh is to have, > 0
  double norm = 2;         ///< p >= 1: the error of the linear interpolant is to be least in the norm of L^p
  double gradation = 0.4;  ///< as of graded(); 0: none
  Bounds bounds = {};      ///< of the lengths
};
/// The metric for which the linear interpolant of a field has the least error for this number of elements: the
/// absolute hessian times its determinant to the power -1 / (2 p + 3), scaled (A. Loseille and F. Alauzet, "Continuous
/// mesh framework", 2011), then graded. Where the field is linear the largest elements of the bounds are wanted.
std::vector<Metric> of_field(const TetMesh& mesh, std::span<const double> values, const FromField& options,
                             const RunContext& context = {});

}  // namespace metrics
}  // namespace octafront
