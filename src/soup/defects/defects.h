#pragma once

// soup/defects: what keeps a repaired surface from being meshed: open, non-manifold and misoriented edges, faces
// without area, self-intersections, each with ids of input faces and a place (octafront/repair.h). Takes a
// RepairedSurface, leaves SurfaceDefects and the sentences that say them.
