#include "base/core/flat_map.h"
#include "base/mesh/labels.h"
#include "base/mesh/renumber_mesh.h"
#include "layers/through.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

namespace octafront::layers {

namespace {

/// The nodes of one pass, by their edges.
class Nodes {
 public:
  Nodes(std::vector<Vec3>& points, const std::vector<Span>& spans, std::uint32_t parts)
      : points_(points), spans_(spans) {
    for (std::uint32_t s = 0; s < spans.size(); ++s) {
      const auto& [low, high] = spans[s];
      number_.find_or_add(sorted_edge(low, high), kNone) = s;
      const Vec3 from = points[low], way = points[high] - from;
      length_.push_back(squared_length(way));
      if (s == 0) first_ = static_cast<VertexIndex>(points.size());
      points.push_back(from + way / static_cast<double>(parts));
    }
  }

  VertexIndex first() const { return first_; }
  VertexIndex node(std::uint32_t span) const { return first_ + span; }
  const Span& span_of(VertexIndex node) const { return spans_[node - first_]; }
  bool is_node(VertexIndex v) const { return v >= first_; }
  /// kNone: the edge is not divided.
  std::uint32_t span(VertexIndex a, VertexIndex b) const {
    const std::uint32_t* found = number_.find(sorted_edge(a, b));
    return found == nullptr ? kNone : *found;
  }

  /// The edge of an element or a face that is divided first: the longest one; kNone, kNone: none is.
  template <std::size_t kCorners>
  std::pair<std::size_t, std::size_t> first_of(const std::array<VertexIndex, kCorners>& corners) const {
    std::pair<std::size_t, std::size_t> best{kCorners, kCorners};
    std::uint32_t best_span = kNone;
    for (std::size_t i = 0; i < kCorners; ++i)
      for (std::size_t j = i + 1; j < kCorners; ++j) {
        const std::uint32_t s = span(corners[i], corners[j]);
        if (s == kNone) continue;
        const bool is_later = best_span != kNone &&
                              (length_[s] < length_[best_span] || (length_[s] == length_[best_span] && s > best_span));
        if (is_later) continue;
        best = {i, j};
        best_span = s;
      }
    return best;
  }

  /// Calls take(part) for each part of an element or a face; the same parts whatever the order of its corners.
  template <std::size_t kCorners, class Take>
  void divide(const std::array<VertexIndex, kCorners>& whole, const Take& take) const {
    auto [i, j] = first_of(whole);
    if (i == kCorners) return take(whole);
    if (whole[i] > whole[j]) std::swap(i, j);
    const VertexIndex middle = node(span(whole[i], whole[j]));
    std::array<VertexIndex, kCorners> part = whole;
    part[j] = middle;
    divide(part, take);
    part = whole;
    part[i] = middle;
    divide(part, take);
  }

 private:
  std::vector<Vec3>& points_;
  const std::vector<Span>& spans_;
  VertexIndex first_ = kNone;
  std::vector<double> length_;
  FlatMap<Edge, std::uint32_t> number_;
};

/// The parts of all faces of a list, and which face each one was.
struct DividedFaces {
  std::vector<Triangle> faces;
  std::vector<std::uint32_t> parent;
};

DividedFaces divided(const std::vector<Triangle>& faces, const Nodes& nodes) {
  DividedFaces made;
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    nodes.divide(faces[f], [&](const Triangle& part) {
      made.faces.push_back(part);
      made.parent.push_back(f);
    });
  return made;
}

void divide_surface(SurfaceMesh& surface, std::vector<std::uint32_t>& parent, const Nodes& nodes) {
  DividedFaces made = divided(surface.triangles, nodes);
  surface.patch = of_items(surface.patch, made.parent);
  surface.source = of_items(surface.source, made.parent);
  surface.sides = of_items(surface.sides, made.parent);
  parent = of_items(parent, made.parent);
  surface.triangles = std::move(made.faces);
}

void divide_edges(std::vector<Edge>& edges, const Nodes& nodes) {
  std::vector<Edge> made;
  for (const auto& [a, b] : edges) {
    const std::uint32_t s = nodes.span(a, b);
    if (s == kNone) {
      made.push_back({a, b});
    } else {
      made.push_back(sorted_edge(a, nodes.node(s)));
      made.push_back(sorted_edge(nodes.node(s), b));
    }
  }
  std::sort(made.begin(), made.end());
  edges = std::move(made);
}

/// Elements and faces, and what hangs on them.
void divide_mesh(TetMesh& mesh, const Nodes& nodes, SplitSpans& done) {
  const TetMesh before = std::exchange(mesh, {});
  mesh.points = before.points;
  Origins from;
  from.nodes.resize(nodes.first());
  std::iota(from.nodes.begin(), from.nodes.end(), VertexIndex{0});
  from.nodes.resize(mesh.points.size(), kNone);
  mesh.tets.reserve(2 * before.tets.size());
  for (TetIndex t = 0; t < before.tets.size(); ++t) {
    const std::size_t first = mesh.tets.size();
    nodes.divide(before.tets[t], [&](const Tet& part) {
      mesh.tets.push_back(part);
      from.tets.push_back(t);
    });
    const std::size_t parts = mesh.tets.size() - first;
    if (parts == 1) continue;
    ++done.elements;
    done.made += parts;
  }
  DividedFaces outer = divided(before.boundary, nodes), inner = divided(before.interfaces, nodes);
  from.faces = std::move(outer.parent);
  for (const std::uint32_t p : inner.parent)
    from.faces.push_back(p + static_cast<std::uint32_t>(before.boundary.size()));
  mesh.boundary = std::move(outer.faces);
  mesh.interfaces = std::move(inner.faces);
  inherit(mesh, before, from);
}

/// What is left to be divided, from the nodes of the last pass to the high side.
std::vector<Span> next_spans(const TetMesh& mesh, const Nodes& nodes) {
  std::vector<std::pair<VertexIndex, VertexIndex>> found;
  for (const Tet& tet : mesh.tets)
    for (const auto& [i, j] : kTetEdges) {
      VertexIndex m = tet[static_cast<std::size_t>(i)], w = tet[static_cast<std::size_t>(j)];
      if (nodes.is_node(m) == nodes.is_node(w)) continue;
      if (nodes.is_node(w)) std::swap(m, w);
      const Span& of = nodes.span_of(m);
      const std::uint32_t other = nodes.span(of.low, w);
      const bool rises = w == of.high || (other != kNone && w != of.low && nodes.span_of(nodes.node(other)).high == w);
      if (rises) found.emplace_back(m, w);
    }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  std::vector<Span> spans;
  for (const auto& [low, high] : found) spans.push_back({low, high});
  return spans;
}

/// From the vertices as they were made to their numbers: those of the surface first.
std::vector<VertexIndex> numbering(const TetMesh& mesh, const SurfaceMesh& surface) {
  std::vector<std::uint8_t> is_on_surface(mesh.points.size(), 0);
  for (std::size_t v = 0; v < surface.points.size(); ++v) is_on_surface[v] = 1;
  for (const Triangle& t : surface.triangles)
    for (const VertexIndex v : t) is_on_surface[v] = 1;
  std::vector<VertexIndex> number(mesh.points.size());
  VertexIndex next = 0;
  for (const std::uint8_t first : {std::uint8_t{1}, std::uint8_t{0}})
    for (std::size_t v = 0; v < number.size(); ++v)
      if (is_on_surface[v] == first) number[v] = next++;
  return number;
}

void put_in_order(TetMesh& mesh, SurfaceMesh& surface, Features& features, SplitSpans& done) {
  const std::vector<VertexIndex> number = numbering(mesh, surface);
  std::vector<Vec3> points(mesh.points.size());
  std::vector<std::uint32_t> level(mesh.points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    points[number[v]] = mesh.points[v];
    level[number[v]] = done.level[v];
  }
  renumber_vertices(mesh, number);
  renumber(surface.triangles, number);
  VertexIndex last = 0;
  for (const Triangle& t : surface.triangles) last = std::max({last, t[0], t[1], t[2]});
  surface.points.assign(points.begin(), points.begin() + last + 1);
  for (Edge& edge : features.edges) edge = sorted_edge(number[edge[0]], number[edge[1]]);
  std::sort(features.edges.begin(), features.edges.end());
  for (VertexIndex& v : features.corners) v = number[v];
  mesh.points = std::move(points);
  done.level = std::move(level);
}

}  // namespace

SplitSpans split_spans(TetMesh& mesh, std::vector<Span> spans, std::uint32_t layers, SurfaceMesh& surface,
                       Features& features, std::vector<std::uint32_t>& parent, const RunContext& context) {
  SplitSpans done;
  done.edges = spans.size();
  parent.resize(surface.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  const std::size_t elements = mesh.tets.size();
  done.level.assign(mesh.points.size(), 0);
  for (std::uint32_t parts = layers; parts >= 2 && !spans.empty(); --parts) {
    context.check();
    SplitSpans pass;
    const Nodes nodes(mesh.points, spans, parts);
    divide_mesh(mesh, nodes, pass);
    divide_surface(surface, parent, nodes);
    divide_edges(features.edges, nodes);
    if (parts == layers) done.elements = pass.elements;
    done.level.resize(mesh.points.size(), layers - parts + 1);
    spans = next_spans(mesh, nodes);
  }
  done.made = mesh.tets.size() - elements + done.elements;
  put_in_order(mesh, surface, features, done);
  return done;
}

}  // namespace octafront::layers
