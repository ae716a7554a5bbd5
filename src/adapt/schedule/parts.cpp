#include "adapt/schedule/parts.h"

#include "base/core/disjoint_sets.h"
#include "base/core/groups.h"
#include "base/mesh/adjacency.h"

#include <algorithm>
#include <map>

namespace octafront::adapt {
namespace {

/// Numbers of labels, in the order in which they come.
class Numbering {
 public:
  std::uint32_t of(const Labels::Label& label) {
    const auto [at, is_new] = number_.try_emplace(label, static_cast<std::uint32_t>(all_.size()));
    if (is_new) all_.push_back(label);
    return at->second;
  }
  std::vector<Labels::Label> all() && { return std::move(all_); }

 private:
  std::map<Labels::Label, std::uint32_t> number_;
  std::vector<Labels::Label> all_;
};

/// A label of each item of a kind: `own` numbers, then the sets of that kind that it is in.
std::vector<Labels::Label> labels_of(const TetMesh& mesh, NamedSet::Kind kind, std::vector<std::uint32_t> own) {
  own.resize(mesh.count(kind), 0);
  std::vector<Labels::Label> labels(own.size());
  for (std::size_t i = 0; i < own.size(); ++i) labels[i] = {own[i]};
  for (std::uint32_t s = 0; s < mesh.sets.size(); ++s)
    if (mesh.sets[s].kind == kind)
      for (const std::uint32_t i : mesh.sets[s].members) labels[i].push_back(s);
  return labels;
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
    Numbering regions;
    for (const Labels::Label& label : labels_of(mesh_, NamedSet::Kind::kElements, mesh_.region))
      parts.region.push_back(regions.of(label));
    out_.labels.regions = std::move(regions).all();
    find_walls();
    turn_alike(out_.walls);
    find_lines();
    set_kinds();
    return std::move(out_);
  }

 private:
  void find_walls() {
    std::vector<std::uint32_t> own = mesh_.patch;
    own.resize(mesh_.boundary.size(), 0);
    own.insert(own.end(), mesh_.interface_patch.begin(), mesh_.interface_patch.end());
    const auto labels = labels_of(mesh_, NamedSet::Kind::kFaces, std::move(own));
    const std::size_t outer = mesh_.boundary.size();
    FlatMap<Triangle, std::uint32_t> listed(labels.size());
    for (std::uint32_t f = 0; f < labels.size(); ++f)
      listed.find_or_add(face_key(f < outer ? mesh_.boundary[f] : mesh_.interfaces[f - outer])) = f;
    const std::vector<HalfFace> across = half_face_neighbors(mesh_.tets, mesh_.points.size());
    Numbering numbers;
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
      const std::uint32_t part = numbers.of(f ? labels[*f] : Labels::Label{kNone});
      out_.parts.wall[h / 4][h % 4] = (part + 1) | (o == kNone ? kOuter : 0);
      if (o != kNone && h > o) continue;
      surface.triangles.push_back(corners);
      surface.patch.push_back(part);
      out_.walls.outer.push_back(o == kNone);
    }
    out_.labels.walls = std::move(numbers).all();
  }

  void find_lines() {
    Features& lines = out_.walls.lines;
    lines = detect_features(out_.walls.surface, out_.walls.edges, feature_angle_);
    std::map<Edge, Labels::Label> named;
    const auto labels = labels_of(mesh_, NamedSet::Kind::kEdges, mesh_.curve);
    for (std::size_t e = 0; e < labels.size(); ++e)
      named[sorted_edge(mesh_.curve_edges[e][0], mesh_.curve_edges[e][1])] = labels[e];
    for (const auto& [edge, label] : named) lines.edges.push_back(edge);
    lines.edges.insert(lines.edges.end(), kinks_.begin(), kinks_.end());
    std::sort(lines.edges.begin(), lines.edges.end());
    lines.edges.erase(std::unique(lines.edges.begin(), lines.edges.end()), lines.edges.end());
    std::vector<Labels::Label> label(lines.edges.size(), Labels::Label{kNone});
    for (std::size_t e = 0; e < label.size(); ++e)
      if (const auto at = named.find(lines.edges[e]); at != named.end()) label[e] = at->second;
    name_paths(label);
    mark_touching_edges();
  }

  /// Lines of edges of one label.
  void name_paths(const std::vector<Labels::Label>& label) {
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
    const auto triangles = static_cast<std::uint32_t>(mesh_.boundary.size());
    DisjointSets fans(3 * std::size_t{triangles});
    for (std::size_t e = 0; e < table.size(); ++e) {
      const auto uses = table.uses(e);
      if (uses.size() == 2) {
        fans.join(uses[0], next_of(uses[1])), fans.join(next_of(uses[0]), uses[1]);
        continue;
      }
      for (const VertexIndex v : table.edges[e]) touching_.push_back(v);
      std::vector<Parts::Line>& lines = out_.parts.lines;
      const auto line = std::lower_bound(lines.begin(), lines.end(), table.edges[e],
                                         [](const Parts::Line& l, const Edge& edge) { return l.edge < edge; });
      if (line == lines.end() || line->edge != table.edges[e] || line->path == Parts::kStays) continue;
      out_.labels.staying[line->edge] = out_.labels.paths[line->path];
      line->path = Parts::kStays;
    }
    std::vector<std::uint32_t> fan(mesh_.points.size(), kNone);
    for (std::uint32_t c = 0; c < 3 * triangles; ++c) {
      std::uint32_t& known = fan[mesh_.boundary[c / 3][c % 3]];
      if (known == kNone) known = fans.find(c);
      if (known != fans.find(c)) touching_.push_back(mesh_.boundary[c / 3][c % 3]);
    }
  }

  void set_kinds() {
    std::vector<Vertex>& vertices = out_.parts.vertices;
    for (const Triangle& t : out_.walls.surface.triangles)
      for (const VertexIndex v : t) vertices[v].kind = Kind::kSurface;
    for (const Edge& e : out_.walls.lines.edges)
      for (const VertexIndex v : e) vertices[v].kind = Kind::kCurve;
    for (const VertexIndex v : out_.walls.lines.corners) vertices[v].kind = Kind::kFixed;
    for (Vertex& v : vertices) v.off = v.kind != Kind::kInner;
    for (const VertexIndex v : touching_) vertices[v].kind = Kind::kFixed, vertices[v].off = false;
  }

  const TetMesh& mesh_;
  double feature_angle_;
  std::span<const Edge> kinks_;
  TakenApart out_;
  std::vector<VertexIndex> touching_;
};

/// Puts what belongs to an item, by its label, into the sets of a kind.
void add_to_sets(std::vector<NamedSet>& sets, const Labels::Label& label, std::uint32_t item) {
  for (std::size_t k = 1; k < label.size(); ++k) sets[label[k]].members.push_back(item);
}

}  // namespace

TakenApart take_apart(const TetMesh& mesh, double feature_angle, std::span<const Edge> kinks) {
  return TakerApart(mesh, feature_angle, kinks).run();
}

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

}  // namespace

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
  const auto is_kept = [&](const Labels::Label& wall) {
    return std::any_of(wall.begin() + 1, wall.end(),
                       [&](std::uint32_t set) { return std::find(sets.begin(), sets.end(), set) != sets.end(); });
  };
  for (const Labels::Label& wall : taken.labels.walls) taken.kept.push_back(is_kept(wall));
}

TetMesh put_together(const Parts& parts, const Labels& labels, const TetMesh& before,
                     std::vector<VertexIndex>& old_of_new) {
  TetMesh mesh;
  mesh.region_names = before.region_names, mesh.region_labels = before.region_labels;
  mesh.patch_names = before.patch_names, mesh.curve_names = before.curve_names;
  mesh.patch_labels = before.patch_labels, mesh.curve_labels = before.curve_labels;
  mesh.sets = before.sets;
  for (NamedSet& s : mesh.sets) s.members.clear();
  // Vertices: those that were there in their order, then new ones.
  std::vector<VertexIndex> order, number(parts.vertices.size(), kNone);
  std::vector<std::uint8_t> used(parts.vertices.size(), 0);
  for (const Tet& t : parts.tets)
    for (const VertexIndex v : t) used[v] = 1;
  for (VertexIndex v = 0; v < used.size(); ++v)
    if (used[v]) order.push_back(v);
  std::stable_sort(order.begin(), order.end(),
                   [&](VertexIndex a, VertexIndex b) { return parts.vertices[a].id < parts.vertices[b].id; });
  std::vector<VertexIndex> now(before.points.size(), kNone);
  old_of_new.clear();
  for (VertexIndex k = 0; k < order.size(); ++k) {
    const Vertex& v = parts.vertices[order[k]];
    number[order[k]] = k;
    mesh.points.push_back(v.at);
    old_of_new.push_back(v.id);
    if (v.id != kNone) now[v.id] = k;
  }
  const bool has_regions = !before.region.empty();
  const bool has_patches = !before.patch.empty();
  struct Face {
    Triangle corners;
    std::uint32_t part;
  };
  std::vector<Face> inner;
  for (TetIndex t = 0; t < parts.tets.size(); ++t) {
    Tet c = parts.tets[t];
    for (VertexIndex& v : c) v = number[v];
    mesh.tets.push_back(c);
    const Labels::Label& region = labels.regions[parts.region[t]];
    if (has_regions) mesh.region.push_back(region[0]);
    add_to_sets(mesh.sets, region, t);
    for (int i = 0; i < 4; ++i) {
      const Wall w = parts.wall[t][i];
      if (w == 0) continue;
      const std::uint32_t part = (w & ~kOuter) - 1;
      if ((w & kOuter) != 0) {
        add_to_sets(mesh.sets, labels.walls[part], static_cast<std::uint32_t>(mesh.boundary.size()));
        mesh.boundary.push_back(face_of(c, i));
        if (has_patches) mesh.patch.push_back(labels.walls[part][0]);
      } else if (labels.walls[part][0] != kNone) {
        inner.push_back({face_of(c, i), part});
      }
    }
  }
  // Each inner wall comes twice, once from each side: the first one is listed.
  FlatSet<Triangle> listed(inner.size());
  for (const Face& f : inner) {
    if (!listed.insert(face_key(f.corners))) continue;
    add_to_sets(mesh.sets, labels.walls[f.part],
                static_cast<std::uint32_t>(mesh.boundary.size() + mesh.interfaces.size()));
    mesh.interfaces.push_back(f.corners);
    if (!before.interface_patch.empty()) mesh.interface_patch.push_back(labels.walls[f.part][0]);
  }
  std::vector<Parts::Line> lines = parts.lines;
  for (Parts::Line& l : lines) l.edge = sorted_edge(number[l.edge[0]], number[l.edge[1]]);
  std::sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.edge < b.edge; });
  for (const Parts::Line& l : lines) {
    const Labels::Label& label = l.path == Parts::kStays
                                     ? labels.staying.at(sorted_edge(old_of_new[l.edge[0]], old_of_new[l.edge[1]]))
                                     : labels.paths[l.path];
    if (label[0] == kNone) continue;
    add_to_sets(mesh.sets, label, static_cast<std::uint32_t>(mesh.curve_edges.size()));
    mesh.curve_edges.push_back(l.edge);
    if (!before.curve.empty()) mesh.curve.push_back(label[0]);
  }
  for (std::size_t s = 0; s < mesh.sets.size(); ++s) {
    if (mesh.sets[s].kind == NamedSet::Kind::kNodes)
      for (const std::uint32_t v : before.sets[s].members)
        if (v < now.size() && now[v] != kNone) mesh.sets[s].members.push_back(now[v]);
    std::sort(mesh.sets[s].members.begin(), mesh.sets[s].members.end());
  }
  return mesh;
}

}  // namespace octafront::adapt
