#include "weld.h"

#include "measure.h"
#include "records.h"
#include "smooth.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>

#include <fmt/format.h>

namespace octafront::cad {

namespace {

/// Records are held to the tolerance of the shape, or to this part of the diagonal; on borders to the second one.
constexpr double kRecordError = 1e-7, kBorderGap = 1e-4;

Vec3 vec_of(const gp_Pnt& p) {
  return {p.X(), p.Y(), p.Z()};
}

class Welder {
 public:
  Welder(const Topology& topology, const Fineness& fineness, CadModel& model)
      : topology_(topology), fineness_(fineness), model_(model) {
    edges_.resize(topology.edges.size());
  }

  void weld(const std::vector<int>& rung, const std::function<void(std::size_t)>& on_face) {
    Box3 box;
    for (const Topology::OfFace& face : topology_.faces) box.add(quick_box(face.face));
    diagonal_ = box.diagonal();
    int without_record = 0, without_triangles = 0, coarser = 0;
    model_.edges.clear();
    for (std::size_t f = 0; f < topology_.faces.size(); ++f) {
      on_face(f);
      Face& face = model_.faces[f];
      if (!add_face(f))
        face.triangles = Face::Triangles::kNone, ++without_triangles;
      else if (rung[f] > 0)
        face.triangles = Face::Triangles::kCoarser, ++coarser;
      without_record += face.surface.kind == SurfaceRecord::Kind::kNone && face.triangles != Face::Triangles::kNone;
    }
    for (std::size_t e = 0; e < edges_.size(); ++e) add_edge(e);
    for (int v = 1; v <= vertex_map_.Extent(); ++v)
      model_.vertices.push_back(vertices_[static_cast<std::size_t>(v - 1)]);
    note_if(without_triangles, "could not be triangulated");
    note_if(coarser, "could be triangulated coarser than asked only");
    note_if(without_record, "have no geometry that the triangles lie on: points there stay on the triangles");
    if (gap_ > 0)
      model_.notes.push_back(fmt::format(
          "edges lie up to {:.2g} mm off their faces or vertices, more than the file's tolerances say", gap_));
    note_if(mismatched_, "do not have the same points along an edge as their neighbours");
  }

 private:
  struct EdgePoints {
    std::vector<VertexIndex> points;
    std::vector<double> parameters;
  };

  Allowed allowed(double tolerance) const {
    return {std::max(tolerance, kRecordError * diagonal_), std::max(tolerance, kBorderGap * diagonal_)};
  }

  /// A tolerance is what the file says, or what is found where that is more.
  void take_gap(double found, double& tolerance) {
    if (found > tolerance && found > kRecordError * diagonal_) gap_ = std::max(gap_, found);
    tolerance = std::max(tolerance, found);
    model_.tolerance = std::max(model_.tolerance, tolerance);
  }

  void note_if(int n, const char* what) {
    if (n > 0) model_.notes.push_back(fmt::format("{} of {} faces {}", n, model_.faces.size(), what));
  }

  VertexIndex add_point(Vec3 p) {
    model_.points.push_back(p);
    return static_cast<VertexIndex>(model_.points.size() - 1);
  }

  VertexIndex point_of_vertex(const TopoDS_Vertex& vertex) {
    const int known = vertex_map_.Extent(), i = vertex_map_.Add(vertex);
    if (i > known) vertices_.push_back(add_point(vec_of(BRep_Tool::Pnt(vertex))));
    return vertices_[static_cast<std::size_t>(i - 1)];
  }

  /// A point inside of an edge: on its curve, if the triangulation's node lies near enough.
  Vec3 point_on(const TopoDS_Edge& edge, double parameter, const gp_Pnt& node) {
    double first, last;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
    if (curve.IsNull()) return vec_of(node);
    const gp_Pnt on = curve->Value(parameter);
    return vec_of(on.Distance(node) <= BRep_Tool::Tolerance(edge) ? on : node);
  }

  /// The points of an edge, which the first face that has them makes for all.
  EdgePoints* points_of_edge(const TopoDS_Edge& edge, const Poly_PolygonOnTriangulation& polygon,
                             const Poly_Triangulation& mesh, const TopLoc_Location& place) {
    EdgePoints& known = edges_[static_cast<std::size_t>(topology_.edge_map.FindIndex(edge) - 1)];
    if (!known.points.empty()) return &known;
    TopoDS_Vertex first, last;
    TopExp::Vertices(edge, first, last);
    for (int i = 1, n = polygon.NbNodes(); i <= n; ++i) {
      const double parameter = polygon.HasParameters() ? polygon.Parameter(i) : i;
      known.parameters.push_back(parameter);
      if (i == 1 && !first.IsNull())
        known.points.push_back(point_of_vertex(first));
      else if (i == n && !last.IsNull())
        known.points.push_back(point_of_vertex(last));
      else if (i == n && first.IsNull() && last.IsNull())
        known.points.push_back(known.points.front());
      else
        known.points.push_back(
            add_point(point_on(edge, parameter, mesh.Node(polygon.Node(i)).Transformed(place.Transformation()))));
    }
    return &known;
  }

  /// Which point each node on an edge of the face is.
  void weld_edges(const TopoDS_Face& face, const Handle(Poly_Triangulation) & mesh, const TopLoc_Location& place,
                  std::vector<VertexIndex>& point) {
    for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
      const TopoDS_Edge edge = TopoDS::Edge(it.Current());
      const Handle(Poly_PolygonOnTriangulation) polygon = BRep_Tool::PolygonOnTriangulation(edge, mesh, place);
      if (polygon.IsNull()) continue;
      const int n = polygon->NbNodes();
      if (BRep_Tool::Degenerated(edge)) {
        const TopoDS_Vertex vertex = TopExp::FirstVertex(edge);
        for (int i = 1; i <= n && !vertex.IsNull(); ++i)
          point[static_cast<std::size_t>(polygon->Node(i) - 1)] = point_of_vertex(vertex);
        continue;
      }
      const EdgePoints& points = *points_of_edge(edge, *polygon, *mesh, place);
      if (static_cast<std::size_t>(n) != points.points.size()) {
        ++mismatched_;
        point[static_cast<std::size_t>(polygon->Node(1) - 1)] = points.points.front();
        point[static_cast<std::size_t>(polygon->Node(n) - 1)] = points.points.back();
        continue;
      }
      for (int i = 1; i <= n; ++i)
        point[static_cast<std::size_t>(polygon->Node(i) - 1)] = points.points[static_cast<std::size_t>(i - 1)];
    }
  }

  /// False: it has no triangles.
  bool add_face(std::size_t f) {
    const TopoDS_Face& shape = topology_.faces[f].face;
    const TopoDS_Face forward = TopoDS::Face(shape.Oriented(TopAbs_FORWARD));
    TopLoc_Location place;
    const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(forward, place);
    if (mesh.IsNull() || mesh->NbTriangles() == 0 || !mesh->HasUVNodes()) return false;
    std::vector<VertexIndex> point(static_cast<std::size_t>(mesh->NbNodes()), kNone);
    weld_edges(forward, mesh, place, point);
    std::vector<SurfaceSample> samples;
    for (int n = 1; n <= mesh->NbNodes(); ++n) {
      VertexIndex& p = point[static_cast<std::size_t>(n - 1)];
      const bool on_border = p != kNone;
      if (!on_border) p = add_point(vec_of(mesh->Node(n).Transformed(place.Transformation())));
      samples.push_back({{mesh->UVNode(n).X(), mesh->UVNode(n).Y()}, model_.points[p], on_border});
    }
    Face& face = model_.faces[f];
    face.surface = surface_record(forward, samples, allowed(tolerance_of(forward)));
    if (face.surface.kind != SurfaceRecord::Kind::kNone) take_gap(gap(face.surface, samples), face.tolerance);
    add_triangles_of(f, *mesh, point, samples, shape.Orientation() == TopAbs_REVERSED);
    set_range(forward, samples, face);
    return true;
  }

  void add_triangles_of(std::size_t f, const Poly_Triangulation& mesh, const std::vector<VertexIndex>& point,
                        const std::vector<SurfaceSample>& samples, bool reversed) {
    for (int t = 1; t <= mesh.NbTriangles(); ++t) {
      int node[3];
      mesh.Triangle(t).Get(node[0], node[1], node[2]);
      if (reversed) std::swap(node[1], node[2]);
      Triangle triangle;
      std::array<Uv, 3> corners;
      for (int k = 0; k < 3; ++k) {
        const auto n = static_cast<std::size_t>(node[k] - 1);
        triangle[static_cast<std::size_t>(k)] = point[n], corners[static_cast<std::size_t>(k)] = samples[n].at;
      }
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
      model_.triangles.push_back(triangle);
      model_.corners.push_back(corners);
      model_.face_of.push_back(static_cast<std::uint32_t>(f));
    }
  }

  static void set_range(const TopoDS_Face& shape, const std::vector<SurfaceSample>& samples, Face& face) {
    face.low = face.high = samples[0].at;
    for (const SurfaceSample& s : samples) {
      face.low = {std::min(face.low.u, s.at.u), std::min(face.low.v, s.at.v)};
      face.high = {std::max(face.high.u, s.at.u), std::max(face.high.v, s.at.v)};
    }
    // Borders that bulge between their points; for the parameters that the face itself has.
    if (face.surface.kind == SurfaceRecord::Kind::kNurbs || face.surface.kind == SurfaceRecord::Kind::kNone) return;
    Uv lo, hi;
    BRepTools::UVBounds(shape, lo.u, hi.u, lo.v, hi.v);
    face.low = {std::min(face.low.u, lo.u), std::min(face.low.v, lo.v)};
    face.high = {std::max(face.high.u, hi.u), std::max(face.high.v, hi.v)};
  }

  /// For an edge that no triangulated face has: its curve, sampled.
  void sample(const TopoDS_Edge& edge, EdgePoints& points) {
    TopoDS_Vertex first, last;
    TopExp::Vertices(edge, first, last);
    if (first.IsNull() || last.IsNull()) return;
    try {
      const BRepAdaptor_Curve curve(edge);
      const GCPnts_TangentialDeflection sampled(curve, fineness_.angle, fineness_.deflection);
      for (int i = 1, n = sampled.NbPoints(); i <= n; ++i) {
        points.parameters.push_back(sampled.Parameter(i));
        points.points.push_back(i == 1   ? point_of_vertex(first)
                                : i == n ? point_of_vertex(last)
                                         : add_point(vec_of(sampled.Value(i))));
      }
    } catch (const Standard_Failure&) {
      points = {};
    }
  }

  void add_edge(std::size_t e) {
    const Topology::OfEdge& shape = topology_.edges[e];
    EdgePoints& points = edges_[e];
    if (points.points.empty()) sample(shape.edge, points);
    if (points.points.size() < 2) return;
    CadEdge edge;
    edge.faces = shape.faces;
    edge.tolerance = BRep_Tool::Tolerance(shape.edge);
    edge.length = length_of(shape.edge);
    edge.vertices = points.points;
    const bool one_plane = is_smooth_across(topology_, shape, points.parameters);
    const bool seam = shape.faces.size() == 1 && BRep_Tool::IsClosed(shape.edge, topology_.faces[shape.faces[0]].face);
    edge.is_seam = seam && one_plane;
    edge.is_smooth = shape.faces.size() == 2 && one_plane;
    std::vector<CurveSample> samples;
    for (std::size_t i = 0, n = points.points.size(); i < n; ++i)
      samples.push_back({points.parameters[i], model_.points[points.points[i]], i == 0 || i + 1 == n});
    edge.curve = curve_record(shape.edge, samples, allowed(edge.tolerance));
    if (edge.curve.kind != CurveRecord::Kind::kNone) take_gap(gap(edge.curve, samples), edge.tolerance);
    for (const CurveSample& s : samples) edge.parameters.push_back(s.at);
    model_.edges.push_back(std::move(edge));
  }

  const Topology& topology_;
  const Fineness& fineness_;
  CadModel& model_;
  std::vector<EdgePoints> edges_;
  TopTools_IndexedMapOfShape vertex_map_;
  std::vector<VertexIndex> vertices_;
  double diagonal_ = 0, gap_ = 0;
  int mismatched_ = 0;
};

/// Of each solid, whether every edge of its triangles is run through as often one way as the other.
void find_closed(CadModel& model) {
  std::vector<std::vector<std::array<VertexIndex, 2>>> ways(model.solids.size());
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const Sides& sides = model.faces[model.face_of[t]].sides;
    const Triangle& c = model.triangles[t];
    for (int k = 0; k < 3; ++k) {
      const VertexIndex a = c[static_cast<std::size_t>(k)], b = c[static_cast<std::size_t>((k + 1) % 3)];
      if (sides[1] != kNone) ways[sides[1]].push_back({a, b});
      if (sides[0] != kNone) ways[sides[0]].push_back({b, a});
    }
  }
  for (std::size_t s = 0; s < ways.size(); ++s) {
    std::vector<std::array<VertexIndex, 2>> back;
    for (const auto& [a, b] : ways[s]) back.push_back({b, a});
    std::sort(ways[s].begin(), ways[s].end()), std::sort(back.begin(), back.end());
    model.solids[s].closed = !back.empty() && ways[s] == back;
  }
}

}  // namespace

void add_triangles(const Part&, const Topology& topology, const Fineness& fineness, const std::vector<int>& rung,
                   const std::function<void(std::size_t)>& on_face, CadModel& model) {
  Welder(topology, fineness, model).weld(rung, on_face);
  find_closed(model);
}

}  // namespace octafront::cad
