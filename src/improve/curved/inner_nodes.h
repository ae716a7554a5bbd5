#pragma once

#include <octafront/tet_mesh.h>

namespace octafront {
struct RunContext;
}

namespace octafront::curved {

/// Of a mesh of order 3 or 4, moves the nodes behind the corners that lie on no wall: those of elements whose least
/// Jacobian is less than three tenths of the straight one, to where the least one of all elements at the node is
/// greatest, by steps along the axes. No element becomes worse than the worst one at the node was. Some milliseconds an
/// element: of those above kLeastScaledJacobian the worst half percent of the mesh alone. Nodes at elements below
/// `least` stay, so what is above remains so: with kLeastScaledJacobian every element that was valid is.
void raise_worst_elements(TetMesh& mesh, double least, const RunContext& context);

}  // namespace octafront::curved
