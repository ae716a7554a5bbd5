#include "measure.h"

#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <ShapeAnalysis_ShapeTolerance.hxx>
#include <Standard_Failure.hxx>

namespace octafront::cad {

namespace {

/// Error of volumes and areas, relative. By a fixed number of Gauss points they are off by up to .6 %.
constexpr double kIntegral = 1e-6;

Box3 box_of(const Bnd_Box& box) {
  Box3 out;
  if (box.IsVoid() || box.IsOpen()) return out;
  double x0, y0, z0, x1, y1, z1;
  box.Get(x0, y0, z0, x1, y1, z1);
  out.add(Vec3{x0, y0, z0}), out.add(Vec3{x1, y1, z1});
  return out;
}

}  // namespace

double volume_of(const TopoDS_Shape& solid) {
  GProp_GProps properties;
  try {
    BRepGProp::VolumeProperties(solid, properties, kIntegral);
  } catch (const Standard_Failure&) {
    properties = {};
    BRepGProp::VolumeProperties(solid, properties);
  }
  return properties.Mass();
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
