// Names of a document as OpenCASCADE makes it of a file.

#include "../../../cad/read.h"

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRep_Builder.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_MaterialTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Trsf.hxx>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront::cad {
namespace {

TopoDS_Shape box(double at) {
  return BRepPrimAPI_MakeBox(gp_Pnt(at, 0, 0), 1, 2, 3).Solid();
}

TopoDS_Shape compound_of(const std::vector<TopoDS_Shape>& parts) {
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (const TopoDS_Shape& part : parts) builder.Add(all, part);
  return all;
}

class NamesOfDocument : public ::testing::Test {
 protected:
  NamesOfDocument() {
    XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document_);
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
  }

  /// A product of several pieces: OpenCASCADE names its components "=>[0:1:1:2]", and the pieces by their kind.
  TDF_Label product(const char* name, const std::vector<TopoDS_Shape>& pieces) {
    const TDF_Label label = shapes_->AddShape(compound_of(pieces), true);
    TDataStd_Name::Set(label, TCollection_ExtendedString(name));
    return label;
  }

  TDF_Label assembly_of(const char* name) {
    const TDF_Label label = shapes_->NewShape();
    TDataStd_Name::Set(label, name);
    return label;
  }

  void place(const TDF_Label& assembly, const TDF_Label& product, const char* name) {
    TDataStd_Name::Set(shapes_->AddComponent(assembly, product, TopLoc_Location()), name);
  }

  std::vector<std::string> names() {
    Part part;
    take_document(document_, {}, part);
    number_names(part);
    std::vector<std::string> all;
    for (const Body& body : part.solids) all.push_back(body.labels.name);
    return all;
  }

  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapes_;
};

TEST_F(NamesOfDocument, PiecesOfAProductHaveItsName) {
  product("PLATE", {box(0), box(2)});
  EXPECT_EQ(names(), (std::vector<std::string>{"PLATE", "PLATE#2"}));
}

TEST_F(NamesOfDocument, AnInstanceWithoutANameHasNotThatOfItsAssembly) {
  const TDF_Label assembly = shapes_->NewShape();
  TDataStd_Name::Set(assembly, "ASSEMBLY");
  const TDF_Label nameless = shapes_->AddShape(box(0), false);
  TDataStd_Name::Set(shapes_->AddComponent(assembly, nameless, TopLoc_Location()), "NAUO1");
  shapes_->UpdateAssemblies();
  EXPECT_EQ(names(), std::vector<std::string>{""});
}

TEST_F(NamesOfDocument, OccurrencesKeepTheirNamesUnlessTheyCountTheProduct) {
  const TDF_Label assembly = assembly_of("ASSEMBLY"), pin = shapes_->AddShape(box(0), false),
                  bolt = shapes_->AddShape(box(5), false);
  TDataStd_Name::Set(pin, "pin"), TDataStd_Name::Set(bolt, "bolt");
  place(assembly, pin, "pin left"), place(assembly, pin, "pin right"), place(assembly, pin, "pin.3");
  place(assembly, bolt, "bolt_1"), place(assembly, bolt, "2");
  shapes_->UpdateAssemblies();
  EXPECT_EQ(names(), (std::vector<std::string>{"pin left", "pin right", "pin", "bolt", "bolt#2"}));
}

TEST_F(NamesOfDocument, OccurrencesHaveTheirProductAndItsMaterial) {
  const TDF_Label assembly = assembly_of("ASSEMBLY"), pin = shapes_->AddShape(box(0), false);
  TDataStd_Name::Set(pin, "pin");
  const auto word = [](const char* text) { return new TCollection_HAsciiString(text); };
  XCAFDoc_DocumentTool::MaterialTool(document_->Main())
      ->SetMaterial(pin, word("steel"), word(""), 7.85, word("density measure"), word("POSITIVE_RATIO_MEASURE"));
  place(assembly, pin, "pin left"), place(assembly, pin, "2");
  shapes_->UpdateAssemblies();
  Part part;
  take_document(document_, {}, part);
  ASSERT_EQ(part.solids.size(), 2u);
  for (const Body& body : part.solids) EXPECT_EQ(body.product + " of " + body.material, "pin of steel");
}

TEST_F(NamesOfDocument, EqualNamesHaveThoseOfTheAssembliesThatTheyOccurIn) {
  const TDF_Label robot = assembly_of("ROBOT"), arm = assembly_of("arm"), pin = shapes_->AddShape(box(0), false),
                  base = shapes_->AddShape(box(5), false);
  TDataStd_Name::Set(pin, "pin"), TDataStd_Name::Set(base, "base");
  place(arm, pin, "1"), place(arm, pin, "top");
  place(robot, arm, "arm left"), place(robot, arm, "arm right"), place(robot, base, "3");
  shapes_->UpdateAssemblies();
  EXPECT_EQ(names(),
            (std::vector<std::string>{"arm left/pin", "arm left/top", "arm right/pin", "arm right/top", "base"}));
}

TEST_F(NamesOfDocument, PiecesWithNamesKeepThem) {
  const TopoDS_Shape named = box(0);
  product("PLATE", {named, box(2)});
  TDF_Label piece;
  ASSERT_TRUE(shapes_->FindShape(named, piece));
  TDataStd_Name::Set(piece, "RIB");
  EXPECT_EQ(names(), (std::vector<std::string>{"RIB", "PLATE"}));
}

}  // namespace
}  // namespace octafront::cad
