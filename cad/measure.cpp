#include "measure.h"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <ShapeAnalysis_ShapeTolerance.hxx>
#include <Standard_Failure.hxx>
#include <cmath>

namespace octafront::cad {

namespace {

/// Error of volumes and areas, relative. By a fixed number of Gauss points they are off by up to .6 %.
constexpr double kIntegral = 1e-6;

/// Of splines with many knots the adaptive rule may end far too early (2 % of an airfoil): where both rules differ by
/// so much, relative, facets decide, of chords this part of the box deep and turning by so much.
constexpr double kDoubtful = 1e-3, kDeciding = 1e-4, kDecidingAngle = 0.1;

Box3 box_of(const Bnd_Box& box) {
  Box3 out;
  if (box.IsVoid() || box.IsOpen()) return out;
  double x0, y0, z0, x1, y1, z1;
  box.Get(x0, y0, z0, x1, y1, z1);
  out.add(Vec3{x0, y0, z0}), out.add(Vec3{x1, y1, z1});
  return out;
}

double volume_of_facets(const TopoDS_Shape& solid) {
  const TopoDS_Shape copy = BRepBuilderAPI_Copy(solid, true, false);
  BRepMesh_IncrementalMesh(copy, kDeciding * quick_box(solid).diagonal(), false, kDecidingAngle);
  GProp_GProps properties;
  BRepGProp::VolumeProperties(copy, properties, false, false, true);
  return properties.Mass();
}

}  // namespace

double volume_of(const TopoDS_Shape& solid) {
  GProp_GProps fixed, adaptive;
  BRepGProp::VolumeProperties(solid, fixed);
  try {
    BRepGProp::VolumeProperties(solid, adaptive, kIntegral);
  } catch (const Standard_Failure&) {
    return fixed.Mass();
  }
  const double a = adaptive.Mass(), f = fixed.Mass();
  if (std::abs(a - f) <= kDoubtful * std::abs(f)) return a;
  const double facets = volume_of_facets(solid);
  return std::abs(a - facets) < std::abs(f - facets) ? a : f;
}

double area_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  try {
    BRepGProp::SurfaceProperties(shape, properties, kIntegral);
  } catch (const Standard_Failure&) {
    properties = {};
    BRepGProp::SurfaceProperties(shape, properties);
  }
  return properties.Mass();
}

double length_of(const TopoDS_Shape& edge) {
  GProp_GProps properties;
  BRepGProp::LinearProperties(edge, properties);
  return properties.Mass();
}

Box3 quick_box(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  box.SetGap(0);
  return box_of(box);
}

Box3 close_box(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::AddOptimal(shape, box, false, false);
  box.SetGap(0);
  return box_of(box);
}

double tolerance_of(const TopoDS_Shape& shape) {
  ShapeAnalysis_ShapeTolerance analysis;
  return analysis.Tolerance(shape, 1);
}

}  // namespace octafront::cad
