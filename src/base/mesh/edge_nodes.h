#pragma once

#include <octafront/tet_mesh.h>

#include "base/core/groups.h"

#include <cstdint>

namespace octafront {

/// The mid-side nodes of the edges of boundary faces, interfaces and curves of a second-order mesh, which follow from
/// the tetrahedra at them. O(tets); its memory grows with the edges between vertices of these faces only.
class EdgeNodes {
 public:
  /// Of a linear mesh all nodes are kNone.
  explicit EdgeNodes(const TetMesh& mesh);

  /// kNone if this is no edge between such vertices. About 10 ns.
  VertexIndex operator()(VertexIndex a, VertexIndex b) const;
  /// Those of the edges ab, bc, ca of a triangle.
  Triangle of(const Triangle& t) const { return {(*this)(t[0], t[1]), (*this)(t[1], t[2]), (*this)(t[2], t[0])}; }

 private:
  struct Entry {
    VertexIndex high, node;
  };
  Groups<Entry, std::uint64_t> at_low_;
};

}  // namespace octafront
