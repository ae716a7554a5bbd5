#include "adapt/schedule/parts.h"

#include "base/core/groups.h"
#include "base/mesh/adjacency.h"
#include "base/mesh/surface_topology.h"

#include <algorithm>
#include <map>

namespace octafront::adapt {
namespace {

/// Lines that stay must not be divided; what they are called is known by their edges then.
void keep_line(TakenApart& taken, const Edge& edge) {
  std::vector<Parts::Line>& lines = taken.parts.lines;
  const auto line = std::lower_bound(lines.begin(), lines.end(), edge,
                                     [](const Parts::Line& l, const Edge& e) { return l.edge < e; });
  if (line == lines.end() || line->edge != edge || line->path == Parts::kStays) return;
  taken.labels.staying[edge] = taken.labels.paths[line->path];
  line->path = Parts::kStays;
}

class TakerApart {
 public:
  TakerApart(const TetMesh& mesh, double feature_angle, std::span<const Edge> kinks)
      : mesh_(mesh), feature_angle_(feature_angle), kinks_(kinks) {}

  TakenApart run() {
    Parts& parts = out_.parts;
    parts.vertices.resize(mesh_.points.size());
    for (VertexIndex v = 0; v < mesh_.points.size(); ++v)
      parts.vertices[v].at = mesh_.points[v], parts.vertices[v].id = v;
    parts.tets = mesh_.tets;
    Labels regions = labels_of(mesh_, NamedSet::Kind::kElements);
    parts.region = std::move(regions.of);
    out_.labels.regions = std::move(regions.like);
    find_walls();
    turn_alike(out_.walls);
    find_lines();
    set_kinds();
    return std::move(out_);
  }

 private:
  void find_walls() {
    const Labels labels = labels_of(mesh_, NamedSet::Kind::kFaces);
    const std::size_t outer = mesh_.boundary.size();
    FlatMap<Triangle, std::uint32_t> listed(labels.of.size());
    for (std::uint32_t f = 0; f < labels.of.size(); ++f)
      listed.find_or_add(face_key(f < outer ? mesh_.boundary[f] : mesh_.interfaces[f - outer])) = f;
    const std::vector<HalfFace> across = half_face_neighbors(mesh_.tets, mesh_.points.size());
    // Parts are numbered as they come; the last number is for what is not listed.
    std::vector<std::uint32_t> number(labels.like.size() + 1, kNone);
    SurfaceMesh& surface = out_.walls.surface;
    surface.points = mesh_.points;
    out_.parts.wall.assign(mesh_.tets.size(), {});
    for (HalfFace h = 0; h < across.size(); ++h) {
      const Triangle corners = corners_of(mesh_.tets, h);
      const std::uint32_t* f = listed.find(face_key(corners));
      const HalfFace o = across[h];
      // What lies across a cut is not here, and not outside either.
      const bool divides = o != kNone && out_.parts.region[o / 4] != out_.parts.region[h / 4];
      if (!f && !divides) continue;
      const std::size_t label = f ? labels.of[*f] : labels.like.size();
      std::uint32_t& part = number[label];
      if (part == kNone) {
        part = static_cast<std::uint32_t>(out_.labels.walls.size());
        out_.labels.walls.push_back(f ? labels.like[label] : kNone);
      }
      out_.parts.wall[h / 4][h % 4] = (part + 1) | (o == kNone ? kOuter : 0);
      if (o != kNone && h > o) continue;
      surface.triangles.push_back(corners);
      surface.patch.push_back(part);
      out_.walls.outer.push_back(o == kNone);
    }
  }

  void find_lines() {
    Features& lines = out_.walls.lines;
    lines = detect_features(out_.walls.surface, out_.walls.edges, feature_angle_);
    std::map<Edge, std::uint32_t> named;
    const Labels labels = labels_of(mesh_, NamedSet::Kind::kEdges);
    for (std::size_t e = 0; e < labels.of.size(); ++e)
      named[sorted_edge(mesh_.curve_edges[e][0], mesh_.curve_edges[e][1])] = labels.like[labels.of[e]];
    for (const auto& [edge, label] : named) lines.edges.push_back(edge);
    lines.edges.insert(lines.edges.end(), kinks_.begin(), kinks_.end());
    std::sort(lines.edges.begin(), lines.edges.end());
    lines.edges.erase(std::unique(lines.edges.begin(), lines.edges.end()), lines.edges.end());
    std::vector<std::uint32_t> label(lines.edges.size(), kNone);
    for (std::size_t e = 0; e < label.size(); ++e)
      if (const auto at = named.find(lines.edges[e]); at != named.end()) label[e] = at->second;
    add_crossings();
    name_paths(label);
    mark_touching_edges();
  }

  /// Where a curve leaves a wall, or goes through it, both stay.
  void add_crossings() {
    std::vector<std::uint8_t> is_wall(mesh_.points.size(), 0);
    for (const Triangle& t : out_.walls.surface.triangles)
      for (const VertexIndex v : t) is_wall[v] = 1;
    Features& lines = out_.walls.lines;
    for (const Edge& e : lines.edges) {
      if (std::ranges::binary_search(out_.walls.edges.edges, e)) continue;
      for (const VertexIndex v : e)
        if (is_wall[v]) lines.corners.push_back(v);
    }
  }

  /// Lines of edges of one label.
  void name_paths(const std::vector<std::uint32_t>& label) {
    Features& lines = out_.walls.lines;
    // Of kinks nothing is known but where they are: each is straight by itself.
    const auto is_kink = [&](std::uint32_t e) {
      return std::binary_search(kinks_.begin(), kinks_.end(), lines.edges[e]);
    };
    out_.walls.path = find_paths(mesh_.points.size(), lines, [&](std::uint32_t e, std::uint32_t f) {
      return label[e] == label[f] && !is_kink(e) && !is_kink(f);
    });
    for (std::uint32_t e = 0; e < lines.edges.size(); ++e) {
      const std::uint32_t path = out_.walls.path[e];
      if (path == out_.labels.paths.size()) out_.labels.paths.push_back(label[e]);
      out_.parts.lines.push_back({lines.edges[e], path});
    }
  }

  /// Edges where the boundary touches itself have tets on several sides that do not know each other.
  void mark_touching_edges() {
    const EdgeTable table = make_edge_table(mesh_.points.size(), mesh_.boundary);
    for (std::size_t e = 0; e < table.size(); ++e)
      if (table.uses(e).size() != 2) keep_line(out_, table.edges[e]);
    touches_ = touching_vertices(mesh_.boundary, table, mesh_.points.size(), FansOver::kEdgesOfTwo);
  }

  void set_kinds() {
    std::vector<Vertex>& vertices = out_.parts.vertices;
    for (const Triangle& t : out_.walls.surface.triangles)
      for (const VertexIndex v : t) vertices[v].kind = Kind::kSurface;
    for (const Edge& e : out_.walls.lines.edges)
      for (const VertexIndex v : e) vertices[v].kind = Kind::kCurve;
    for (const VertexIndex v : out_.walls.lines.corners) vertices[v].kind = Kind::kFixed;
    for (Vertex& v : vertices) v.off = v.kind != Kind::kInner;
    for (VertexIndex v = 0; v < touches_.size(); ++v)
      if (touches_[v]) vertices[v].kind = Kind::kFixed, vertices[v].off = false;
  }

  const TetMesh& mesh_;
  double feature_angle_;
  std::span<const Edge> kinks_;
  TakenApart out_;
  std::vector<std::uint8_t> touches_;  ///< per vertex: the boundary touches itself there
};

}  // namespace

TakenApart take_apart(const TetMesh& mesh, double feature_angle, std::span<const Edge> kinks) {
  return TakerApart(mesh, feature_angle, kinks).run();
}

void hold_sets(TakenApart& taken, const TetMesh& mesh, std::span<const std::uint32_t> sets) {
  if (sets.empty()) return;
  std::vector<Vertex>& vertices = taken.parts.vertices;
  const auto hold = [&](const auto& item) {
    for (const VertexIndex v : item) vertices[v].held = true;
  };
  const std::size_t outer = mesh.boundary.size();
  for (const std::uint32_t s : sets)
    for (const std::uint32_t m : mesh.sets[s].members) switch (mesh.sets[s].kind) {
        case NamedSet::Kind::kNodes:
          vertices[m].held = true;
          break;
        case NamedSet::Kind::kEdges:
          hold(mesh.curve_edges[m]);
          keep_line(taken, sorted_edge(mesh.curve_edges[m][0], mesh.curve_edges[m][1]));
          break;
        case NamedSet::Kind::kFaces:
          hold(m < outer ? mesh.boundary[m] : mesh.interfaces[m - outer]);
          break;
        case NamedSet::Kind::kElements:
          for (const VertexIndex v : mesh.tets[m]) vertices[v].frozen = true;
      }
  const auto is_in = [&](std::uint32_t set, std::uint32_t face) {
    return mesh.sets[set].kind == NamedSet::Kind::kFaces && has_member(mesh.sets[set], face);
  };
  for (const std::uint32_t face : taken.labels.walls)
    taken.kept.push_back(std::ranges::any_of(sets, [&](std::uint32_t set) { return is_in(set, face); }));
}

TetMesh put_together(const Parts& parts, const PartLabels& labels, const TetMesh& before, Origins& from) {
  TetMesh mesh;
  from = {};
  // Vertices: those that were there in their order, then new ones.
  std::vector<VertexIndex> order, number(parts.vertices.size(), kNone);
  std::vector<std::uint8_t> used(parts.vertices.size(), 0);
  for (const Tet& t : parts.tets)
    for (const VertexIndex v : t) used[v] = 1;
  for (VertexIndex v = 0; v < used.size(); ++v)
    if (used[v]) order.push_back(v);
  std::stable_sort(order.begin(), order.end(),
                   [&](VertexIndex a, VertexIndex b) { return parts.vertices[a].id < parts.vertices[b].id; });
  for (VertexIndex k = 0; k < order.size(); ++k) {
    const Vertex& v = parts.vertices[order[k]];
    number[order[k]] = k;
    mesh.points.push_back(v.at);
    from.nodes.push_back(v.id);
  }
  // Each wall inside comes twice, once from each side: the first one is listed.
  FlatSet<Triangle> listed;
  std::vector<std::uint32_t> inner;
  for (TetIndex t = 0; t < parts.tets.size(); ++t) {
    Tet c = parts.tets[t];
    for (VertexIndex& v : c) v = number[v];
    mesh.tets.push_back(c);
    from.tets.push_back(labels.regions[parts.region[t]]);
    for (int i = 0; i < 4; ++i) {
      const Wall w = parts.wall[t][i];
      if (w == 0) continue;
      const std::uint32_t like = labels.walls[(w & ~kOuter) - 1];
      if ((w & kOuter) != 0) {
        mesh.boundary.push_back(face_of(c, i)), from.faces.push_back(like);
      } else if (like != kNone && listed.insert(face_key(face_of(c, i)))) {
        mesh.interfaces.push_back(face_of(c, i)), inner.push_back(like);
      }
    }
  }
  from.faces.insert(from.faces.end(), inner.begin(), inner.end());
  std::vector<Parts::Line> lines = parts.lines;
  for (Parts::Line& l : lines) l.edge = sorted_edge(number[l.edge[0]], number[l.edge[1]]);
  std::sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.edge < b.edge; });
  for (const Parts::Line& l : lines) {
    const std::uint32_t like = l.path == Parts::kStays
                                   ? labels.staying.at(sorted_edge(from.nodes[l.edge[0]], from.nodes[l.edge[1]]))
                                   : labels.paths[l.path];
    if (like != kNone) mesh.curve_edges.push_back(l.edge), from.edges.push_back(like);
  }
  inherit(mesh, before, from);
  mesh.source.clear(), mesh.face_layers.clear();  // of the faces that were
  return mesh;
}

WallsOfParts wall_triangles(const Parts& parts, const std::function<bool(const Triangle&, std::uint32_t)>& left_out) {
  WallsOfParts walls;
  std::vector<VertexIndex> number(parts.vertices.size(), kNone);
  FlatSet<Triangle> seen;
  for (TetIndex t = 0; t < parts.tets.size(); ++t)
    for (int i = 0; i < 4; ++i) {
      const Wall w = parts.wall[t][static_cast<std::size_t>(i)];
      const bool outer = (w & kOuter) != 0;
      const std::uint32_t part = (w & ~kOuter) - 1;
      Triangle f = face_of(parts.tets[t], i);
      if (w == 0 || left_out(f, part) || (!outer && !seen.insert(face_key(f)))) continue;
      for (VertexIndex& v : f) {
        if (number[v] == kNone) {
          number[v] = static_cast<VertexIndex>(walls.vertex.size());
          walls.vertex.push_back(v);
          walls.surface.points.push_back(parts.vertices[v].at);
        }
        v = number[v];
      }
      walls.surface.triangles.push_back(f);
      walls.surface.patch.push_back(part);
      walls.outer.push_back(outer);
    }
  return walls;
}

}  // namespace octafront::adapt
