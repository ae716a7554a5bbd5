#pragma once

#include <octafront/ids.h>
#include <octafront/vec.h>

#include "images/nets/net.h"

#include <vector>

namespace octafront::nets {

/// Vertices on opposite faces of the cell of an image that goes on periodically, which are copies of each other.
class Mates {
 public:
  Mates() = default;
  /// Starts of mates become the same, too.
  Mates(const Lattice& lattice, Net& net);

  /// Mates come to where the first one is, each on its own faces.
  void bring_together(const Lattice& lattice, const Net& net, std::vector<Vec3>& x) const;
  /// Adds the mates of those listed; some may be there twice then.
  void add_to(std::vector<VertexIndex>& vertices) const;

 private:
  std::vector<std::vector<VertexIndex>> sets_;
  std::vector<std::uint32_t> set_of_;  ///< per vertex; kNone: it has no mates
};

}  // namespace octafront::nets
