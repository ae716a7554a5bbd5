#pragma once

// fill/cavity: what the volume front leaves open. A cavity is a closed set of oriented walls inside a mesh under repair
// (work_mesh.h). It can be made larger as a transaction (excavation.h), and be closed by one point of its kernel, found
// by linear programming (kernel_point.h, star.h). Takes tetrahedra and open faces, leaves tetrahedra and fewer open
// faces; the order in which its means are tried is that of fill/front (ladder.h), which adds advancing once
// more.

#include "fill/cavity/excavation.h"
#include "fill/cavity/kernel_point.h"
#include "fill/cavity/star.h"
#include "fill/cavity/work_mesh.h"
