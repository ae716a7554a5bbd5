#pragma once

// base/mesh: what is true of surfaces and tetrahedral meshes as a whole. Adjacency of triangles and tetrahedra,
// topology of surfaces, what stages ask of the input again and again (known_surface.h), quality, and the laws that
// every mesh keeps before it leaves the library (octafront/validity.h). Takes the flat arrays of the public headers,
// leaves tables of indices that follow the input's order alone. Rooms that change a mesh in place do it by the
// complex of tet_complex.h.
