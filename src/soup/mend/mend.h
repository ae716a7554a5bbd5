#pragma once

// soup/mend: soups made clean. Takes any triangles; leaves a surface that encloses what they nearly enclose, and a
// report of all that was changed (octafront/mend.h).
//
//   weld (open edges within the tolerance) -> loops, caps (holes) -> arrangement, cells -> labels (inside, outside)
//     -> separate (what touches in edges and points)

#include <octafront/mend.h>
