#pragma once

#include <octafront/image_surface.h>

#include "images/nets/lattice.h"

#include <vector>

namespace octafront::nets {

/// The limits of bands, ascending, and which band lies between each two.
class BandLimits {
 public:
  /// Throws InputError for bands that are empty or overlap.
  explicit BandLimits(const std::vector<GreyBand>& bands);

  /// How many limits a value has reached.
  std::size_t rank(double value) const;
  Label label(std::size_t rank) const { return label_[rank]; }
  /// The limit passed between values of two different ranks; of several the middle one.
  double between(std::size_t a, std::size_t b) const;

 private:
  std::vector<double> limits_;
  std::vector<Label> label_;  ///< one more than limits
};

/// The grey values of an image as a function of straight space: linear between the middles of voxels along each axis,
/// constant beyond the outermost ones.
class GreyValues {
 public:
  GreyValues(const Image& image, const Lattice& lattice) : values_(image.values), lattice_(lattice) {}

  double at(Corner voxel) const;

  struct Sample {
    double value;
    Vec3 gradient;
  };
  /// Within the cell of a corner: between the middles of the eight voxels there.
  Sample near(const Corner& corner, Vec3 p) const;

 private:
  const Image::Values& values_;
  const Lattice& lattice_;
};

}  // namespace octafront::nets
