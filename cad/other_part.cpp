#include "base/geometry/self_intersection.h"
#include "measure.h"
#include "outline.h"
#include "pipe.h"
#include "steps.h"
#include "topology.h"
#include "triangulate.h"
#include "weld.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Geom_SphericalSurface.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Edge.hxx>
#include <ShapeFix_Shell.hxx>
#include <ShapeFix_Solid.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Wire.hxx>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

/// A solid more of whose triangles cross passes through itself; fewer are accidents of the triangles.
constexpr double kPartThatCrosses = 0.01;
/// Triangles that show it: this part of the solid's extent, and an angle, radians.
constexpr double kShowingDeflection = 0.002, kShowingAngle = 0.35;
/// Areas of both parts of a sphere add up to all of it, relative.
constexpr double kAreasAgree = 1e-3;

using ReplacedFaces = std::vector<std::pair<TopoDS_Face, TopoDS_Face>>;  // before, after

/// The edges of the only wire, without those at poles. Nothing: there are more wires, or a seam.
std::optional<std::vector<TopoDS_Edge>> edges_of_only_wire(const TopoDS_Face& face) {
  int wires = 0;
  for (TopExp_Explorer it(face, TopAbs_WIRE); it.More(); it.Next()) ++wires;
  if (wires != 1) return std::nullopt;
  TopTools_MapOfShape seen;
  std::vector<TopoDS_Edge> edges;
  for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(it.Current());
    if (BRep_Tool::Degenerated(edge)) continue;
    if (!seen.Add(edge)) return std::nullopt;
    edges.push_back(edge);
  }
  return edges;
}

TopoDS_Face bounded(const Handle(Geom_SphericalSurface) & sphere, const std::vector<TopoDS_Edge>& edges, bool turned,
                    double tolerance) {
  TopoDS_Face face;
  TopoDS_Wire wire;
  const BRep_Builder builder;
  builder.MakeFace(face, sphere, tolerance);
  builder.MakeWire(wire);
  for (const TopoDS_Edge& edge : edges) builder.Add(wire, turned ? edge.Reversed() : edge.Oriented(edge.Orientation()));
  wire.Closed(true);
  builder.Add(face, wire);
  ShapeFix_Edge fixer;
  for (const TopoDS_Edge& edge : edges) fixer.FixAddPCurve(edge, face, false, tolerance);
  return face;
}

/// A face that is more than half of its sphere as the rest of it, which has neither a pole nor a seam.
std::optional<TopoDS_Face> rest_of_sphere(const TopoDS_Face& face) {
  const BRepAdaptor_Surface surface(face, false);
  if (surface.GetType() != GeomAbs_Sphere) return std::nullopt;
  const gp_Sphere sphere = surface.Sphere();
  GProp_GProps found;
  BRepGProp::SurfaceProperties(face, found);
  const double area = std::abs(found.Mass());
  if (!(area > 0.5 * sphere.Area()) || !(area < sphere.Area())) return std::nullopt;
  const auto edges = edges_of_only_wire(TopoDS::Face(face.Oriented(TopAbs_FORWARD)));
  const gp_Vec away(sphere.Location(), found.CentreOfMass());
  if (!edges || edges->empty() || !(away.Magnitude() > 0)) return std::nullopt;
  const gp_Ax3 axes(sphere.Location(), gp_Ax2(sphere.Location(), away).XDirection(), away);
  const Handle(Geom_SphericalSurface) same = new Geom_SphericalSurface(axes, sphere.Radius());
  for (const bool turned : {true, false}) {
    TopoDS_Face rest = bounded(same, *edges, turned, BRep_Tool::Tolerance(face));
    GProp_GProps made;
    BRepGProp::SurfaceProperties(rest, made);
    if (std::abs(made.Mass() + area - sphere.Area()) < kAreasAgree * sphere.Area()) return rest;
  }
  return std::nullopt;
}

/// How large a part of its triangles crosses others.
double part_that_crosses(const TopoDS_Shape& solid) {
  Part part;
  part.solids.push_back({solid, {}});
  const Topology topology = topology_of(part);
  Box3 box;
  for (const Topology::OfFace& face : topology.faces) box.add(close_box(face.face));
  const Fineness fineness{kShowingDeflection * box.diagonal(), kShowingAngle};
  const auto nothing = [](std::size_t) {};
  CadModel model = model_without_triangles(part, topology);
  const std::vector<int> rung =
      triangulate(part, topology, fineness, std::vector<int>(topology.faces.size(), 0), nothing);
  add_triangles(part, topology, fineness, rung, nothing, model);
  if (model.triangles.empty()) return 1;
  return static_cast<double>(self_intersections(model.points, model.triangles).size()) /
         static_cast<double>(model.triangles.size());
}

/// The solid with those faces, if its only shell closes with them.
std::optional<TopoDS_Shape> with_faces(const TopoDS_Shape& solid, const ReplacedFaces& faces) {
  const Handle(ShapeBuild_ReShape) change = new ShapeBuild_ReShape;
  for (const auto& [before, after] : faces) change->Replace(before, after);
  const TopoDS_Shape changed = change->Apply(solid);
  TopExp_Explorer shells(changed, TopAbs_SHELL);
  if (!shells.More()) return std::nullopt;
  ShapeFix_Shell fixer;
  fixer.FixFaceOrientation(TopoDS::Shell(shells.Current()));
  const TopoDS_Shell shell = fixer.Shell();
  shells.Next();
  if (shells.More() || fixer.NbShells() != 1) return std::nullopt;
  return ShapeFix_Solid().SolidFromShell(shell);
}

/// What becomes of a solid that passes through itself as it was read, and no longer does then.
std::optional<std::pair<TopoDS_Shape, ReplacedFaces>> with_other_parts(const TopoDS_Shape& solid) {
  ReplacedFaces faces;
  for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face face = TopoDS::Face(it.Current());
    if (const auto rest = rest_of_sphere(face)) faces.emplace_back(face, *rest);
  }
  if (faces.empty() || part_that_crosses(solid) <= kPartThatCrosses) return std::nullopt;
  const std::optional<TopoDS_Shape> better = with_faces(solid, faces);
  if (!better || part_that_crosses(*better) > 0) return std::nullopt;
  return std::pair{*better, std::move(faces)};
}

}  // namespace

void take_other_parts(Part& part) {
  std::size_t taken = 0;
  for (std::size_t i = 0; i < part.solids.size(); ++i) {
    Body& body = part.solids[i];
    const TopLoc_Location place = body.solid.Location();
    try {
      const auto better = with_other_parts(body.solid.Located(TopLoc_Location()));
      if (!better) continue;
      send_progress("reading", in_words(part, i), -1, body.solid);
      body.solid = better->first.Moved(place, false);
      for (const auto& [before, after] : better->second)
        pass_labels(before.Moved(place, false), after.Moved(place, false), part.face_labels);
      taken += better->second.size();
    } catch (const Standard_Failure&) {
    }
  }
  if (taken > 0)
    part.notes.push_back(
        fmt::format("{} of spheres taken as the other part of the sphere: as OpenCASCADE reads the file, solids pass "
                    "through themselves",
                    taken == 1 ? "1 face" : fmt::format("{} faces", taken)));
}

}  // namespace octafront::cad
