#include "read.h"
#include "text.h"

#include <Quantity_Color.hxx>
#include <TColStd_HSequenceOfExtendedString.hxx>
#include <TCollection_AsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDataStd_TreeNode.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <XCAFDoc.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_LayerTool.hxx>
#include <XCAFDoc_Material.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <vector>

namespace octafront::cad {

namespace {

std::string utf8_of(const TCollection_ExtendedString& text) {
  const TCollection_AsciiString bytes(text);
  return to_utf8(std::string_view(bytes.ToCString(), static_cast<std::size_t>(bytes.Length())));
}

/// OpenCASCADE's name of a component that the file gives none: such a one is no instance, but a piece of its product.
bool is_made_up(std::string_view name) {
  return name.starts_with("=>[");
}

bool is_count(std::string_view text) {
  return std::none_of(text.begin(), text.end(), [](unsigned char c) { return std::isalpha(c) || c >= 0x80; });
}

/// Whether an occurrence's name says more than that of its product: programs count them, "2", "NAUO2", "bolt.2".
bool says_more(std::string_view occurrence, std::string_view product) {
  if (says_nothing(occurrence) || is_made_up(occurrence)) return false;
  for (const std::string_view counted : {product, std::string_view("NAUO"), std::string_view()})
    if (occurrence.starts_with(counted) && is_count(occurrence.substr(counted.size()))) return false;
  return true;
}

class DocumentReader {
 public:
  DocumentReader(const Handle(TDocStd_Document) & document, const SaidOfShapes& said, Part& part)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colours_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        layers_(XCAFDoc_DocumentTool::LayerTool(document->Main())),
        said_(said),
        part_(part) {}

  void read() {
    TDF_LabelSequence free;
    shapes_->GetFreeShapes(free);
    for (const TDF_Label& label : free) visit(label, TopLoc_Location(), {}, {});
    name_by_assemblies();
  }

 private:
  /// Where a shape occurs: what the file calls the assemblies around it, where it gives them names of their own, and
  /// the shape there.
  struct Occurrence {
    std::string assemblies, own;

    std::string all() const { return assemblies + (assemblies.empty() || own.empty() ? "" : "/") + own; }
  };

  /// `outer`: what the assemblies around it say, where the shape itself says nothing; the name is for pieces alone.
  void visit(const TDF_Label& label, const TopLoc_Location& place, Labels outer, Occurrence occurrence) {
    if (XCAFDoc_ShapeTool::IsReference(label)) {
      TDF_Label product;
      if (!XCAFDoc_ShapeTool::GetReferredShape(label, product)) return;
      const Labels own = labels_of(label);
      if (own.colour) outer.colour = own.colour;
      if (!own.layer.empty()) outer.layer = own.layer;
      if (!is_made_up(own.name)) outer.name.clear();
      occurrence.assemblies = occurrence.all();
      occurrence.own = says_more(own.name, labels_of(product).name) ? own.name : std::string();
      return visit(product, place * XCAFDoc_ShapeTool::GetLocation(label), outer, occurrence);
    }
    if (XCAFDoc_ShapeTool::IsAssembly(label)) {
      TDF_LabelSequence components;
      XCAFDoc_ShapeTool::GetComponents(label, components);
      if (const std::string name = told_name(label); !name.empty()) outer.name = name;
      for (const TDF_Label& component : components) visit(component, place, outer, occurrence);
      return;
    }
    Labels product = labels_of(label);
    product.name = occurrence.own.empty() ? told_name(label) : occurrence.own;
    take_product(label, place, merged(product, outer));
    while (assemblies_.size() < part_.solids.size()) {
      const bool has_its_name = part_.solids[assemblies_.size()].labels.name == occurrence.own;
      assemblies_.push_back(has_its_name ? occurrence.assemblies : occurrence.all());
    }
  }

  /// Solids of equal names by the assemblies that they occur in: "left arm/pin", "right arm/pin".
  void name_by_assemblies() {
    std::map<std::string, std::set<std::string>> places;
    for (std::size_t s = 0; s < assemblies_.size(); ++s) places[part_.solids[s].labels.name].insert(assemblies_[s]);
    for (std::size_t s = 0; s < assemblies_.size(); ++s) {
      std::string& name = part_.solids[s].labels.name;
      if (!name.empty() && places[name].size() > 1 && !assemblies_[s].empty()) name = assemblies_[s] + "/" + name;
    }
  }

  void take_product(const TDF_Label& label, const TopLoc_Location& place, const Labels& product) {
    const LabelsOfShapes inside = labels_of_parts(label);
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
    if (shape.IsNull()) return;
    const std::string name = told_name(label);
    int solids = 0;
    for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) ++solids;
    for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
      Labels own = of_shape(it.Current(), inside);
      // One solid is the product; of several, each has its own name, if it has.
      if (says_nothing(own.name) || (solids == 1 && !says_nothing(product.name))) own.name.clear();
      Labels labels = merged(own, product);
      if (says_nothing(labels.name)) labels.name.clear();
      part_.solids.push_back({it.Current().Moved(place, false), labels, name.empty() ? product.name : name,
                              material_of(label), density_of(shape, it.Current())});
    }
    for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SOLID); it.More(); it.Next())
      part_.loose.push_back(it.Current().Moved(place, false));
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
      Labels own = of_shape(it.Current(), inside);
      if (says_nothing(own.name)) own.name.clear();
      if (!own.name.empty() || !own.layer.empty() || own.colour)
        part_.face_labels.Bind(it.Current().Moved(place, false), own);
    }
  }

  Labels of_shape(const TopoDS_Shape& shape, const LabelsOfShapes& inside) const {
    const auto find = [&](const LabelsOfShapes& map) {
      const auto found = map.find(shape.TShape().get());
      return found == map.end() ? Labels{} : found->second;
    };
    return merged(find(said_.labels), find(inside));
  }

  static Labels merged(Labels first, const Labels& second) {
    if (first.name.empty()) first.name = second.name;
    if (first.layer.empty()) first.layer = second.layer;
    if (!first.colour) first.colour = second.colour;
    return first;
  }

  LabelsOfShapes labels_of_parts(const TDF_Label& label) const {
    LabelsOfShapes all;
    TDF_LabelSequence inside;
    XCAFDoc_ShapeTool::GetSubShapes(label, inside);
    for (const TDF_Label& part : inside) {
      const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(part);
      if (!shape.IsNull()) all[shape.TShape().get()] = labels_of(part);
    }
    return all;
  }

  /// Of the product, or of this solid of it, as a file of one solid may have it.
  double density_of(const TopoDS_Shape& product, const TopoDS_Shape& solid) const {
    for (const TopoDS_Shape& shape : {product, solid})
      if (const auto found = said_.densities.find(shape.TShape().get()); found != said_.densities.end())
        return found->second;
    return 0;
  }

  static std::string material_of(const TDF_Label& label) {
    Handle(TDataStd_TreeNode) node;
    Handle(XCAFDoc_Material) material;
    if (!label.FindAttribute(XCAFDoc::MaterialRefGUID(), node) || !node->HasFather() ||
        !node->Father()->Label().FindAttribute(XCAFDoc_Material::GetID(), material))
      return {};
    const Handle(TCollection_HAsciiString) name = material->GetName();
    const std::string text = name.IsNull() ? "" : to_utf8(name->ToCString());
    return says_nothing(text) ? "" : text;
  }

  /// Empty where it says nothing.
  std::string told_name(const TDF_Label& label) const {
    const std::string name = labels_of(label).name;
    return says_nothing(name) ? std::string() : name;
  }

  Labels labels_of(const TDF_Label& label) const {
    Labels labels;
    Handle(TDataStd_Name) name;
    if (label.FindAttribute(TDataStd_Name::GetID(), name)) labels.name = utf8_of(name->Get());
    Quantity_Color colour;
    if (colours_->GetColor(label, XCAFDoc_ColorSurf, colour) || colours_->GetColor(label, XCAFDoc_ColorGen, colour)) {
      double red, green, blue;
      colour.Values(red, green, blue, Quantity_TOC_sRGB);
      const auto byte = [](double x) {
        return static_cast<std::uint8_t>(std::lround(std::min(1.0, std::max(0.0, x)) * 255));
      };
      labels.colour = Colour{byte(red), byte(green), byte(blue)};
    }
    Handle(TColStd_HSequenceOfExtendedString) layers;
    if (layers_->GetLayers(label, layers) && !layers.IsNull() && layers->Length() > 0)
      labels.layer = utf8_of(layers->Value(1));
    return labels;
  }

  const Handle(XCAFDoc_ShapeTool) shapes_;
  const Handle(XCAFDoc_ColorTool) colours_;
  const Handle(XCAFDoc_LayerTool) layers_;
  const SaidOfShapes& said_;
  Part& part_;
  std::vector<std::string> assemblies_;  ///< per solid: the occurrences that it is in, by name
};

}  // namespace

void take_document(const Handle(TDocStd_Document) & document, const SaidOfShapes& said, Part& part) {
  DocumentReader(document, said, part).read();
}

void take_shape(const TopoDS_Shape& shape, Part& part) {
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) part.solids.push_back({it.Current(), {}});
  for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SOLID); it.More(); it.Next()) part.loose.push_back(it.Current());
}

void number_names(Part& part) {
  std::set<std::string> taken;
  std::map<std::string, int> used;
  for (const Body& body : part.solids) taken.insert(body.labels.name);
  for (Body& body : part.solids) {
    const std::string name = body.labels.name;
    int& n = used[name];
    if (name.empty() || ++n == 1) continue;
    // "bolt#2" may be a name that the file gives already.
    while (taken.contains(name + "#" + std::to_string(n))) ++n;
    body.labels.name = name + "#" + std::to_string(n);
    taken.insert(body.labels.name);
  }
}

}  // namespace octafront::cad
