#pragma once

#include <octafront/options.h>
#include <octafront/surface_mesh.h>

#include "base/mesh/features.h"
#include "sizing/curvature.h"
#include "sizing/feature_sizes.h"
#include "sizing/gaps.h"

#include <vector>

namespace octafront {

/// How many elements a wish for accuracy takes, from the surface alone: known before anything is divided. Each function
/// throws OptionError, with that number, if it is more than a mesh can hold. The floors of our own choosing, below
/// which no size falls, are no excuse: who asks for a billion elements along a curve would wait long for a thousandth
/// of them.
class Affordable {
 public:
  Affordable(const SurfaceMesh& surface, const SizeOptions& options);

  void curvature(double elements, const SurfaceCurvature& of_faces) const;
  void max_deviation(double distance, const SurfaceCurvature& of_faces) const;
  void normal_deviation(double degrees, const SurfaceCurvature& of_faces) const;
  void feature_elements(double elements, const std::vector<FeatureCurve>& curves) const;
  void gap(double elements, const GapFinder& gaps) const;
  /// Elements by these sizes, one for each face.
  double tets_by(const std::vector<double>& face) const;

 private:
  template <class SizeOfFace>
  double tets_on_faces(SizeOfFace&& size_of_face) const;
  double tets_behind(double area, double h) const;
  double tets_around(double length, double h) const;
  void require(const char* wish, double value, double tets) const;

  const SurfaceMesh& surface_;
  std::vector<double> area_;
  double all_area_ = 0, depth_ = 0, gradation_, least_;
};

}  // namespace octafront
