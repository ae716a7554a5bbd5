#include "outline.h"

#include "measure.h"
#include "records.h"
#include "smooth.h"

#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Standard_Failure.hxx>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace octafront::cad {

namespace {

/// Places along an edge at which its faces are compared.
constexpr int kAlong = 9;

Face face_without_triangles(const Part& part, const Topology::OfFace& of) {
  Face face;
  if (part.face_labels.IsBound(of.face)) face.labels = part.face_labels.Find(of.face);
  face.sides = of.sides;
  face.area = std::abs(area_of(of.face));
  face.tolerance = BRep_Tool::Tolerance(of.face);
  face.is_turned = of.face.Orientation() == TopAbs_REVERSED;
  face.surface = analytic_record(of.face);
  if (face.surface.kind != SurfaceRecord::Kind::kNone)
    BRepTools::UVBounds(of.face, face.low.u, face.high.u, face.low.v, face.high.v);
  return face;
}

CadEdge edge_without_points(const Topology& topology, const Topology::OfEdge& of) {
  CadEdge edge;
  edge.faces = of.faces;
  edge.length = length_of(of.edge);
  if (of.uses.size() != 2) return edge;
  double first = 0, last = 0;
  BRep_Tool::Range(of.edge, first, last);
  std::vector<double> along;
  for (int i = 0; i < kAlong; ++i) along.push_back(first + (last - first) * i / (kAlong - 1));
  const bool one_plane = is_smooth_across(topology, of, along);
  edge.is_seam = of.faces.size() == 1 && one_plane;
  edge.is_smooth = of.faces.size() == 2 && one_plane;
  return edge;
}

bool is_one_contact(const Face& a, const Face& b) {
  const auto pair = [](const Face& face) { return std::minmax(face.sides[0], face.sides[1]); };
  return pair(a) == pair(b) && a.sides[0] != a.sides[1] && std::max(a.sides[0], a.sides[1]) != kNone;
}

/// Face::piece of all.
void find_pieces(CadModel& model) {
  std::vector<std::uint32_t> first(model.faces.size());
  std::iota(first.begin(), first.end(), 0);
  const auto find = [&](std::uint32_t f) {
    while (first[f] != f) f = first[f] = first[first[f]];
    return f;
  };
  for (const CadEdge& edge : model.edges) {
    if (!edge.is_smooth) continue;
    const std::uint32_t a = find(edge.faces[0]), b = find(edge.faces[1]);
    const Face &one = model.faces[edge.faces[0]], &other = model.faces[edge.faces[1]];
    if (one.surface.kind == other.surface.kind && is_one_contact(one, other)) first[std::max(a, b)] = std::min(a, b);
  }
  for (std::uint32_t f = 0; f < first.size(); ++f)
    if (is_one_contact(model.faces[f], model.faces[f])) model.faces[f].piece = find(f);
}

}  // namespace

CadModel model_without_triangles(const Part& part, const Topology& topology) {
  CadModel model;
  for (const Body& body : part.solids)
    model.solids.push_back(
        {body.labels, body.product, body.material, body.density, volume_of(body.solid), area_of(body.solid), false});
  for (const Topology::OfFace& of : topology.faces) {
    model.faces.push_back(face_without_triangles(part, of));
    model.tolerance = std::max(model.tolerance, tolerance_of(of.face));
  }
  for (const Topology::OfEdge& of : topology.edges) model.edges.push_back(edge_without_points(topology, of));
  find_pieces(model);
  model.fused = part.fused, model.format = part.format, model.unit = part.unit,
  model.to_millimetres = part.to_millimetres, model.per_millimetre = part.per_millimetre;
  model.shared = part.shared, model.notes = part.notes;
  return model;
}

}  // namespace octafront::cad
