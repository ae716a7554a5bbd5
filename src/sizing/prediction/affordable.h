#pragma once

#include <octafront/options.h>
#include <octafront/surface_mesh.h>

#include <cstddef>
#include <functional>
#include <vector>

namespace octafront {

/// How many elements a wish for accuracy takes, estimated from the surface alone before anything is divided. Sizes are
/// taken to grow at the gradation from where they are asked for, down to the mean depth of the model. A size is raised
/// to `min_size`, but not to floors of our own choosing: who asks for a billion elements along a curve would wait long
/// for a thousandth of them.
class Affordable {
 public:
  using SizeOfFace = std::function<double(std::size_t face)>;

  Affordable(const SurfaceMesh& surface, const SizeOptions& options);

  /// Elements behind all faces, where each face asks for a size; infinity: it asks for none.
  double tets_on_faces(const SizeOfFace& size) const;
  /// The same from some thousand places, spread evenly over the surface, for sizes that take long to find.
  double tets_at_places(const SizeOfFace& size) const;
  /// Elements around a curve that asks for size h.
  double tets_around(double length, double h) const;
  /// Throws OptionError, with the number, if `tets` are more than a mesh can hold: wish `wish` was given as `value`.
  void require(const char* wish, double value, double tets) const;

 private:
  double tets_behind(double area, double h) const;

  std::vector<double> area_;
  double all_area_ = 0, depth_ = 0, gradation_, least_;
};

}  // namespace octafront
