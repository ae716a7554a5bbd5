#pragma once

// fill/lattice: the graded body-centred cubic lattice, and the part of it that lies deep inside a surface. Takes a
// surface and sizes, leaves the core of the mesh and its skin, from which the volume front fills the shell out to the
// surface.
