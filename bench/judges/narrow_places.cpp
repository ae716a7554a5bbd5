#include "narrow_places.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Curve2d.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>

namespace octafront {

namespace {

/// Below these elements of less than 10 degrees or beta .2 need no excuse: what octafront itself calls narrow.
constexpr double kNarrowAngle = 20, kNarrowPart = 0.1;
/// Places on an edge where angles and distances are looked at lie so near, in parts of the reach, and are so many at
/// most.
constexpr double kSpacing = 0.05;
constexpr int kMostSamples = 20000;
constexpr double kDegrees = 180 / std::numbers::pi;

Vec3 vec(const gp_XYZ& p) {
  return {p.X(), p.Y(), p.Z()};
}

double degrees_between(Vec3 a, Vec3 b) {
  return kDegrees * std::atan2(length(cross(a, b)), dot(a, b));
}

/// A face at an edge of it.
struct Side {
  Vec3 normal;  ///< out of the solid
  Vec3 inward;  ///< from the edge into the face
};

std::optional<Side> side_of(const TopoDS_Face& face, const TopoDS_Edge& edge, double t) {
  const BRepAdaptor_Curve2d on_face(edge, face);
  const gp_Pnt2d uv = on_face.Value(t);
  gp_Pnt p;
  gp_Vec du, dv, tangent;
  BRepAdaptor_Surface(face, false).D1(uv.X(), uv.Y(), p, du, dv);
  BRepAdaptor_Curve(edge).D1(t, p, tangent);
  Vec3 normal = vec(du.Crossed(dv).XYZ()), along = vec(tangent.XYZ());
  if (length(normal) == 0 || length(along) == 0) return std::nullopt;
  if (face.Orientation() == TopAbs_REVERSED) normal = -normal;
  if (edge.Orientation() == TopAbs_REVERSED) along = -along;
  return Side{normalized(normal), normalized(cross(normal, along))};
}

}  // namespace

bool Narrow::forces_poor_elements() const {
  return std::min(wedge, corner) < kNarrowAngle || std::min(edge, gap) < kNarrowPart;
}

struct NarrowPlaces::Edge {
  struct Use {
    TopoDS_Face face;
    TopoDS_Edge edge;  ///< as the face turns it
  };
  TopoDS_Edge edge;
  TopoDS_Vertex ends[2];
  double length = 0;
  Box3 box;
  std::vector<Use> uses;

  struct Sample {
    double t;
    Vec3 p;
  };

  bool is_near(Vec3 place, double reach) const {
    Box3 around;
    around.add(place - Vec3{reach, reach, reach}), around.add(place + Vec3{reach, reach, reach});
    return box.overlaps(around);
  }

  std::vector<Sample> samples_near(Vec3 place, double reach) const {
    std::vector<Sample> near;
    const BRepAdaptor_Curve curve(edge);
    const int n = static_cast<int>(std::clamp(std::ceil(length / (kSpacing * reach)), 8.0, double{kMostSamples}));
    for (int i = 0; i <= n; ++i) {
      const double t = curve.FirstParameter() + (curve.LastParameter() - curve.FirstParameter()) * i / n;
      const Vec3 p = vec(curve.Value(t).XYZ());
      if (distance(p, place) <= reach) near.push_back({t, p});
    }
    return near;
  }

  /// Degrees between its two faces inside the solid; a seam and an edge of one face alone have none.
  double wedge(double t, bool inside_out) const {
    if (uses.size() != 2 || uses[0].face.IsSame(uses[1].face)) return HUGE_VAL;
    const auto a = side_of(uses[0].face, uses[0].edge, t), b = side_of(uses[1].face, uses[1].edge, t);
    if (!a || !b) return HUGE_VAL;
    const double between = degrees_between(a->inward, b->inward);
    const bool convex = (dot(a->normal, b->inward) < 0) != inside_out;
    return convex ? between : 360 - between;
  }

  bool meets_within(const Edge& other, Vec3 place, double reach) const {
    for (const TopoDS_Vertex& a : ends)
      for (const TopoDS_Vertex& b : other.ends)
        if (!a.IsNull() && a.IsSame(b) && distance(vec(BRep_Tool::Pnt(a).XYZ()), place) <= reach) return true;
    return false;
  }
};

struct NarrowPlaces::Solid {
  std::vector<Edge> edges;
  bool inside_out = false;

  explicit Solid(const TopoDS_Shape& shape) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(shape, properties);
    inside_out = properties.Mass() < 0;
    TopTools_IndexedMapOfShape map;
    for (TopExp_Explorer f(shape, TopAbs_FACE); f.More(); f.Next())
      for (TopExp_Explorer e(f.Current(), TopAbs_EDGE); e.More(); e.Next())
        if (!BRep_Tool::Degenerated(TopoDS::Edge(e.Current())))
          add(map.Add(e.Current()), TopoDS::Face(f.Current()), TopoDS::Edge(e.Current()));
  }

  void add(int number, const TopoDS_Face& face, const TopoDS_Edge& edge) {
    if (static_cast<std::size_t>(number) > edges.size()) {
      edges.emplace_back();
      Edge& made = edges.back();
      made.edge = edge;
      TopExp::Vertices(edge, made.ends[0], made.ends[1]);
      GProp_GProps properties;
      BRepGProp::LinearProperties(edge, properties);
      made.length = properties.Mass();
      Bnd_Box bounds;
      BRepBndLib::Add(edge, bounds, false);
      bounds.Get(made.box.lo.x, made.box.lo.y, made.box.lo.z, made.box.hi.x, made.box.hi.y, made.box.hi.z);
    }
    edges[static_cast<std::size_t>(number) - 1].uses.push_back({face, edge});
  }
};

namespace {

/// The least angle between edges of one face at a vertex of both that is within reach.
template <class Edge>
double corner_between(const Edge& a, const Edge& b, Vec3 place, double reach) {
  double least = HUGE_VAL;
  const auto direction = [](const Edge& e, int end) {
    const BRepAdaptor_Curve curve(e.edge);
    gp_Pnt p;
    gp_Vec d;
    const bool at_first = end == 0;
    curve.D1(at_first ? curve.FirstParameter() : curve.LastParameter(), p, d);
    return at_first ? vec(d.XYZ()) : -vec(d.XYZ());
  };
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      if (a.ends[i].IsNull() || !a.ends[i].IsSame(b.ends[j])) continue;
      if (distance(vec(BRep_Tool::Pnt(a.ends[i]).XYZ()), place) > reach) continue;
      least = std::min(least, degrees_between(direction(a, i), direction(b, j)));
    }
  return least;
}

template <class Edge>
bool share_a_face(const Edge& a, const Edge& b) {
  for (const auto& u : a.uses)
    for (const auto& v : b.uses)
      if (u.face.IsSame(v.face)) return true;
  return false;
}

/// Where two edges are nearest to one another, by their samples.
struct Nearest {
  double distance = HUGE_VAL, farthest = 0;  ///< `farthest`: of the first one's samples from the second
  double on_a = 0, on_b = 0;                 ///< parameters
};

template <class Samples>
Nearest nearest_of(const Samples& a, const Samples& b) {
  Nearest found;
  for (const auto& p : a) {
    double least = HUGE_VAL;
    for (const auto& q : b) {
      const double d = distance(p.p, q.p);
      least = std::min(least, d);
      if (d < found.distance) found.distance = d, found.on_a = p.t, found.on_b = q.t;
    }
    found.farthest = std::max(found.farthest, least);
  }
  return found;
}

/// Between lines, whichever way they run.
template <class Edge>
double angle_between(const Edge& a, const Edge& b, const Nearest& at) {
  const auto along = [](const Edge& e, double t) {
    gp_Pnt p;
    gp_Vec d;
    BRepAdaptor_Curve(e.edge).D1(t, p, d);
    return vec(d.XYZ());
  };
  const double angle = degrees_between(along(a, at.on_a), along(b, at.on_b));
  return std::min(angle, 180 - angle);
}

}  // namespace

NarrowPlaces::NarrowPlaces(const TopoDS_Shape& shape) : solids_(std::make_unique<std::vector<Solid>>()) {
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) solids_->emplace_back(it.Current());
  if (solids_->empty()) solids_->emplace_back(shape);
}

NarrowPlaces::~NarrowPlaces() = default;

struct NarrowPlaces::Near {
  const Solid* solid;
  const Edge* edge;
  std::vector<Edge::Sample> samples;
};

std::vector<NarrowPlaces::Near> NarrowPlaces::edges_near(Vec3 place, double reach) const {
  std::vector<Near> near;
  for (const Solid& solid : *solids_)
    for (const Edge& edge : solid.edges) {
      if (!edge.is_near(place, reach)) continue;
      auto samples = edge.samples_near(place, reach);
      if (!samples.empty()) near.push_back({&solid, &edge, std::move(samples)});
    }
  return near;
}

Narrow NarrowPlaces::at(Vec3 place, double reach) const {
  Narrow found;
  const std::vector<Near> near = edges_near(place, reach);
  for (const Near& a : near) {
    found.edge = std::min(found.edge, a.edge->length / reach);
    for (const Edge::Sample& s : a.samples)
      found.wedge = std::min(found.wedge, a.edge->wedge(s.t, a.solid->inside_out));
    for (const Near* b = &a + 1; b != near.data() + near.size(); ++b) {
      if (a.solid == b->solid && a.edge->meets_within(*b->edge, place, reach)) {
        if (share_a_face(*a.edge, *b->edge))
          found.corner = std::min(found.corner, corner_between(*a.edge, *b->edge, place, reach));
        continue;
      }
      const Nearest at = nearest_of(a.samples, b->samples);
      if (a.solid == b->solid)
        found.gap = std::min(found.gap, at.distance / reach);
      else if (at.distance < kNarrowPart * reach && at.farthest > kSpacing * reach)  // not one on the other
        found.corner = std::min(found.corner, angle_between(*a.edge, *b->edge, at));
    }
  }
  return found;
}

}  // namespace octafront
