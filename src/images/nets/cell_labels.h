#pragma once

#include <octafront/image_surface.h>

#include "images/nets/lattice.h"
#include "images/nets/net.h"
#include "images/nets/net_steps.h"

#include <vector>

namespace octafront::nets {

/// The labels of an image; of one that goes on periodically the voxels around the cell have labels of their own, so
/// that there are faces all around it, which the net does as it does others.
class CellLabels {
 public:
  /// Throws InputError for too many labels.
  CellLabels(const ImageGrid& grid, const std::vector<Label>& labels, std::size_t count, const PeriodicMargin& margin);
  CellLabels(const CellLabels&) = delete;
  CellLabels& operator=(const CellLabels&) = delete;

  const Lattice& lattice() const { return lattice_; }
  /// Of labels, those around the cell too.
  std::size_t count() const { return lattice_.is_periodic() ? 2 * count_ : count_; }
  /// What is around the cell is as large as it is in the cell, and may have any volume.
  void forget_margin(LabelSizes& sizes) const;
  /// Faces of the cell bound nothing any more on their other side, and what is around it goes.
  void cut_out_cell(Net& net) const;

 private:
  const std::size_t count_;
  std::vector<Label> around_;
  const Lattice lattice_;
};

}  // namespace octafront::nets
