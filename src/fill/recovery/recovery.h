#pragma once

// fill/recovery: a closed surface as it is, filled whatever its triangles look like. Takes a surface, leaves tetrahedra
// whose boundary it is, triangle for triangle (recover.h): a Delaunay tetrahedralisation of its vertices (delaunay.h)
// in which every edge and facet is made by flips (flips.h), else by points on the surface at exact coordinates
// (boundary_recovery.h); what lies outside is taken away (carve.h), and the points on the surface leave it for the
// inside (steiner_lift.h). It knows of no size; refine.h then adds points inside by a size field. docs/how/recovery.md
// says why it ends.
