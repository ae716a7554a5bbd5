#include "shapes.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <GeomAPI_PointsToBSpline.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_SphericalSurface.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace octafront::testing {

namespace {

TopoDS_Shape pair_at(double x) {
  TopoDS_Compound both;
  BRep_Builder().MakeCompound(both);
  BRep_Builder().Add(both, BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 10, 10, 10).Shape());
  BRep_Builder().Add(both, BRepPrimAPI_MakeBox(gp_Pnt(x, 2, 2), 5, 5, 5).Shape());
  return both;
}

/// A plate of 20 x 20 x 4 with a hole of radius 3, and a pin in it that is .02 thicker.
TopoDS_Shape fitted() {
  TopoDS_Compound both;
  BRep_Builder().MakeCompound(both);
  const TopoDS_Shape plate = BRepPrimAPI_MakeBox(gp_Pnt(-10, -10, 0), 20, 20, 4).Shape();
  BRep_Builder().Add(both, BRepAlgoAPI_Cut(plate, BRepPrimAPI_MakeCylinder(3, 4).Shape()).Shape());
  BRep_Builder().Add(both, BRepPrimAPI_MakeCylinder(3.01, 4).Shape());
  return both;
}

/// A box of 1e-4 x 5e-5 x 2e-5 with a hole of radius 1e-5.
TopoDS_Shape tiny() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(100, 50, 20).Shape(),
                     hole = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(50, 25, 0), gp_Dir(0, 0, 1)), 10, 20).Shape();
  gp_Trsf smaller;
  smaller.SetScaleFactor(1e-6);
  return BRepBuilderAPI_Transform(BRepAlgoAPI_Cut(box, hole).Shape(), smaller, true).Shape();
}

/// Boxes of 10 that share each other's halves.
TopoDS_Shape three() {
  TopoDS_Compound all;
  BRep_Builder().MakeCompound(all);
  for (const double x : {0.0, 5.0, 8.0})
    BRep_Builder().Add(all, BRepPrimAPI_MakeBox(gp_Pnt(x, 0, 0), 10, 10, 10).Shape());
  return all;
}

/// A shaft with a groove around it, and a ball that fits in.
TopoDS_Shape ball_in_groove() {
  TopoDS_Compound both;
  BRep_Builder().MakeCompound(both);
  const gp_Ax2 along(gp_Pnt(-63.0449, -33.1238, 0), gp_Dir(0, 1, 0)),
      low(gp_Pnt(-63.0449, -43.1238, 0), gp_Dir(0, 1, 0));
  BRep_Builder().Add(both, BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(low, 8.5, 20).Shape(),
                                           BRepPrimAPI_MakeTorus(along, 9.5, 2).Shape())
                               .Shape());
  const double c = 0.5, s = std::sqrt(0.75);
  BRep_Builder().Add(both, BRepPrimAPI_MakeSphere(gp_Pnt(-63.0449 + 9.5 * c, -33.1238, 9.5 * s), 2).Shape());
  return both;
}

/// The faces of a shape, of no solid and no shell.
TopoDS_Shape faces_of(const TopoDS_Shape& shape) {
  TopoDS_Compound all;
  BRep_Builder().MakeCompound(all);
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) BRep_Builder().Add(all, it.Current());
  return all;
}

/// Boxes of 10, 6 and 2 around one point.
TopoDS_Shape nested() {
  TopoDS_Compound all;
  BRep_Builder().MakeCompound(all);
  for (const double half : {1.0, 5.0, 3.0})
    BRep_Builder().Add(all, BRepPrimAPI_MakeBox(gp_Pnt(-half, -half, -half), gp_Pnt(half, half, half)).Shape());
  return all;
}

/// The faces of a box of 2, and of a box of 10 but one.
TopoDS_Shape mostly_open() {
  TopoDS_Compound all;
  BRep_Builder().MakeCompound(all);
  TopExp_Explorer large(BRepPrimAPI_MakeBox(10, 10, 10).Shape(), TopAbs_FACE);
  for (large.Next(); large.More(); large.Next()) BRep_Builder().Add(all, large.Current());
  for (TopExp_Explorer it(BRepPrimAPI_MakeBox(gp_Pnt(20, 0, 0), 2, 2, 2).Shape(), TopAbs_FACE); it.More(); it.Next())
    BRep_Builder().Add(all, it.Current());
  return all;
}

/// A quarter of a ball of 10 with a bar of 7 x 40 x 10 on it, but for its round face: that is the rest of the sphere.
TopoDS_Shape wrong_part() {
  const TopoDS_Shape right = BRepAlgoAPI_Fuse(BRepPrimAPI_MakeSphere(10, std::numbers::pi / 2).Shape(),
                                              BRepPrimAPI_MakeBox(gp_Pnt(1, -40, -5), 7, 40, 10).Shape())
                                 .Shape();
  BRepBuilderAPI_Sewing sewing;
  for (TopExp_Explorer it(right, TopAbs_FACE); it.More(); it.Next())
    if (BRepAdaptor_Surface(TopoDS::Face(it.Current())).GetType() != GeomAbs_Sphere) sewing.Add(it.Current());
  const Handle(Geom_Surface) sphere = new Geom_SphericalSurface(gp_Ax3(), 10);
  constexpr double kQuarter = std::numbers::pi / 2;
  sewing.Add(BRepBuilderAPI_MakeFace(sphere, kQuarter, 4 * kQuarter, -kQuarter, kQuarter, 1e-7).Face());
  sewing.Perform();
  TopExp_Explorer shell(sewing.SewedShape(), TopAbs_SHELL);
  return BRepBuilderAPI_MakeSolid(TopoDS::Shell(shell.Current())).Shape();
}

/// One box in two places.
TopoDS_Shape instances() {
  TopoDS_Compound both;
  BRep_Builder().MakeCompound(both);
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 10, 10).Shape();
  gp_Trsf beside;
  beside.SetTranslation(gp_Vec(30, 0, 0));
  BRep_Builder().Add(both, box);
  BRep_Builder().Add(both, box.Moved(beside));
  return both;
}

/// A face between a spline over the x axis and that axis.
TopoDS_Face under_spline() {
  TColgp_Array1OfPnt points(1, 5);
  for (int i = 1; i <= 5; ++i) points(i) = gp_Pnt(2.5 * (i - 1), 0, 4 + std::sin(1.3 * i));
  const Handle(Geom_BSplineCurve) spline = GeomAPI_PointsToBSpline(points).Curve();
  const gp_Pnt a(0, 0, 0), b(10, 0, 0);
  return BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(spline).Edge(),
                                                         BRepBuilderAPI_MakeEdge(points(5), b).Edge(),
                                                         BRepBuilderAPI_MakeEdge(b, a).Edge(),
                                                         BRepBuilderAPI_MakeEdge(a, points(1)).Edge())
                                     .Wire())
      .Face();
}

/// A wing of chord 10 and span 4, a NACA 0012 profile that ends in a sharp edge: splines through 41 points each.
TopoDS_Shape wing() {
  const auto side = [](double sign) {
    constexpr int kSteps = 40;
    const Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, kSteps + 1);
    for (int i = 0; i <= kSteps; ++i) {
      const double x = 0.5 * (1 - std::cos(M_PI * i / kSteps));
      const double y = 0.6 * (0.2969 * std::sqrt(x) + x * (-0.126 + x * (-0.3516 + x * (0.2843 - 0.1036 * x))));
      (*points)(i + 1) = gp_Pnt(10 * x, i == kSteps ? 0 : 10 * sign * y, 0);
    }
    GeomAPI_Interpolate through(points, false, 1e-9);
    through.Perform();
    return BRepBuilderAPI_MakeEdge(through.Curve()).Edge();
  };
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(side(1), side(-1)).Wire()).Face(),
                               gp_Vec(0, 0, 4));
}

TopoDS_Shape thin_tube() {
  return BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(5, 10).Shape(), BRepPrimAPI_MakeCylinder(4.98, 10).Shape()).Shape();
}

TopoDS_Shape filleted() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 10, 10).Shape();
  BRepFilletAPI_MakeFillet fillet(box);
  for (TopExp_Explorer it(box, TopAbs_EDGE); it.More(); it.Next()) fillet.Add(2, TopoDS::Edge(it.Current()));
  return fillet.Shape();
}

}  // namespace

TopoDS_Shape shape_named(const std::string& name) {
  if (name == "box") return BRepPrimAPI_MakeBox(10, 10, 10).Shape();
  if (name == "cylinder") return BRepPrimAPI_MakeCylinder(3, 10).Shape();
  if (name == "cone") return BRepPrimAPI_MakeCone(4, 0, 10).Shape();
  if (name == "sphere") return BRepPrimAPI_MakeSphere(5).Shape();
  if (name == "torus") return BRepPrimAPI_MakeTorus(5, 2).Shape();
  if (name == "revolved") return BRepPrimAPI_MakeRevol(under_spline(), gp_Ax1(gp_Pnt(), gp_Dir(1, 0, 0))).Shape();
  if (name == "extruded") return BRepPrimAPI_MakePrism(under_spline(), gp_Vec(0, 8, 0)).Shape();
  if (name == "filleted") return filleted();
  if (name == "touching") return pair_at(10);
  if (name == "overlapping") return pair_at(8);
  if (name == "apart") return pair_at(20);
  if (name == "within") return pair_at(3);
  if (name == "nearly") return pair_at(10 - 1e-6);
  if (name == "fitted") return fitted();
  if (name == "tiny") return tiny();
  if (name == "three") return three();
  if (name == "instances") return instances();
  if (name == "nested faces") return faces_of(nested());
  if (name == "wrong part") return wrong_part();
  if (name == "mostly open") return mostly_open();
  if (name == "wing") return wing();
  if (name == "thin tube") return thin_tube();
  if (name == "rod") return BRepPrimAPI_MakeCylinder(0.15, 10).Shape();
  if (name == "groove") return ball_in_groove();
  throw std::invalid_argument(name);
}

double volume_of_shape(const std::string& name) {
  if (name == "box") return 1000;
  if (name == "cylinder") return 90 * M_PI;
  if (name == "cone") return 160 * M_PI / 3;
  if (name == "sphere") return 500 * M_PI / 3;
  if (name == "torus") return 40 * M_PI * M_PI;
  if (name == "wing") return 480 * (0.2969 * 2 / 3 - 0.126 / 2 - 0.3516 / 3 + 0.2843 / 4 - 0.1036 / 5);
  if (name == "thin tube") return 10 * M_PI * (25 - 4.98 * 4.98);
  if (name == "rod") return 0.225 * M_PI;
  return 0;
}

void write_shape(const TopoDS_Shape& shape, const std::string& file, const std::string& unit) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  if (file.ends_with(".bin.brep")) {
    BinTools::Write(shape, file.c_str());
  } else if (file.ends_with(".brep")) {
    BRepTools::Write(shape, file.c_str());
  } else if (file.ends_with(".igs")) {
    IGESControl_Controller::Init();
    IGESControl_Writer writer(unit.c_str(), 1);
    writer.AddShape(shape);
    writer.Write(file.c_str());
  } else {
    STEPControl_Controller::Init();
    Interface_Static::SetCVal("write.step.unit", unit.c_str());
    Interface_Static::SetIVal("write.step.assembly", 1);
    STEPControl_Writer writer;
    writer.Transfer(shape, STEPControl_AsIs);
    writer.Write(file.c_str());
  }
}

}  // namespace octafront::testing
