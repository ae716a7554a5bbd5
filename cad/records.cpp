#include "records.h"

#include "evaluate.h"

#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Standard_Failure.hxx>
#include <algorithm>
#include <cmath>

namespace octafront::cad {

namespace {

Vec3 vec(const gp_XYZ& p) {
  return {p.X(), p.Y(), p.Z()};
}

Frame frame_of(const gp_Ax3& a) {
  return {vec(a.Location().XYZ()), vec(a.XDirection().XYZ()), vec(a.YDirection().XYZ()), vec(a.Direction().XYZ())};
}
Frame frame_of(const gp_Ax2& a) {
  return {vec(a.Location().XYZ()), vec(a.XDirection().XYZ()), vec(a.YDirection().XYZ()), vec(a.Direction().XYZ())};
}

// Surfaces and curves of the library alike.
template <class Array>
std::vector<double> flat(const Array& knots) {
  std::vector<double> out;
  for (int i = knots.Lower(); i <= knots.Upper(); ++i) out.push_back(knots(i));
  return out;
}

using SurfaceKind = SurfaceRecord::Kind;
using CurveKind = CurveRecord::Kind;

/// A surface that is given by a few numbers, with the parameters that it has; kNone: another one.
SurfaceRecord analytic(const Handle(Geom_Surface) & surface) {
  SurfaceRecord out;
  const auto elementary = Handle(Geom_ElementarySurface)::DownCast(surface);
  if (elementary.IsNull()) return out;
  out.frame = frame_of(elementary->Position());
  if (const auto cylinder = Handle(Geom_CylindricalSurface)::DownCast(surface); !cylinder.IsNull())
    out.kind = SurfaceKind::kCylinder, out.radius = cylinder->Radius();
  else if (const auto cone = Handle(Geom_ConicalSurface)::DownCast(surface); !cone.IsNull())
    out.kind = SurfaceKind::kCone, out.radius = cone->RefRadius(), out.minor = cone->SemiAngle();
  else if (const auto sphere = Handle(Geom_SphericalSurface)::DownCast(surface); !sphere.IsNull())
    out.kind = SurfaceKind::kSphere, out.radius = sphere->Radius();
  else if (const auto torus = Handle(Geom_ToroidalSurface)::DownCast(surface); !torus.IsNull())
    out.kind = SurfaceKind::kTorus, out.radius = torus->MajorRadius(), out.minor = torus->MinorRadius();
  else if (surface->IsKind(STANDARD_TYPE(Geom_Plane)))
    out.kind = SurfaceKind::kPlane;
  return out;
}

/// The surface of a face, whatever it is cut out of.
Handle(Geom_Surface) basis_of(const TopoDS_Face& face) {
  Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  for (;;) {
    const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface);
    if (trimmed.IsNull()) return surface;
    surface = trimmed->BasisSurface();
  }
}

/// The same of an offset that is analytic again.
SurfaceRecord analytic_or_offset(const Handle(Geom_Surface) & surface) {
  const SurfaceRecord record = analytic(surface);
  const auto offset = Handle(Geom_OffsetSurface)::DownCast(surface);
  if (record.kind != SurfaceKind::kNone || offset.IsNull() || offset->Surface().IsNull()) return record;
  return analytic(offset->Surface());
}

/// Not periodic on entry.
SurfaceRecord record_of(const Geom_BSplineSurface& s) {
  SurfaceRecord out;
  out.kind = SurfaceKind::kNurbs;
  out.u_knots = {static_cast<std::uint32_t>(s.UDegree()), flat(s.UKnotSequence())};
  out.v_knots = {static_cast<std::uint32_t>(s.VDegree()), flat(s.VKnotSequence())};
  // The weights of a polynomial surface need not be 1 in the library.
  const bool rational = s.IsURational() || s.IsVRational();
  for (int i = 1; i <= s.NbUPoles(); ++i)
    for (int j = 1; j <= s.NbVPoles(); ++j) {
      out.poles.push_back(vec(s.Pole(i, j).XYZ()));
      if (rational) out.weights.push_back(s.Weight(i, j));
    }
  if (s.IsUClosed()) out.u_period = out.u_knots.last() - out.u_knots.first();
  if (s.IsVClosed()) out.v_period = out.v_knots.last() - out.v_knots.first();
  return out;
}

CurveRecord record_of(const Geom_BSplineCurve& c) {
  CurveRecord out;
  out.kind = CurveKind::kNurbs;
  out.knots = {static_cast<std::uint32_t>(c.Degree()), flat(c.KnotSequence())};
  for (int i = 1; i <= c.NbPoles(); ++i) {
    out.poles.push_back(vec(c.Pole(i).XYZ()));
    if (c.IsRational()) out.weights.push_back(c.Weight(i));
  }
  return out;
}

template <class Record, class Sample>
double farthest(const Record& record, const std::vector<Sample>& samples) {
  double most = 0;
  for (const Sample& s : samples) most = std::max(most, distance(point_of(record, s.at), s.p));
  return most;
}

template <class Record, class Sample>
bool fits(const Record& record, const std::vector<Sample>& samples, const Allowed& allowed) {
  return std::all_of(samples.begin(), samples.end(), [&](const Sample& s) {
    return distance(point_of(record, s.at), s.p) <= (s.on_border ? allowed.border : allowed.inside);
  });
}

Handle(Geom_BSplineSurface) not_periodic(const Handle(Geom_BSplineSurface) & surface) {
  const auto copy = Handle(Geom_BSplineSurface)::DownCast(surface->Copy());
  if (copy->IsUPeriodic()) copy->SetUNotPeriodic();
  if (copy->IsVPeriodic()) copy->SetVNotPeriodic();
  return copy;
}

/// The surface on the face's part of its parameters as a B-spline, whose own parameters may be others.
Handle(Geom_BSplineSurface) spline_of(const TopoDS_Face& face, const Handle(Geom_Surface) & surface) {
  if (const auto spline = Handle(Geom_BSplineSurface)::DownCast(surface); !spline.IsNull()) return not_periodic(spline);
  if (surface->IsKind(STANDARD_TYPE(Geom_BezierSurface)))
    return not_periodic(GeomConvert::SurfaceToBSplineSurface(surface));
  double u0, u1, v0, v1, a, b, c, d;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  surface->Bounds(a, b, c, d);
  // A little more than the face, where there is more: nearest points lie off its border as well.
  const double du = .01 * (u1 - u0), dv = .01 * (v1 - v0);
  if (!surface->IsUPeriodic())
    u0 = std::max(a, u0 - du), u1 = std::min(b, u1 + du);
  else if (u1 - u0 > surface->UPeriod())
    u1 = u0 + surface->UPeriod();
  if (!surface->IsVPeriodic())
    v0 = std::max(c, v0 - dv), v1 = std::min(d, v1 + dv);
  else if (v1 - v0 > surface->VPeriod())
    v1 = v0 + surface->VPeriod();
  const Handle(Geom_Surface) part = new Geom_RectangularTrimmedSurface(surface, u0, u1, v0, v1);
  return not_periodic(GeomConvert::SurfaceToBSplineSurface(part));
}

/// Newton's iteration for the nearest point, from `at`, within the surface's bounds.
Uv nearest(const Geom_BSplineSurface& s, Uv at, const gp_Pnt& p, const double (&bounds)[4]) {
  for (int step = 0; step < 30; ++step) {
    gp_Pnt q;
    gp_Vec du, dv, duu, dvv, duv;
    s.D2(at.u, at.v, q, du, dv, duu, dvv, duv);
    const gp_Vec r(p, q);
    const double gu = r * du, gv = r * dv;
    double huu = du * du + r * duu, hvv = dv * dv + r * dvv, huv = du * dv + r * duv;
    if (!(huu > 0 && huu * hvv - huv * huv > 0)) huu = du * du, hvv = dv * dv, huv = du * dv;
    const double det = huu * hvv - huv * huv;
    if (!(std::abs(det) > 1e-30)) break;
    const Uv next{std::clamp(at.u - (hvv * gu - huv * gv) / det, bounds[0], bounds[1]),
                  std::clamp(at.v - (huu * gv - huv * gu) / det, bounds[2], bounds[3])};
    const double moved =
        std::hypot((next.u - at.u) / (bounds[1] - bounds[0]), (next.v - at.v) / (bounds[3] - bounds[2]));
    at = next;
    if (moved < 1e-14) break;
  }
  return at;
}

/// Parameters of the samples on a surface that was converted: near where they lay in the box of the old ones, which
/// keeps them on their side of a seam.
void project(const Geom_BSplineSurface& s, std::vector<SurfaceSample>& samples) {
  double bounds[4];
  s.Bounds(bounds[0], bounds[1], bounds[2], bounds[3]);
  Uv lo = samples[0].at, hi = lo;
  for (const SurfaceSample& x : samples) {
    lo = {std::min(lo.u, x.at.u), std::min(lo.v, x.at.v)};
    hi = {std::max(hi.u, x.at.u), std::max(hi.v, x.at.v)};
  }
  const auto scaled = [](double x, double a, double b, double c, double d) {
    return b > a ? c + (x - a) / (b - a) * (d - c) : c;
  };
  for (SurfaceSample& x : samples) {
    const Uv start{scaled(x.at.u, lo.u, hi.u, bounds[0], bounds[1]), scaled(x.at.v, lo.v, hi.v, bounds[2], bounds[3])};
    x.at = nearest(s, start, gp_Pnt(x.p.x, x.p.y, x.p.z), bounds);
  }
}

/// The same on a surface that kept its parameters: an edge may lie along a face by others than the face says. What is
/// periods away stays so.
void project_near(const Geom_BSplineSurface& s, const SurfaceRecord& record, std::vector<SurfaceSample>& samples) {
  double bounds[4];
  s.Bounds(bounds[0], bounds[1], bounds[2], bounds[3]);
  for (SurfaceSample& x : samples) {
    const Uv start{wrapped(x.at.u, record.u_knots, record.u_period), wrapped(x.at.v, record.v_knots, record.v_period)};
    const Uv there = nearest(s, start, gp_Pnt(x.p.x, x.p.y, x.p.z), bounds);
    x.at.u += there.u - start.u, x.at.v += there.v - start.v;
  }
}

/// Points of the surface itself all over the box of the samples: a conversion may fit on the border alone.
std::vector<SurfaceSample> points_inside(const Geom_Surface& surface, const std::vector<SurfaceSample>& samples) {
  constexpr int kSteps = 9;
  Uv lo = samples[0].at, hi = lo;
  for (const SurfaceSample& x : samples) {
    lo = {std::min(lo.u, x.at.u), std::min(lo.v, x.at.v)};
    hi = {std::max(hi.u, x.at.u), std::max(hi.v, x.at.v)};
  }
  std::vector<SurfaceSample> out;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const Uv at{lo.u + (hi.u - lo.u) * i / kSteps, lo.v + (hi.v - lo.v) * j / kSteps};
      out.push_back({at, vec(surface.Value(at.u, at.v).XYZ()), false});
    }
  return out;
}

SurfaceRecord nurbs_record(const TopoDS_Face& face, const Handle(Geom_Surface) & surface,
                           std::vector<SurfaceSample>& samples, const Allowed& allowed) {
  const Handle(Geom_BSplineSurface) spline = spline_of(face, surface);
  if (spline.IsNull()) return {};
  const SurfaceRecord record = record_of(*spline);
  std::vector<SurfaceSample> all = points_inside(*surface, samples);
  all.insert(all.end(), samples.begin(), samples.end());
  if (fits(record, all, allowed)) return record;
  if (surface->IsKind(STANDARD_TYPE(Geom_BSplineSurface)))
    project_near(*spline, record, all);
  else
    project(*spline, all);
  if (!fits(record, all, allowed)) return {};
  samples.assign(all.end() - static_cast<std::ptrdiff_t>(samples.size()), all.end());
  return record;
}

CurveRecord analytic(const Handle(Geom_Curve) & curve) {
  CurveRecord out;
  if (const auto line = Handle(Geom_Line)::DownCast(curve); !line.IsNull()) {
    out.kind = CurveKind::kLine;
    out.frame.origin = vec(line->Position().Location().XYZ());
    const gp_Ax2 axes(line->Position().Location(), line->Position().Direction());
    // Along x.
    out.frame.x = vec(axes.Direction().XYZ()), out.frame.y = vec(axes.XDirection().XYZ()),
    out.frame.z = vec(axes.YDirection().XYZ());
  } else if (const auto circle = Handle(Geom_Circle)::DownCast(curve); !circle.IsNull()) {
    out.kind = CurveKind::kCircle, out.frame = frame_of(circle->Position()), out.radius = circle->Radius();
  } else if (const auto ellipse = Handle(Geom_Ellipse)::DownCast(curve); !ellipse.IsNull()) {
    out.kind = CurveKind::kEllipse, out.frame = frame_of(ellipse->Position());
    out.radius = ellipse->MajorRadius(), out.minor = ellipse->MinorRadius();
  }
  return out;
}

double nearest(const Geom_BSplineCurve& c, double t, const gp_Pnt& p) {
  const double first = c.FirstParameter(), last = c.LastParameter();
  for (int step = 0; step < 30; ++step) {
    gp_Pnt q;
    gp_Vec d, dd;
    c.D2(t, q, d, dd);
    const gp_Vec r(p, q);
    double h = d * d + r * dd;
    if (!(h > 0)) h = d * d;
    if (!(h > 1e-30)) break;
    const double next = std::clamp(t - r * d / h, first, last), moved = std::abs(next - t);
    t = next;
    if (moved < 1e-14 * (last - first)) break;
  }
  return t;
}

CurveRecord nurbs_record(const Handle(Geom_Curve) & curve, double first, double last, std::vector<CurveSample>& samples,
                         const Allowed& allowed) {
  const Handle(Geom_BSplineCurve) spline = GeomConvert::CurveToBSplineCurve(new Geom_TrimmedCurve(curve, first, last));
  if (spline.IsNull()) return {};
  if (spline->IsPeriodic()) spline->SetNotPeriodic();
  const CurveRecord record = record_of(*spline);
  if (fits(record, samples, allowed)) return record;
  std::vector<CurveSample> projected = samples;
  const double a = spline->FirstParameter(), b = spline->LastParameter();
  for (CurveSample& x : projected)
    x.at = nearest(*spline, a + (x.at - first) / (last - first) * (b - a), gp_Pnt(x.p.x, x.p.y, x.p.z));
  // A closed curve's two ends are one point.
  projected.front().at = a, projected.back().at = b;
  if (!fits(record, projected, allowed)) return {};
  for (std::size_t i = 1; i < projected.size(); ++i)
    if (!(projected[i].at > projected[i - 1].at)) return {};
  samples = std::move(projected);
  return record;
}

}  // namespace

SurfaceRecord surface_record(const TopoDS_Face& face, std::vector<SurfaceSample>& samples, const Allowed& allowed) {
  try {
    const Handle(Geom_Surface) surface = basis_of(face);
    if (surface.IsNull() || samples.empty()) return {};
    const SurfaceRecord record = analytic_or_offset(surface);
    if (record.kind != SurfaceKind::kNone && fits(record, samples, allowed)) return record;
    return nurbs_record(face, surface, samples, allowed);
  } catch (const Standard_Failure&) {
    return {};
  }
}

SurfaceRecord analytic_record(const TopoDS_Face& face) {
  try {
    const Handle(Geom_Surface) surface = basis_of(face);
    return surface.IsNull() ? SurfaceRecord() : analytic_or_offset(surface);
  } catch (const Standard_Failure&) {
    return {};
  }
}

CurveRecord curve_record(const TopoDS_Edge& edge, std::vector<CurveSample>& samples, const Allowed& allowed) {
  try {
    double first, last;
    Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
    while (!curve.IsNull()) {
      if (const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve); !trimmed.IsNull())
        curve = trimmed->BasisCurve();
      else
        break;
    }
    if (curve.IsNull() || samples.size() < 2) return {};
    const CurveRecord record = analytic(curve);
    if (record.kind != CurveKind::kNone && fits(record, samples, allowed)) return record;
    return nurbs_record(curve, first, last, samples, allowed);
  } catch (const Standard_Failure&) {
    return {};
  }
}

double gap(const SurfaceRecord& record, const std::vector<SurfaceSample>& samples) {
  return farthest(record, samples);
}
double gap(const CurveRecord& record, const std::vector<CurveSample>& samples) {
  return farthest(record, samples);
}

}  // namespace octafront::cad
