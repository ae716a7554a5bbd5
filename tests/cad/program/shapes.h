#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

namespace octafront::testing {

/// A shape by name, of a side or diameter of about 10: "box", "cylinder", "cone", "sphere", "torus", "revolved",
/// "extruded", "filleted", "touching", "overlapping", "apart", "within", "nearly", "fitted", "tiny", "three", "groove",
/// "nested faces",
/// "instances", "wrong part", "mostly open", "wing", "thin tube", "rod".
TopoDS_Shape shape_named(const std::string& name);
/// Its volume, by formula; nothing known: 0.
double volume_of_shape(const std::string& name);

/// Writes by the ending: .step (several shapes as an assembly), .igs, .brep, .bin.brep. `unit`: "MM", "INCH".
void write_shape(const TopoDS_Shape& shape, const std::string& file, const std::string& unit = "MM");

}  // namespace octafront::testing
