#include "surface/lines/curves.h"

#include <algorithm>
#include <map>

namespace octafront::surface {

namespace {

/// Directions along the curve that differ by more than 40 degrees over an element's size make a corner ...
constexpr double kCornerCosine = 0.766;
/// ... of several within this distance the sharpest, unless they turn by more than 75 degrees.
constexpr double kCornerDistance = 0.8, kSharpCornerCosine = 0.259;
/// A division point this close to a vertex of the curve, in segments, is that vertex. Two points are a segment apart:
/// they never become the same vertex.
constexpr double kSnapInSegments = 0.02;

struct FeatureGraph {
  std::vector<std::uint32_t> degree;
  std::vector<std::uint8_t> corner;
};

double edge_length(const HalfEdgeMesh& mesh, HalfEdge h) {
  return distance(mesh.points[mesh.start[h]], mesh.points[mesh.end(h)]);
}

/// The feature half-edge that continues h beyond its end, where exactly one other feature edge meets it.
HalfEdge continued(const HalfEdgeMesh& mesh, HalfEdge h) {
  HalfEdge result = kNone;
  mesh.for_each_outgoing(mesh.end(h), [&](HalfEdge o) {
    if (mesh.is_feature[o] && o != mesh.twin[h]) result = o;
  });
  return result;
}

/// The point about `reach` along the curve from the start of h, or where it ends.
Vec3 point_along(const HalfEdgeMesh& mesh, const FeatureGraph& graph, HalfEdge h, double reach) {
  const HalfEdge first = h;
  for (;;) {
    const double l = edge_length(mesh, h);
    const Vec3 a = mesh.points[mesh.start[h]], b = mesh.points[mesh.end(h)];
    if (l >= reach) return a + (b - a) * (reach / l);
    reach -= l;
    if (graph.degree[mesh.end(h)] != 2) return b;
    const HalfEdge further = continued(mesh, h);
    if (further == kNone || further == first) return b;
    h = further;
  }
}

struct Bend {
  double cosine;  ///< of the turn
  VertexIndex vertex;
};

Bend bend_at(const HalfEdgeMesh& mesh, const FeatureGraph& graph, VertexIndex v, double reach) {
  std::vector<Vec3> directions;
  mesh.for_each_outgoing(v, [&](HalfEdge h) {
    if (mesh.is_feature[h]) directions.push_back(normalized(point_along(mesh, graph, h, reach) - mesh.points[v]));
  });
  return {-dot(directions[0], directions[1]), v};
}

/// Whether there is a corner within `reach` along either side of the curve.
bool has_corner_near(const HalfEdgeMesh& mesh, const FeatureGraph& graph, VertexIndex v, double reach) {
  bool found = false;
  mesh.for_each_outgoing(v, [&](HalfEdge h) {
    if (!mesh.is_feature[h]) return;
    double path = 0;
    const HalfEdge first = h;
    for (HalfEdge at = h; at != kNone; at = continued(mesh, at)) {
      path += edge_length(mesh, at);
      if (path > reach) break;
      if (graph.corner[mesh.end(at)]) found = true;
      if (graph.degree[mesh.end(at)] != 2 || mesh.end(at) == mesh.start[first]) break;
    }
  });
  return found;
}

/// Vertices inside chains where they bend, the sharpest first.
void mark_bends(const HalfEdgeMesh& mesh, const std::vector<VertexIndex>& corners, const SizeField& sizes,
                FeatureGraph& graph) {
  std::vector<Bend> bends;
  for (const VertexIndex v : corners) {
    if (graph.degree[v] != 2) continue;
    const Bend bend = bend_at(mesh, graph, v, 0.5 * sizes.at(mesh.points[v]));
    if (bend.cosine < kCornerCosine) bends.push_back(bend);
  }
  std::sort(bends.begin(), bends.end(), [](const Bend& a, const Bend& b) {
    return a.cosine != b.cosine ? a.cosine < b.cosine : a.vertex < b.vertex;
  });
  for (const Bend& bend : bends) {
    const double reach = kCornerDistance * sizes.at(mesh.points[bend.vertex]);
    if (bend.cosine >= kSharpCornerCosine && has_corner_near(mesh, graph, bend.vertex, reach)) continue;
    graph.corner[bend.vertex] = 1;
  }
}

FeatureGraph make_graph(const InputSurface& input, const std::vector<VertexIndex>& corners,
                        const std::vector<std::uint8_t>& is_fixed, const SizeField& sizes) {
  const HalfEdgeMesh& mesh = input.mesh;
  FeatureGraph graph;
  graph.degree.assign(mesh.points.size(), 0);
  for (HalfEdge h = 0; h < mesh.start.size(); ++h) graph.degree[mesh.start[h]] += mesh.is_feature[h];
  graph.corner.assign(mesh.points.size(), 0);
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
    const bool must_stay = !is_fixed.empty() && is_fixed[v];
    graph.corner[v] = graph.degree[v] != 0 && (graph.degree[v] != 2 || must_stay);
  }
  mark_bends(mesh, corners, sizes, graph);
  return graph;
}

Curve follow(const HalfEdgeMesh& mesh, const FeatureGraph& graph, HalfEdge first, std::vector<std::uint8_t>& visited) {
  Curve curve;
  for (HalfEdge h = first; h != kNone && !visited[h];) {
    visited[h] = visited[mesh.twin[h]] = 1;
    curve.half_edges.push_back(h);
    curve.reach.push_back(edge_length(mesh, h) + (curve.reach.empty() ? 0 : curve.reach.back()));
    if (graph.corner[mesh.end(h)]) break;
    h = continued(mesh, h);
  }
  curve.closed = !graph.corner[mesh.start[first]];
  return curve;
}

/// The integral of ds / h along a curve, tabulated.
struct Measure {
  struct Piece {
    std::uint32_t edge;  ///< index into curve.half_edges
    double t0, t1;       ///< part of that edge
    double sum;          ///< the integral up to its end
  };
  std::vector<Piece> pieces;
  double total = 0;
};

/// Pieces of one edge are at most half an element long; a longer table than this is no more precise.
constexpr double kMostPieces = 100000;

Measure measure(const InputSurface& input, const SizeField& sizes, const Curve& curve) {
  const HalfEdgeMesh& mesh = input.mesh;
  Measure m;
  for (std::uint32_t e = 0; e < curve.half_edges.size(); ++e) {
    const HalfEdge h = curve.half_edges[e];
    const Vec3 a = mesh.points[mesh.start[h]], b = mesh.points[mesh.end(h)];
    const double l = distance(a, b);
    for (double t = 0; t < 1;) {
      const double step = std::max(0.5 * sizes.at(a + (b - a) * t) / std::max(l, 1e-300), 1 / kMostPieces);
      const double end = t + 1.5 * step >= 1 ? 1 : t + step;
      m.total += l * (end - t) / sizes.at(a + (b - a) * (0.5 * (t + end)));
      m.pieces.push_back({e, t, end, m.total});
      t = end;
    }
  }
  return m;
}

double along_of(const Curve& curve, std::size_t edge, double t) {
  const double before = edge > 0 ? curve.reach[edge - 1] : 0;
  return before + t * (curve.reach[edge] - before);
}

CurvePoint point_at(const InputSurface& input, const Curve& curve, const Measure& m, std::size_t& piece, double at) {
  while (piece + 1 < m.pieces.size() && m.pieces[piece].sum < at) ++piece;
  const Measure::Piece& q = m.pieces[piece];
  const double before = piece > 0 ? m.pieces[piece - 1].sum : 0;
  const double s = q.sum > before ? std::clamp((at - before) / (q.sum - before), 0.0, 1.0) : 0.5;
  CurvePoint c;
  c.half_edge = curve.half_edges[q.edge];
  c.t = q.t0 + s * (q.t1 - q.t0);
  const Vec3 a = input.mesh.points[input.mesh.start[c.half_edge]], b = input.mesh.points[input.mesh.end(c.half_edge)];
  c.p = a + (b - a) * c.t;
  c.along = along_of(curve, q.edge, c.t);
  return c;
}

void snap_to_vertex(const HalfEdgeMesh& mesh, double segment, CurvePoint& c) {
  const double l = edge_length(mesh, c.half_edge), tolerance = kSnapInSegments * segment;
  if (c.t * l < tolerance) {
    c.vertex = mesh.start[c.half_edge];
  } else if ((1 - c.t) * l < tolerance) {
    c.vertex = mesh.end(c.half_edge);
  }
  if (c.vertex != kNone) c.p = mesh.points[c.vertex];
}

void divide_curve(const InputSurface& input, const SizeField& sizes, const Measure& m, int segments, Curve& curve) {
  const HalfEdgeMesh& mesh = input.mesh;
  std::size_t piece = 0, middle_piece = 0;
  for (int i = 0; i <= segments; ++i) {
    CurvePoint c = point_at(input, curve, m, piece, m.total * i / segments);
    c.h = sizes.at(c.p);
    if (i == 0) c.vertex = mesh.start[curve.half_edges.front()];
    if (i == segments) c.vertex = mesh.end(curve.half_edges.back());
    if (c.vertex != kNone) {
      c.p = mesh.points[c.vertex];
    } else {
      snap_to_vertex(mesh, c.h * m.total / segments, c);
    }
    if (i > 0) {
      curve.middles.push_back(point_at(input, curve, m, middle_piece, m.total * (i - 0.5) / segments));
      curve.middles.back().h = sizes.at(curve.middles.back().p);
    }
    curve.samples.push_back(c);
  }
}

/// Brings the points of a curve to where they have copies.
void settle(const HalfEdgeMesh& mesh, const PeriodicCell& cell, Curve& curve) {
  if (cell.is_box()) return;
  const auto settled = [&](CurvePoint& c) {
    if (c.vertex == kNone)
      c.p = cell.settled(c.p, mesh.points[mesh.start[c.half_edge]], mesh.points[mesh.end(c.half_edge)]);
  };
  for (CurvePoint& c : curve.samples) settled(c);
  for (CurvePoint& c : curve.middles) settled(c);
}

/// The division of a curve, on a copy of it at another place.
void copy_division(const HalfEdgeMesh& mesh, const PeriodicCell& cell, const Curve& of, Curve& copy) {
  Vec3 from = mesh.points[mesh.start[of.half_edges.front()]], to = mesh.points[mesh.start[copy.half_edges.front()]];
  // What lies on the axis of a rotation stays.
  if (from == to)
    from = mesh.points[mesh.end(of.half_edges.front())], to = mesh.points[mesh.end(copy.half_edges.front())];
  const auto copied = [&](CurvePoint c) {
    const auto edge = std::find(of.half_edges.begin(), of.half_edges.end(), c.half_edge) - of.half_edges.begin();
    const bool at_start = c.vertex != kNone && c.vertex == mesh.start[c.half_edge];
    c.half_edge = copy.half_edges[static_cast<std::size_t>(edge)];
    if (c.vertex != kNone) c.vertex = at_start ? mesh.start[c.half_edge] : mesh.end(c.half_edge);
    c.p = cell.carried(c.p, from, to);
    return c;
  };
  copy.samples.clear(), copy.middles.clear();
  for (const CurvePoint& c : of.samples) copy.samples.push_back(copied(c));
  for (const CurvePoint& c : of.middles) copy.middles.push_back(copied(c));
}

/// Curves that turn by more than this, in radians, are arcs, and get no fewer segments than asked for: a quarter of a
/// circle by 18 a turn five, not four. This much less than one is none.
constexpr double kArc = 0.5, kPartOfSegment = 0.1;

bool is_arc(const HalfEdgeMesh& mesh, const Curve& curve) {
  double turned = 0;
  const auto way = [&](HalfEdge h) { return normalized(mesh.points[mesh.end(h)] - mesh.points[mesh.start[h]]); };
  for (std::size_t i = 1; i < curve.half_edges.size(); ++i)
    turned += distance(way(curve.half_edges[i - 1]), way(curve.half_edges[i]));
  return turned > kArc;
}

int segments_of(const HalfEdgeMesh& mesh, const Curve& curve, double wanted) {
  const double most = std::min(wanted, 1e9);
  return static_cast<int>(is_arc(mesh, curve) ? std::ceil(most - kPartOfSegment) : std::lround(most));
}

}  // namespace

std::vector<Curve> chain_curves(const InputSurface& input, const std::vector<VertexIndex>& corners,
                                const std::vector<std::uint8_t>& is_fixed, const SizeField& sizes) {
  const HalfEdgeMesh& mesh = input.mesh;
  const FeatureGraph graph = make_graph(input, corners, is_fixed, sizes);
  std::vector<std::uint8_t> visited(mesh.start.size(), 0);
  std::vector<Curve> curves;
  const auto chain_from = [&](VertexIndex v) {
    mesh.for_each_outgoing(v, [&](HalfEdge h) {
      if (mesh.is_feature[h] && !visited[h]) curves.push_back(follow(mesh, graph, h, visited));
    });
  };
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
    if (graph.corner[v]) chain_from(v);
  }
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
    if (graph.degree[v] != 0 && !graph.corner[v]) chain_from(v);
  }
  return curves;
}

std::vector<std::uint8_t> corner_marks(const InputSurface& input, const std::vector<VertexIndex>& corners,
                                       const std::vector<std::uint8_t>& is_fixed, const SizeField& sizes) {
  return make_graph(input, corners, is_fixed, sizes).corner;
}

CurvePoint point_along(const InputSurface& input, const Curve& curve, double along) {
  const auto at = std::upper_bound(curve.reach.begin(), curve.reach.end() - 1, along) - curve.reach.begin();
  const double before = at > 0 ? curve.reach[at - 1] : 0, l = curve.reach[at] - before;
  CurvePoint c;
  c.half_edge = curve.half_edges[at];
  c.t = l > 0 ? std::clamp((along - before) / l, 0.0, 1.0) : 0;
  c.along = along;
  const Vec3 a = input.mesh.points[input.mesh.start[c.half_edge]], b = input.mesh.points[input.mesh.end(c.half_edge)];
  c.p = a + (b - a) * c.t;
  return c;
}

void divide_curves(const InputSurface& input, const SizeField& sizes, std::vector<Curve>& curves,
                   const SharedCurves& shared) {
  const HalfEdgeMesh& mesh = input.mesh;
  std::vector<Measure> measures;
  std::vector<int> segments;
  std::map<Edge, int> single;
  const auto place = [&](VertexIndex v) { return shared.place.empty() ? v : shared.place[v]; };
  const auto is_first = [&](std::size_t i) { return shared.group.empty() || shared.group[i] == i; };
  const auto ends = [&](const Curve& c) {
    const VertexIndex a = place(mesh.start[c.half_edges.front()]), b = place(mesh.end(c.half_edges.back()));
    return Edge{std::min(a, b), std::max(a, b)};
  };
  const auto twin = [&](std::size_t i) { return shared.twin.empty() ? i : std::size_t{shared.twin[i]}; };
  const auto is_elsewhere = [&](std::size_t i) { return twin(i) != i && shared.group[i] != shared.group[twin(i)]; };
  for (std::size_t i = 0; i < curves.size(); ++i) {
    measures.push_back(measure(input, sizes, curves[i]));
    const Edge e = ends(curves[i]);
    const int least = e[0] == e[1] ? 3 : 1;
    segments.push_back(std::max(least, segments_of(mesh, curves[i], measures.back().total)));
    if (is_elsewhere(i)) segments[i] = segments[twin(i)];
    if (segments.back() == 1 && is_first(i)) ++single[e];
  }
  std::vector<std::uint8_t> is_halved(curves.size(), 0);
  for (std::size_t i = 0; i < curves.size(); ++i)
    if (segments[i] == 1 && single[ends(curves[i])] > 1) is_halved[twin(i)] = 1;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (is_elsewhere(i)) {
      copy_division(mesh, *shared.cell, curves[twin(i)], curves[i]);
      continue;
    }
    if (is_halved[twin(i)]) segments[i] = 2;
    curves[i].samples.clear();
    curves[i].middles.clear();
    divide_curve(input, sizes, measures[i], segments[i], curves[i]);
    if (shared.cell) settle(mesh, *shared.cell, curves[i]);
  }
}

}  // namespace octafront::surface
