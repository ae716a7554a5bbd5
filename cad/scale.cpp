#include "measure.h"
#include "steps.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <Precision.hxx>
#include <ShapeFix_ShapeTolerance.hxx>
#include <TopoDS_Compound.hxx>

namespace octafront::cad {

namespace {

/// OpenCASCADE tells points apart that are a ten-millionth of its unit from each other: what is smaller than this,
/// millimetres, has too few of them.
constexpr double kSmall = 0.1;
constexpr double kStep = 1000;

TopoDS_Compound all_of(const Part& part) {
  TopoDS_Compound all;
  BRep_Builder().MakeCompound(all);
  for (const Body& body : part.solids) BRep_Builder().Add(all, body.solid);
  for (const TopoDS_Shape& face : part.loose) BRep_Builder().Add(all, face);
  return all;
}

/// Tolerances that the library took for the least possible grew with the shape, and are less than it says now.
void tighten(const TopoDS_Shape& shape) {
  ShapeFix_ShapeTolerance().SetTolerance(shape, Precision::Confusion());
  BRepLib::SameParameter(shape, Precision::Confusion(), true);
  BRepLib::UpdateTolerances(shape, true);
}

}  // namespace

void scale_up(Part& part) {
  const TopoDS_Compound before = all_of(part);
  const double diagonal = quick_box(before).diagonal();
  if (!(diagonal > 0 && diagonal < kSmall)) return;
  double factor = kStep;
  while (diagonal * factor < kSmall) factor *= kStep;
  gp_Trsf larger;
  larger.SetScaleFactor(factor);
  BRepBuilderAPI_Transform change(larger);
  change.Perform(before, true);
  for (Body& body : part.solids) body.solid = change.ModifiedShape(body.solid);
  for (TopoDS_Shape& face : part.loose) face = change.ModifiedShape(face);
  FaceLabels labels;
  for (FaceLabels::Iterator it(part.face_labels); it.More(); it.Next())
    labels.Bind(change.ModifiedShape(it.Key()), it.Value());
  part.face_labels = labels;
  tighten(change.Shape());
  part.per_millimetre *= factor;
}

}  // namespace octafront::cad
