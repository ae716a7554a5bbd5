#pragma once

// formats/size_files: sizes in files. Takes VTU grids, JSON regions and tables of points, leaves a SizeField,
// SizeRegions or PointSizes, and writes a SizeField's octree as VTU. The public face is octafront/io.h.
