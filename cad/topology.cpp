#include "topology.h"

#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

class TopologyMaker {
 public:
  explicit TopologyMaker(const Part& part) {
    for (std::size_t s = 0; s < part.solids.size(); ++s)
      for (TopExp_Explorer it(part.solids[s].solid, TopAbs_FACE); it.More(); it.Next())
        set_side(add_face(it.Current()), it.Current(), static_cast<std::uint32_t>(s));
    for (const TopoDS_Shape& face : part.loose) add_face(face);
    add_edges();
  }
  Topology take() { return std::move(made_); }

 private:
  std::uint32_t add_face(const TopoDS_Shape& face) {
    const int known = made_.face_map.Extent();
    const int i = made_.face_map.Add(face);
    if (i > known) {
      const bool reversed = face.Orientation() == TopAbs_REVERSED;
      made_.faces.push_back({TopoDS::Face(face.Oriented(reversed ? TopAbs_REVERSED : TopAbs_FORWARD)), {kNone, kNone}});
    }
    return static_cast<std::uint32_t>(i - 1);
  }

  void set_side(std::uint32_t f, const TopoDS_Shape& used, std::uint32_t solid) {
    Topology::OfFace& face = made_.faces[f];
    const TopAbs_Orientation as = used.Orientation();
    if (as == TopAbs_EXTERNAL) return;
    // A face inside of a solid is a sheet.
    if (as == TopAbs_INTERNAL)
      face.sides = {solid, solid};
    else if (as == face.face.Orientation())
      face.sides[1] = solid;
    else
      face.sides[0] = solid;
  }

  void add_edges() {
    for (std::uint32_t f = 0; f < made_.faces.size(); ++f)
      for (TopExp_Explorer it(made_.faces[f].face.Oriented(TopAbs_FORWARD), TopAbs_EDGE); it.More(); it.Next()) {
        const TopoDS_Edge edge = TopoDS::Edge(it.Current());
        if (BRep_Tool::Degenerated(edge)) continue;
        const int known = made_.edge_map.Extent();
        const int e = made_.edge_map.Add(edge);
        if (e > known) made_.edges.push_back({TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)), {}, {}});
        Topology::OfEdge& made = made_.edges[static_cast<std::size_t>(e - 1)];
        if (made.faces.empty() || made.faces.back() != f) made.faces.push_back(f);
        made.uses.push_back({edge, f});
      }
  }

  Topology made_;
};

}  // namespace

Topology topology_of(const Part& part) {
  return TopologyMaker(part).take();
}

void pass_labels(const TopoDS_Shape& before, const TopoDS_Shape& after, FaceLabels& labels) {
  if (before.IsNull() || after.IsNull() || !labels.IsBound(before)) return;
  const Labels known = labels.Find(before);
  for (TopExp_Explorer it(after, TopAbs_FACE); it.More(); it.Next())
    if (!labels.IsBound(it.Current())) labels.Bind(it.Current(), known);
}

std::string in_words(const Part& part, std::size_t solid) {
  const std::string& name = part.solids[solid].labels.name;
  return name.empty() ? fmt::format("solid {}", solid + 1) : fmt::format("solid '{}'", name);
}

std::string face_in_words(const Part& part, const Topology& topology, std::size_t face) {
  const TopoDS_Face& shape = topology.faces[face].face;
  const std::string name = part.face_labels.IsBound(shape) ? part.face_labels.Find(shape).name : "";
  return name.empty() ? fmt::format("face {}", face + 1) : fmt::format("face {} ({})", face + 1, name);
}

}  // namespace octafront::cad
