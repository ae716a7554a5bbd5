#pragma once

#include <octafront/vec.h>

#include <Bnd_Box.hxx>
#include <TopoDS_Shape.hxx>

namespace octafront::cad {

/// Of the true geometry, within a millionth: negative if the solid is inside out.
double volume_of(const TopoDS_Shape& solid);
double area_of(const TopoDS_Shape& shape);
double length_of(const TopoDS_Shape& edge);

/// A box around the shape, not the smallest: by poles and vertices.
Box3 quick_box(const TopoDS_Shape& shape);
/// The same, near the smallest.
Box3 close_box(const TopoDS_Shape& shape);

/// The largest tolerance of a shape and all its faces, edges and vertices.
double tolerance_of(const TopoDS_Shape& shape);

}  // namespace octafront::cad
