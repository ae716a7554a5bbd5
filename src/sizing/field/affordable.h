#pragma once

#include <octafront/options.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace octafront {

struct SurfaceMesh;

/// Tetrahedra per cube of the wanted edge length. Measured on uniform sizes of 1/20 and 1/50 of the diagonal over some
/// twenty models: 9.24 with a spread of 3 %. (Space filled by regular tetrahedra would have 6 sqrt(2) = 8.49, the
/// body-centred cubic lattice of that mean edge length has 9.45.)
inline constexpr double kTetsPerCube = 9.24;
/// The one edge length by which a volume has so many elements.
double size_of_elements(double volume, std::int64_t elements);
/// Tetrahedra per square of the wanted edge length on the surface, where a wall has one layer of them: 1.47 for each
/// triangle.
inline constexpr double kTetsPerSquare = 3.4;

/// Throws OptionError, with the number, if `what` gives more elements than a mesh can hold.
void require_affordable(const std::string& what, double tets, const char* advice = "ask for a larger size");

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
  /// Elements behind a part of the surface, of this area, that asks for size h.
  double tets_behind(double area, double h) const;
  /// Elements around a curve that asks for size h.
  double tets_around(double length, double h) const;
  /// Throws OptionError, with the number, if `tets` are more than a mesh can hold: wish `wish` was given as `value`.
  void require(const char* wish, double value, double tets) const;

 private:
  std::vector<double> area_;
  double all_area_ = 0, depth_ = 0, gradation_, least_;
};

}  // namespace octafront
