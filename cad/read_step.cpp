#include "densities.h"
#include "pipe.h"
#include "read.h"
#include "text.h"

#include <Interface_Check.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <Interface_Protocol.hxx>
#include <Interface_ReportEntity.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPConstruct_UnitContext.hxx>
#include <STEPControl_Controller.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_RepresentationContext.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepRepr_ShapeRepresentationRelationship.hxx>
#include <StepShape_ContextDependentShapeRepresentation.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_ManifoldSolidBrep.hxx>
#include <StepShape_ShapeDefinitionRepresentation.hxx>
#include <StepShape_ShapeRepresentation.hxx>
#include <StepShape_ShellBasedSurfaceModel.hxx>
#include <StepShape_SolidModel.hxx>
#include <StepShape_TopologicalRepresentationItem.hxx>
#include <StepVisual_HArray1OfLayeredItem.hxx>
#include <StepVisual_LayeredItem.hxx>
#include <StepVisual_PresentationLayerAssignment.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TColStd_MapOfTransient.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

std::string text_of(const Handle(TCollection_HAsciiString) & text) {
  return text.IsNull() ? std::string() : to_utf8(text->ToCString());
}

/// "#123 (ADVANCED_FACE)".
std::string entity_in_words(const StepData_StepModel& model, const Handle(Standard_Transient) & entity) {
  return fmt::format("{} ({})", text_of(model.StringLabel(entity)), model.TypeName(entity, false));
}

/// Values that stand among the items of a representation: numbers, measures, texts.
bool is_value(const Handle(Standard_Transient) & entity) {
  return entity->IsKind(STANDARD_TYPE(StepRepr_RepresentationItem)) &&
         !entity->IsKind(STANDARD_TYPE(StepGeom_GeometricRepresentationItem)) &&
         !entity->IsKind(STANDARD_TYPE(StepShape_TopologicalRepresentationItem)) &&
         !entity->IsKind(STANDARD_TYPE(StepRepr_MappedItem));
}

/// What says how shapes look, or what is known of them.
bool describes_shapes(const Handle(Standard_Transient) & entity) {
  const std::string_view type = entity->DynamicType()->Name();
  return is_value(entity) || type.starts_with("StepVisual_") || type.starts_with("StepDimTol_") ||
         type.starts_with("StepRepr_Property") || type == "StepRepr_Representation";
}

/// The entities that shapes and their places are made of: all that hangs on those of the file that shapes begin with.
class ShapeEntities {
 public:
  ShapeEntities(const StepData_StepModel& model, const Interface_Graph& graph) : graph_(graph) {
    for (int i = 1; i <= model.NbEntities(); ++i)
      if (begins_shapes(model.Value(i))) reach(model.Value(i));
  }

  bool contains(const Handle(Standard_Transient) & entity) const { return found_.Contains(entity); }

 private:
  static bool begins_shapes(const Handle(Standard_Transient) & entity) {
    for (const Handle(Standard_Type) & type :
         {STANDARD_TYPE(StepShape_ShapeRepresentation), STANDARD_TYPE(StepShape_ShapeDefinitionRepresentation),
          STANDARD_TYPE(StepShape_ContextDependentShapeRepresentation), STANDARD_TYPE(StepShape_SolidModel),
          STANDARD_TYPE(StepShape_TopologicalRepresentationItem), STANDARD_TYPE(StepRepr_NextAssemblyUsageOccurrence),
          STANDARD_TYPE(StepRepr_ShapeRepresentationRelationship), STANDARD_TYPE(StepShape_ShellBasedSurfaceModel)})
      if (entity->IsKind(type)) return true;
    return false;
  }

  void reach(const Handle(Standard_Transient) & first) {
    std::vector<Handle(Standard_Transient)> next{first};
    while (!next.empty()) {
      const Handle(Standard_Transient) entity = next.back();
      next.pop_back();
      if (describes_shapes(entity) || !found_.Add(entity)) continue;
      for (Interface_EntityIterator it = graph_.Shareds(entity); it.More(); it.Next()) next.push_back(it.Value());
    }
  }

  const Interface_Graph& graph_;
  TColStd_MapOfTransient found_;
};

/// A name that is none does no harm, nor do texts and the like among the items of a shape, which the library does not
/// know: what is missing is said otherwise.
bool is_harmless(const std::string& complaint) {
  const auto has = [&](const char* words) { return complaint.find(words) != std::string::npos; };
  return has("not a quoted String") || (has("(representation_item)") && has("illegal type"));
}

/// What the reader complained of.
struct Complaints {
  std::vector<std::string> of_shapes, of_others;
};

Complaints complaints(const Handle(StepData_StepModel) & of, const Handle(Interface_Protocol) & protocol) {
  const StepData_StepModel& model = *of;
  Complaints all;
  std::optional<Interface_Graph> graph;  // made where there is a complaint
  std::optional<ShapeEntities> shapes;
  const Handle(Interface_Check)& whole = model.GlobalCheck();
  for (int i = 1; !whole.IsNull() && i <= whole->NbFails(); ++i) all.of_shapes.push_back(to_utf8(whole->CFail(i)));
  for (int i = 1; i <= model.NbEntities(); ++i) {
    if (!model.IsReportEntity(i)) continue;
    const Handle(Interface_Check)& check = model.ReportEntity(i)->Check();
    if (check->NbFails() > 0 && !shapes) shapes.emplace(model, graph.emplace(of, protocol));
    for (int k = 1; k <= check->NbFails(); ++k) {
      const std::string text = to_utf8(check->CFail(k));
      (shapes->contains(model.Value(i)) && !is_harmless(text) ? all.of_shapes : all.of_others)
          .push_back(entity_in_words(model, model.Value(i)) + ": " + text);
    }
  }
  return all;
}

std::string first_of(const std::vector<std::string>& sentences) {
  if (sentences.empty()) return "";
  std::string first = sentences[0];
  // How the library's parser begins.
  for (const std::string_view noise : {"**** ERR StepFile : ", "Undefined Parsing: "})
    if (first.starts_with(noise)) first.erase(0, noise.size());
  return sentences.size() == 1 ? first : fmt::format("{} (and {} more)", first, sentences.size() - 1);
}

Handle(StepRepr_GlobalUnitAssignedContext) units_of(const Handle(StepRepr_RepresentationContext) & context) {
  if (const auto both = Handle(StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext)::DownCast(context);
      !both.IsNull())
    return both->GlobalUnitAssignedContext();
  if (const auto all = Handle(StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx)::DownCast(context);
      !all.IsNull())
    return all->GlobalUnitAssignedContext();
  return Handle(StepRepr_GlobalUnitAssignedContext)::DownCast(context);
}

/// How many millimetres the unit of length is of the first shape whose context says so; 0: none does.
double millimetres_of_unit(const StepData_StepModel& model) {
  for (int i = 1; i <= model.NbEntities(); ++i) {
    const auto representation = Handle(StepShape_ShapeRepresentation)::DownCast(model.Value(i));
    if (representation.IsNull()) continue;
    const Handle(StepRepr_GlobalUnitAssignedContext) units = units_of(representation->ContextOfItems());
    STEPConstruct_UnitContext factors;
    if (units.IsNull() || factors.ComputeFactors(units) != 0 || !factors.LengthDone()) continue;
    return factors.LengthFactor();
  }
  return 0;
}

void read_units(STEPControl_Reader& reader, Part& part) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  std::set<std::string> different;
  for (const TCollection_AsciiString& length : lengths) {
    std::string name = to_utf8(length.ToCString());
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    if (!different.insert(name).second) continue;
    part.unit += (part.unit.empty() ? "" : ", ") + name;
  }
  if (different.size() > 1)
    part.notes.push_back(
        fmt::format("the file has parts in several units ({}): each came to millimetres by its own", part.unit));
  if (const double millimetres = millimetres_of_unit(*reader.StepModel()); millimetres > 0)
    part.to_millimetres = millimetres;
}

void add_layer(const TopoDS_Shape& shape, const std::string& layer, LabelsOfShapes& said) {
  for (const TopAbs_ShapeEnum type : {TopAbs_SOLID, TopAbs_FACE}) {
    bool any = false;
    for (TopExp_Explorer it(shape, type); it.More(); it.Next()) {
      Labels& labels = said[it.Current().TShape().get()];
      if (labels.layer.empty()) labels.layer = layer;
      any = true;
    }
    if (any) return;
  }
}

/// Layers of the file, straight from its entities: the document drops those of faces that it has no label for.
void read_layers(const StepVisual_PresentationLayerAssignment& assignment,
                 const Handle(Transfer_TransientProcess) & process, LabelsOfShapes& said) {
  if (assignment.AssignedItems().IsNull()) return;
  const std::string layer = text_of(assignment.Name());
  for (int k = 1; !layer.empty() && k <= assignment.NbAssignedItems(); ++k) {
    Handle(Standard_Transient) item = assignment.AssignedItemsValue(k).Value();
    if (const auto styled = Handle(StepVisual_StyledItem)::DownCast(item); !styled.IsNull()) item = styled->Item();
    if (item.IsNull()) continue;
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, item);
    if (!shape.IsNull()) add_layer(shape, layer, said);
  }
}

LabelsOfShapes read_entities(const StepData_StepModel& model, const Handle(Transfer_TransientProcess) & process) {
  LabelsOfShapes said;
  for (int i = 1; i <= model.NbEntities(); ++i) {
    const Handle(Standard_Transient)& entity = model.Value(i);
    if (const auto layer = Handle(StepVisual_PresentationLayerAssignment)::DownCast(entity); !layer.IsNull())
      read_layers(*layer, process, said);
    if (!entity->IsKind(STANDARD_TYPE(StepShape_ManifoldSolidBrep)) &&
        !entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface)))
      continue;
    const std::string name = text_of(Handle(StepRepr_RepresentationItem)::DownCast(entity)->Name());
    if (says_nothing(name)) continue;
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, entity);
    if (!shape.IsNull()) said[shape.TShape().get()].name = name;
  }
  return said;
}

/// Solids and faces of the file that became no shape.
std::vector<std::string> lost_entities(const StepData_StepModel& model,
                                       const Handle(Transfer_TransientProcess) & process) {
  std::vector<std::string> all;
  for (int i = 1; i <= model.NbEntities(); ++i) {
    const Handle(Standard_Transient)& entity = model.Value(i);
    if (!entity->IsKind(STANDARD_TYPE(StepShape_ManifoldSolidBrep)) &&
        !entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface)))
      continue;
    const Handle(Transfer_Binder) binder = process->Find(entity);
    if (binder.IsNull() || !TransferBRep::ShapeResult(binder).IsNull()) continue;
    const Handle(Interface_Check)& check = binder->Check();
    all.push_back(entity_in_words(model, entity) + " could not be made" +
                  (check.IsNull() || check->NbFails() == 0 ? "" : ": " + to_utf8(check->CFail(1))));
  }
  return all;
}

bool is_utf8_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  return is_utf8(bytes);
}

}  // namespace

void read_step(const std::string& path, const std::string& name, bool keep_going, Part& part) {
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetCVal("read.step.codepage", is_utf8_file(path) ? "UTF8" : "iso8859-1");
  STEPCAFControl_Reader reader;
  reader.SetLayerMode(false), reader.SetPropsMode(false), reader.SetGDTMode(false);
  reader.SetViewMode(false);
  send_progress("reading", "the text of the file");
  const IFSelect_ReturnStatus status = reader.ReadFile(path.c_str());
  const Handle(StepData_StepModel) model = reader.ChangeReader().StepModel();
  Complaints all = model.IsNull() ? Complaints() : complaints(model, reader.ChangeReader().WS()->Protocol());
  std::vector<std::string>& said = all.of_shapes;
  if (status != IFSelect_RetDone && said.empty()) said = heard();
  if (status != IFSelect_RetDone || model.IsNull() || model->NbEntities() == 0)
    throw Refusal(fmt::format("{} cannot be read as STEP: {}", name,
                              said.empty() ? "it is cut off, or not STEP at all" : first_of(said)));
  if (!said.empty()) lost(fmt::format("{}: {}", name, first_of(said)), keep_going);
  if (!all.of_others.empty()) part.notes.push_back("damaged entities that no shape needs: " + first_of(all.of_others));
  read_units(reader.ChangeReader(), part);
  Handle(TDocStd_Document) document = new TDocStd_Document("");
  send_progress("reading", "its shapes");
  if (!reader.Transfer(document, progress_of("reading", "its shapes")))
    throw Refusal(fmt::format("{} holds no shape that can be read{}", name, said.empty() ? "" : ": " + first_of(said)));
  const Handle(Transfer_TransientProcess) process = reader.ChangeReader().WS()->TransferReader()->TransientProcess();
  const std::vector<std::string> missing = lost_entities(*model, process);
  if (!missing.empty()) lost(fmt::format("{}: {}", name, first_of(missing)), keep_going);
  take_document(document, {read_entities(*model, process), read_densities(*model, process)}, part);
}

}  // namespace octafront::cad
