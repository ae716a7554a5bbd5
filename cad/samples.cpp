// Writes samples/bracket.step, samples/assembly.step and samples/bend.step: octafront_cad_samples FOLDER. They say the
// same every time, but for the order of colours, which OpenCASCADE takes from where things lie in memory.

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPConstruct.hxx>
#include <STEPControl_Controller.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <Transfer_FinderProcess.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_LayerTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferWriter.hxx>
#include <XSControl_WorkSession.hxx>
#include <cmath>
#include <cstdio>
#include <gp_Circ.hxx>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace octafront::cad {

namespace {

// Millimetres.
constexpr double kThickness = 6, kWidth = 40, kLeg = 60, kHeight = 50, kInnerRadius = 8;
constexpr double kHoleRadius = 4, kPlateThickness = 8;
constexpr double kHolesAt[2] = {10, 30};  // along the width
constexpr double kHoleOnLeg = 45, kHoleOnWall = 36;

struct Rgb {
  int red, green, blue;
};
constexpr Rgb kSteel{176, 184, 192}, kBlue{64, 120, 192}, kOrange{240, 144, 32}, kRed{208, 48, 48};

Quantity_Color colour_of(const Rgb& c) {
  return {c.red / 255.0, c.green / 255.0, c.blue / 255.0, Quantity_TOC_sRGB};
}

TopoDS_Edge line(double x0, double z0, double x1, double z1) {
  return BRepBuilderAPI_MakeEdge(gp_Pnt(x0, 0, z0), gp_Pnt(x1, 0, z1));
}

/// A quarter of a circle in the plane y = 0, from one point to another about (c, c).
TopoDS_Edge quarter(double c, double radius, gp_Pnt from, gp_Pnt to, bool reversed) {
  const gp_Ax2 axes(gp_Pnt(c, 0, c), gp_Dir(0, reversed ? -1 : 1, 0));
  return BRepBuilderAPI_MakeEdge(gp_Circ(axes, radius), from, to);
}

TopoDS_Shape drilled(const TopoDS_Shape& body, const gp_Ax2& axis, double depth) {
  return BRepAlgoAPI_Cut(body, BRepPrimAPI_MakeCylinder(axis, kHoleRadius, depth).Shape()).Shape();
}

/// A bent plate: legs along x and z, from y = 0 to kWidth.
TopoDS_Shape bent_plate() {
  const double bend = kThickness + kInnerRadius;
  BRepBuilderAPI_MakeWire wire;
  for (const TopoDS_Edge& edge :
       {line(bend, 0, kLeg, 0), line(kLeg, 0, kLeg, kThickness), line(kLeg, kThickness, bend, kThickness),
        quarter(bend, kInnerRadius, gp_Pnt(bend, 0, kThickness), gp_Pnt(kThickness, 0, bend), false),
        line(kThickness, bend, kThickness, kHeight), line(kThickness, kHeight, 0, kHeight), line(0, kHeight, 0, bend),
        quarter(bend, bend, gp_Pnt(0, 0, bend), gp_Pnt(bend, 0, 0), true)})
    wire.Add(edge);
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()), gp_Vec(0, kWidth, 0)).Shape();
}

TopoDS_Shape bracket() {
  TopoDS_Shape body = bent_plate();
  for (const double y : kHolesAt) {
    body = drilled(body, gp_Ax2(gp_Pnt(kHoleOnLeg, y, 0), gp_Dir(0, 0, 1)), kThickness);
    body = drilled(body, gp_Ax2(gp_Pnt(0, y, kHoleOnWall), gp_Dir(1, 0, 0)), kThickness);
  }
  return body;
}

TopoDS_Shape plate() {
  constexpr double kRim = 10;
  TopoDS_Shape body =
      BRepPrimAPI_MakeBox(gp_Pnt(-kRim, -kRim, -kPlateThickness), kLeg + 2 * kRim, kWidth + 2 * kRim, kPlateThickness)
          .Shape();
  for (const double y : kHolesAt)
    body = drilled(body, gp_Ax2(gp_Pnt(kHoleOnLeg, y, -kPlateThickness), gp_Dir(0, 0, 1)), kPlateThickness);
  return body;
}

/// With the seat of its head in z = 0; its shank ends flush with the plate.
TopoDS_Shape bolt() {
  constexpr double kAcrossCorners = 15, kHead = 5;
  constexpr double kShank = kThickness + kPlateThickness;
  BRepBuilderAPI_MakePolygon hexagon;
  for (int k = 0; k < 6; ++k)
    hexagon.Add(gp_Pnt(kAcrossCorners / 2 * std::cos(k * M_PI / 3), kAcrossCorners / 2 * std::sin(k * M_PI / 3), 0));
  hexagon.Close();
  const TopoDS_Shape head = BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(hexagon.Wire()), gp_Vec(0, 0, kHead));
  const gp_Ax2 axis(gp_Pnt(0, 0, -kShank), gp_Dir(0, 0, 1));
  return BRepAlgoAPI_Fuse(head, BRepPrimAPI_MakeCylinder(axis, kHoleRadius, kShank).Shape()).Shape();
}

/// The one solid of a shape.
TopoDS_Shape only_solid(const TopoDS_Shape& shape) {
  return TopExp_Explorer(shape, TopAbs_SOLID).Current();
}

/// The face that goes through a point.
TopoDS_Face face_at(const TopoDS_Shape& shape, const gp_Pnt& p) {
  const TopoDS_Shape vertex = BRepBuilderAPI_MakeVertex(p);
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
    if (BRepExtrema_DistShapeShape(it.Current(), vertex).Value() < 1e-6) return TopoDS::Face(it.Current());
  throw std::logic_error("no face goes through the point");
}

/// A document on its way to a file.
class Document {
 public:
  Document() : document_(new TDocStd_Document("BinXCAF")) {
    XCAFApp_Application::GetApplication()->InitDocument(document_);
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
    colours_ = XCAFDoc_DocumentTool::ColorTool(document_->Main());
    layers_ = XCAFDoc_DocumentTool::LayerTool(document_->Main());
  }

  TDF_Label add(const TopoDS_Shape& shape, const std::string& name, const Rgb& colour) {
    const TDF_Label label = shapes_->AddShape(shape, false);
    TDataStd_Name::Set(label, name.c_str());
    colours_->SetColor(label, colour_of(colour), XCAFDoc_ColorSurf);
    return label;
  }

  TDF_Label add_assembly(const std::string& name) {
    const TDF_Label label = shapes_->NewShape();
    TDataStd_Name::Set(label, name.c_str());
    return label;
  }

  void place(const TDF_Label& assembly, const TDF_Label& product, const gp_Vec& by) {
    gp_Trsf move;
    move.SetTranslation(by);
    shapes_->AddComponent(assembly, product, TopLoc_Location(move));
  }

  void name(const TopoDS_Face& face, const std::string& name) { names_.push_back({face, name}); }
  void paint(const TDF_Label& of, const TopoDS_Face& face, const Rgb& colour) {
    colours_->SetColor(shapes_->AddSubShape(of, face), colour_of(colour), XCAFDoc_ColorSurf);
  }
  void put_on_layer(const TDF_Label& of, const TopoDS_Face& face, const char* layer) {
    layers_->SetLayer(shapes_->AddSubShape(of, face), TCollection_ExtendedString(layer));
  }

  void write(const std::string& file, const std::string& title) {
    shapes_->UpdateAssemblies();
    STEPControl_Controller::Init();
    Interface_Static::SetIVal("write.surfacecurve.mode", 0);
    STEPCAFControl_Writer writer;
    if (!writer.Transfer(document_, STEPControl_AsIs)) throw std::runtime_error("no transfer to " + file);
    name_faces(writer);
    APIHeaderSection_MakeHeader header(writer.ChangeWriter().Model());
    header.SetName(new TCollection_HAsciiString(title.c_str()));
    header.SetTimeStamp(new TCollection_HAsciiString("2026-01-01T00:00:00"));
    if (writer.Write(file.c_str()) != IFSelect_RetDone) throw std::runtime_error(file + " cannot be written");
  }

 private:
  struct Named {
    TopoDS_Face face;
    std::string name;
  };

  void name_faces(STEPCAFControl_Writer& writer) const {
    const auto process = writer.ChangeWriter().WS()->TransferWriter()->FinderProcess();
    for (const Named& n : names_) {
      const Handle(StepRepr_RepresentationItem) item = STEPConstruct::FindEntity(process, n.face);
      if (item.IsNull()) throw std::runtime_error("no entity for the face " + n.name);
      item->SetName(new TCollection_HAsciiString(n.name.c_str()));
    }
  }

  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
  Handle(XCAFDoc_LayerTool) layers_;
  std::vector<Named> names_;
};

/// The bracket with names, colours and a layer of its faces.
TDF_Label add_bracket(Document& document) {
  const TopoDS_Shape body = only_solid(bracket());
  const TDF_Label label = document.add(body, "bracket", kBlue);
  const double middle = kWidth / 2, bend = kThickness + kInnerRadius, off = kInnerRadius / std::sqrt(2);
  const TopoDS_Face seat = face_at(body, gp_Pnt(kHoleOnLeg, middle, 0)),
                    wall = face_at(body, gp_Pnt(0, middle, kHoleOnWall)),
                    fillet = face_at(body, gp_Pnt(bend - off, middle, bend - off));
  document.name(seat, "seat"), document.name(wall, "wall"), document.name(fillet, "fillet");
  document.put_on_layer(label, seat, "mounting"), document.put_on_layer(label, wall, "mounting");
  int number = 0;
  for (const double y : kHolesAt) {
    const TopoDS_Face hole = face_at(body, gp_Pnt(kHoleOnLeg + kHoleRadius, y, kThickness / 2));
    document.name(hole, "bolt hole " + std::to_string(++number));
    document.paint(label, hole, kRed);
  }
  return label;
}

void write_bracket(const std::string& file) {
  Document document;
  add_bracket(document);
  document.write(file, "bracket");
}

void write_assembly(const std::string& file) {
  Document document;
  const TDF_Label all = document.add_assembly("bolted bracket");
  const TopoDS_Shape base = only_solid(plate());
  const TDF_Label base_label = document.add(base, "plate", kSteel);
  document.name(face_at(base, gp_Pnt(0, 0, -kPlateThickness)), "ground");
  const TDF_Label screw = document.add(only_solid(bolt()), "bolt", kOrange);
  document.place(all, base_label, gp_Vec());
  document.place(all, add_bracket(document), gp_Vec());
  for (const double y : kHolesAt) document.place(all, screw, gp_Vec(kHoleOnLeg, y, kThickness));
  document.write(file, "bolted bracket");
}

/// What flows in a pipe: along x, by a quarter of a turn, along z.
void write_bend(const std::string& file) {
  constexpr double kRadius = 10, kTurn = 40, kBefore = 40, kBehind = 80;
  const gp_Ax2 start(gp_Pnt(-kBefore, 0, 0), gp_Dir(1, 0, 0)), end(gp_Pnt(kTurn, 0, kTurn), gp_Dir(0, 0, 1));
  const TopoDS_Edge rim = BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(), gp_Dir(1, 0, 0)), kRadius));
  const TopoDS_Face disc = BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(rim).Wire());
  const TopoDS_Shape turn = BRepPrimAPI_MakeRevol(disc, gp_Ax1(gp_Pnt(0, 0, kTurn), gp_Dir(0, -1, 0)), M_PI / 2);
  TopoDS_Shape pipe = BRepAlgoAPI_Fuse(BRepPrimAPI_MakeCylinder(start, kRadius, kBefore).Shape(), turn).Shape();
  pipe = BRepAlgoAPI_Fuse(pipe, BRepPrimAPI_MakeCylinder(end, kRadius, kBehind).Shape()).Shape();
  const TopoDS_Shape body = only_solid(pipe);
  Document document;
  document.add(body, "water", kBlue);
  const double off = kTurn / std::sqrt(2);
  document.name(face_at(body, gp_Pnt(-kBefore, 0, 0)), "inlet");
  document.name(face_at(body, gp_Pnt(kTurn, 0, kTurn + kBehind)), "outlet");
  for (const gp_Pnt& p : {gp_Pnt(-kBefore / 2, 0, -kRadius), gp_Pnt(off, kRadius, kTurn - off),
                          gp_Pnt(kTurn + kRadius, 0, kTurn + kBehind / 2)})
    document.name(face_at(body, p), "wall");
  document.write(file, "bend");
}

}  // namespace

}  // namespace octafront::cad

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("octafront_cad_samples FOLDER\n", stderr);
    return 2;
  }
  try {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    octafront::cad::write_bracket(std::string(argv[1]) + "/bracket.step");
    octafront::cad::write_assembly(std::string(argv[1]) + "/assembly.step");
    octafront::cad::write_bend(std::string(argv[1]) + "/bend.step");
    return 0;
  } catch (const Standard_Failure& failure) {
    std::cerr << "octafront_cad_samples: " << failure.GetMessageString() << "\n";
  } catch (const std::exception& failure) {
    std::cerr << "octafront_cad_samples: " << failure.what() << "\n";
  }
  return 1;
}
