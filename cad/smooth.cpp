#include "smooth.h"

#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Surface.hxx>
#include <Standard_Failure.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>

namespace octafront::cad {

namespace {

/// A normal so short, against the others along an edge, is a pole's: its direction is noise.
constexpr double kPole = 1e-6;
/// Faces whose normals differ by less along an edge have one tangent plane there: 1 degree.
const double kSmoothCosine = std::cos(M_PI / 180);

bool is_reversed(const Topology& topology, const Topology::Use& use) {
  return topology.faces[use.face].face.Orientation() == TopAbs_REVERSED;
}

/// Normals of the face's front along an edge, as long as the surface's derivatives make them: at a pole nearly nothing.
std::vector<gp_Vec> normals_along(const Topology& topology, const Topology::Use& use,
                                  const std::vector<double>& parameters) {
  double first, last;
  const TopoDS_Face face = TopoDS::Face(topology.faces[use.face].face.Oriented(TopAbs_FORWARD));
  const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(use.edge, face, first, last);
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  std::vector<gp_Vec> normals;
  if (curve.IsNull() || surface.IsNull()) return normals;
  for (const double parameter : parameters) {
    const gp_Pnt2d uv = curve->Value(std::clamp(parameter, first, last));
    gp_Pnt p;
    gp_Vec du, dv;
    surface->D1(uv.X(), uv.Y(), p, du, dv);
    normals.push_back(is_reversed(topology, use) ? dv.Crossed(du) : du.Crossed(dv));
  }
  return normals;
}

double longest(const std::vector<gp_Vec>& vectors) {
  double most = 0;
  for (const gp_Vec& v : vectors) most = std::max(most, v.Magnitude());
  return most;
}

}  // namespace

bool is_smooth_across(const Topology& topology, const Topology::OfEdge& edge, const std::vector<double>& parameters) {
  const std::vector<Topology::Use>& uses = edge.uses;
  if (uses.size() != 2) return false;
  const auto direction = [&](const Topology::Use& use) {
    return (use.edge.Orientation() == TopAbs_REVERSED) != is_reversed(topology, use);
  };
  // Faces that have the edge in the same direction look to different sides.
  const double sign = direction(uses[0]) == direction(uses[1]) ? -1 : 1;
  try {
    const std::vector<gp_Vec> a = normals_along(topology, uses[0], parameters),
                              b = normals_along(topology, uses[1], parameters);
    if (a.empty() || b.empty()) return false;
    const double least_a = kPole * longest(a), least_b = kPole * longest(b);
    bool any = false;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double la = a[i].Magnitude(), lb = b[i].Magnitude();
      if (!(la > least_a && lb > least_b)) continue;
      if (sign * a[i].Dot(b[i]) < kSmoothCosine * la * lb) return false;
      any = true;
    }
    return any;
  } catch (const Standard_Failure&) {
    return false;
  }
}

}  // namespace octafront::cad
