#pragma once

// soup/tidy: the input as a file has it to a surface that can be meshed, as far as that goes without moving a
// vertex (octafront/repair.h). Takes triangles, leaves a RepairedSurface that knows what was done and which input face
// each of its triangles is. Its steps, in order, are in steps.h.
