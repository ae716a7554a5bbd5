#pragma once

// soup/arrangement: triangles that may cross, overlap and lie on each other, to triangles that meet in shared
// vertices and edges only. Takes points and triangles; leaves points of doubles and triangles that know every input
// triangle that they are part of. Exact up to rounding the new points, and the result is exactly free of crossings.
