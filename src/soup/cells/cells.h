#pragma once

// soup/cells: what triangles enclose. Takes triangles that meet in shared vertices and edges only, as the arrangement
// leaves them; leaves the cells between them, found by exact signs alone, and, by octafront/complex.h, complexes of
// regions from the walls of one file or from several bodies.
