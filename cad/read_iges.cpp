#include "pipe.h"
#include "read.h"
#include "text.h"

#include <IGESCAFControl_Reader.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Check.hxx>
#include <Interface_ReportEntity.hxx>
#include <Interface_Static.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

/// The names of the standard are short: "MM", "INCH".
std::string unit_in_words(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const auto& [brief, whole] : {std::pair{"mm", "millimetre"},
                                     {"in", "inch"},
                                     {"inch", "inch"},
                                     {"m", "metre"},
                                     {"cm", "centimetre"},
                                     {"ft", "foot"},
                                     {"mi", "mile"},
                                     {"km", "kilometre"},
                                     {"mil", "mil"},
                                     {"um", "micrometre"},
                                     {"uin", "microinch"}})
    if (name == brief) return whole;
  return name;
}

void read_unit(const IGESData_IGESModel& model, Part& part) {
  const IGESData_GlobalSection& global = model.GlobalSection();
  if (!global.UnitName().IsNull()) part.unit = unit_in_words(to_utf8(global.UnitName()->ToCString()));
  // In the unit that is asked of the reader.
  if (global.UnitValue() > 0) part.to_millimetres = global.UnitValue();
}

void replace(std::string& text, const std::string& before, const std::string& after) {
  if (const std::size_t at = text.find(before); at != std::string::npos) text.replace(at, before.size(), after);
}

/// The library's sentences, some of which it never fills in, or has lost.
std::string complaint_in_words(const std::string& complaint) {
  std::string text = to_utf8(complaint);
  if (text.starts_with("Unknown message")) return "its data are damaged";
  replace(text, "parameter %d", "a parameter");
  replace(text, " Process continues", "");
  replace(text, "  ", " ");
  replace(text, " : ", ": ");
  text.erase(text.find_last_not_of(". ") + 1);
  return text;
}

std::string entity_of(const IGESData_IGESModel& model, const Handle(Standard_Transient) & entity) {
  return "entity " + to_utf8(model.StringLabel(entity)->ToCString());
}

std::string first_in_words(const std::vector<std::string>& sentences) {
  return sentences[0] + (sentences.size() > 1 ? fmt::format(" (and {} more)", sentences.size() - 1) : "");
}

/// Where the library takes a value of its own, of a view or a colour, nothing is lost.
std::vector<std::string> complaints_of(const IGESData_IGESModel& model) {
  std::vector<std::string> all;
  for (int i = 1; i <= model.NbEntities(); ++i) {
    if (!model.IsReportEntity(i)) continue;
    const Handle(Interface_Check)& check = model.ReportEntity(i)->Check();
    for (int k = 1; k <= check->NbFails(); ++k) {
      const std::string text = complaint_in_words(check->CFail(k));
      if (text.find("Default value") == std::string::npos)
        all.push_back(entity_of(model, model.Value(i)) + ": " + text);
    }
  }
  return all;
}

/// Bounded and trimmed surfaces, faces, shells and solids that became no shape.
std::vector<std::string> lost_surfaces(const IGESData_IGESModel& model,
                                       const Handle(Transfer_TransientProcess) & process) {
  std::vector<std::string> all;
  for (int i = 1; i <= model.NbEntities(); ++i) {
    const Handle(IGESData_IGESEntity) entity = model.Entity(i);
    const int type = entity->TypeNumber();
    if (type != 143 && type != 144 && type != 186 && type != 510 && type != 514) continue;
    const Handle(Transfer_Binder) binder = process->Find(entity);
    if (!binder.IsNull() && TransferBRep::ShapeResult(binder).IsNull())
      all.push_back(entity_of(model, entity) + " could not be made");
  }
  return all;
}

}  // namespace

void read_iges(const std::string& path, const std::string& name, bool keep_going, Part& part) {
  IGESControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  IGESCAFControl_Reader reader;
  send_progress("reading", "the text of the file");
  const IFSelect_ReturnStatus status = reader.ReadFile(path.c_str());
  const Handle(IGESData_IGESModel) model = reader.IGESModel();
  if (status != IFSelect_RetDone || model.IsNull() || model->NbEntities() == 0)
    throw Refusal(fmt::format("{} cannot be read as IGES: it is cut off, or not IGES at all", name));
  const std::vector<std::string> said = complaints_of(*model);
  if (!said.empty()) lost(name + ": " + first_in_words(said), keep_going);
  read_unit(*model, part);
  Handle(TDocStd_Document) document = new TDocStd_Document("");
  send_progress("reading", "its shapes");
  if (!reader.Transfer(document, progress_of("reading", "its shapes")))
    throw Refusal(fmt::format("{} holds no shape that can be read", name));
  const std::vector<std::string> missing = lost_surfaces(*model, reader.WS()->TransferReader()->TransientProcess());
  if (!missing.empty()) lost(name + ": " + first_in_words(missing), keep_going);
  take_document(document, {}, part);
}

}  // namespace octafront::cad
