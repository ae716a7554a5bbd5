#include "surface/lines/seams.h"

#include <octafront/surface_mesh.h>

#include "base/core/disjoint_sets.h"
#include "base/geometry/measures.h"
#include "base/geometry/same_place.h"
#include "surface/edits/coarsen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace octafront::surface {

namespace {

/// Whether the surface is cut along an edge: where other than two triangles meet, or two that do not face alike.
bool is_cut(const SurfaceMesh& complex, const EdgeTable& table, std::size_t e) {
  const auto uses = table.uses(e);
  return uses.size() != 2 || start_of(complex.triangles, uses[0]) == start_of(complex.triangles, uses[1]);
}

class Cutter {
 public:
  Cutter(const KnownSurface& complex, PeriodicFaces periods)
      : known_(complex),
        complex_(complex.mesh()),
        table_(complex.edges()),
        faces_(static_cast<std::uint32_t>(complex_.triangles.size())),
        edge_of_(table_.edge_of_half_edge()),
        fans_(3 * faces_) {
    out_.periods = std::move(periods);
  }

  SeamedSurface run() {
    find_fans();
    number_fronts();
    connect_fronts();
    add_backs();
    find_normals();
    find_originals();
    find_pinned();
    carry_features();
    return std::move(out_);
  }

 private:
  HalfEdgeMesh& mesh() { return out_.input.mesh; }
  std::uint32_t corner(HalfEdge h, VertexIndex v) const {
    return complex_.triangles[h / 3][h % 3] == v ? h : next_of(h);
  }
  bool cut(HalfEdge h) const { return cut_[edge_of_[h]] != 0; }
  HalfEdge partner(HalfEdge h) const {
    const auto uses = table_.uses(edge_of_[h]);
    return uses[0] == h ? uses[1] : uses[0];
  }
  void find_cuts() {
    cut_.resize(table_.size());
    for (std::size_t e = 0; e < table_.size(); ++e) cut_[e] = is_cut(complex_, table_, e) || bounds_periodic_face(e);
    const PeriodicCell& cell = out_.periods.cell;
    if (!cell.is_periodic()) return;
    // Where one of the copies of an edge is cut, all are.
    const auto original = [&](std::size_t e) {
      const auto [a, b] = table_.edges[e];
      return keys_of(cell.originals(std::array{complex_.points[a], complex_.points[b]}));
    };
    std::set<std::array<PlaceKey, 2>> cuts;
    for (std::size_t e = 0; e < table_.size(); ++e)
      if (cut_[e]) cuts.insert(original(e));
    for (std::size_t e = 0; e < table_.size(); ++e) cut_[e] = cuts.contains(original(e));
  }

  void find_fans() {
    find_cuts();
    for (std::size_t e = 0; e < table_.size(); ++e) {
      if (cut_[e]) continue;
      const HalfEdge h = table_.uses(e)[0], g = table_.uses(e)[1];
      for (const VertexIndex v : table_.edges[e]) fans_.join(corner(h, v), corner(g, v));
    }
    fan_is_open_.assign(3 * faces_, 0);
    for (HalfEdge h = 0; h < 3 * faces_; ++h)
      if (cut(h)) fan_is_open_[fans_.find(h)] = fan_is_open_[fans_.find(next_of(h))] = 1;
  }

  /// Whether a part of a periodic face ends at an edge of two triangles.
  bool bounds_periodic_face(std::size_t e) const {
    const std::vector<CellFace>& face = out_.periods.face;
    if (face.empty()) return false;
    const std::uint32_t s = table_.uses(e)[0] / 3, t = table_.uses(e)[1] / 3;
    return face[s] != face[t] || (face[s] != kNone && complex_.patch_of(s) != complex_.patch_of(t));
  }

  void find_originals() {
    out_.original = out_.place;
    const PeriodicCell& cell = out_.periods.cell;
    if (!cell.is_periodic()) return;
    for (VertexIndex v = 0; v < complex_.points.size(); ++v) out_.vertex_at.add(complex_.points[v], v);
    for (VertexIndex c = 0; c < out_.first_tip; ++c) {
      const VertexIndex v = out_.vertex_at.find(cell.original(mesh().points[c]));
      if (v != kNone) out_.original[c] = v;
    }
  }

  VertexIndex add_vertex(Vec3 p, std::size_t place) {
    mesh().points.push_back(p);
    out_.place.push_back(static_cast<VertexIndex>(place));
    return static_cast<VertexIndex>(mesh().points.size() - 1);
  }

  void number_fronts() {
    std::vector<VertexIndex> copy(3 * faces_, kNone);
    for (HalfEdge h = 0; h < 3 * faces_; ++h) {
      const VertexIndex v = complex_.triangles[h / 3][h % 3];
      VertexIndex& c = copy[fans_.find(h)];
      if (c == kNone) c = add_vertex(complex_.points[v], v);
      mesh().start.push_back(c);
    }
    out_.first_tip = static_cast<VertexIndex>(mesh().points.size());
    InputSurface& input = out_.input;
    input.first_back = 1;
    for (std::uint32_t t = 0; t < faces_; ++t) {
      input.patch.push_back(complex_.patch_of(t));
      input.first_back = std::max(input.first_back, complex_.patch_of(t) + 1);
    }
  }

  void connect_fronts() {
    mesh().twin.assign(3 * faces_, kNone);
    for (HalfEdge h = 0; h < 3 * faces_; ++h)
      if (!cut(h)) mesh().twin[h] = partner(h);
  }

  /// A fan of triangles around a tip behind each loop of cut edges.
  void add_backs() {
    std::vector<HalfEdge> cut_from(mesh().points.size(), kNone);  // by vertex; there is one at most
    for (HalfEdge h = 0; h < 3 * faces_; ++h)
      if (cut(h)) cut_from[mesh().start[h]] = h;
    std::vector<HalfEdge> loop;
    for (HalfEdge first = 0; first < 3 * faces_; ++first) {
      if (mesh().twin[first] != kNone) continue;
      loop.clear();
      HalfEdge h = first;
      do loop.push_back(h), h = cut_from[mesh().end(h)];
      while (h != first);
      close(loop);
    }
  }

  void close(const std::vector<HalfEdge>& loop) {
    Vec3 sum;
    for (const HalfEdge h : loop) sum += mesh().points[mesh().start[h]];
    const std::size_t tips = mesh().points.size() - out_.first_tip;
    const VertexIndex tip = add_vertex(sum / static_cast<double>(loop.size()), complex_.points.size() + tips);
    const auto first = static_cast<HalfEdge>(mesh().start.size());
    for (const HalfEdge h : loop) {
      const auto back = static_cast<HalfEdge>(mesh().start.size());
      mesh().start.insert(mesh().start.end(), {mesh().end(h), mesh().start[h], tip});
      mesh().twin.insert(mesh().twin.end(), 3, kNone);
      out_.input.patch.push_back(out_.input.first_back);
      link(back, h);
      if (back != first) link(back + 1, back - 1);
    }
    link(first + 1, static_cast<HalfEdge>(mesh().start.size()) - 1);
  }

  void link(HalfEdge a, HalfEdge b) {
    mesh().twin[a] = b;
    mesh().twin[b] = a;
  }

  void find_normals() {
    InputSurface& input = out_.input;
    HalfEdgeMesh& m = input.mesh;
    m.is_feature.assign(m.start.size(), 0);
    m.outgoing.assign(m.points.size(), kNone);
    for (HalfEdge h = 0; h < m.start.size(); ++h) m.outgoing[m.start[h]] = h;
    surface::find_normals(input);
    set_features(input, {});
  }

  /// A seam goes on at a vertex of two cut edges where all parts end; other vertices of several copies are corners.
  void find_pinned() {
    std::vector<std::uint32_t> seams(complex_.points.size(), 0), fans(seams), closed(seams);
    for (std::size_t e = 0; e < table_.size(); ++e)
      if (cut_[e])
        for (const VertexIndex v : table_.edges[e]) ++seams[v];
    // Of the cut edges where a fan ends: how many, and whether they are one and the same.
    std::vector<std::uint32_t> ends(3 * faces_, 0), difference(3 * faces_, 0);
    for (HalfEdge h = 0; h < 3 * faces_; ++h) {
      if (!cut(h)) continue;
      for (const std::uint32_t fan : {fans_.find(h), fans_.find(next_of(h))})
        ++ends[fan], difference[fan] ^= edge_of_[h];
    }
    std::vector<std::uint8_t> is_odd(complex_.points.size(), 0);
    for (HalfEdge h = 0; h < 3 * faces_; ++h) {
      if (fans_.find(h) != h) continue;
      const VertexIndex v = complex_.triangles[h / 3][h % 3];
      ++fans[v];
      closed[v] += !fan_is_open_[h];
      if (fan_is_open_[h] && (ends[h] != 2 || difference[h] == 0)) is_odd[v] = 1;
    }
    out_.pinned.resize(out_.place.size());
    for (VertexIndex c = 0; c < out_.first_tip; ++c) {
      const VertexIndex v = out_.place[c];
      const bool is_plain = seams[v] == 0 ? fans[v] == 1 : seams[v] == 2 && closed[v] == 0 && !is_odd[v];
      out_.pinned[c] = !is_plain;
    }
    if (!out_.periods.cell.is_periodic()) return;
    std::vector<std::uint8_t> is_pinned(complex_.points.size(), 0);
    for (VertexIndex c = 0; c < out_.first_tip; ++c) is_pinned[out_.original[c]] |= out_.pinned[c];
    for (VertexIndex c = 0; c < out_.first_tip; ++c) out_.pinned[c] = is_pinned[out_.original[c]];
  }

  void carry_features() {
    const Features& known = known_.features();
    std::vector<std::uint8_t> is_corner(complex_.points.size(), 0);
    for (const VertexIndex v : known.corners) is_corner[v] = 1;
    for (const Edge& edge : known.edges) {
      const auto at = std::lower_bound(table_.edges.begin(), table_.edges.end(), edge);
      if (at == table_.edges.end() || *at != edge) continue;
      const auto e = static_cast<std::size_t>(at - table_.edges.begin());
      if (cut_[e]) continue;
      const HalfEdge h = table_.uses(e)[0];
      const VertexIndex a = mesh().start[h], b = mesh().end(h);
      out_.features.edges.push_back({std::min(a, b), std::max(a, b)});
    }
    std::sort(out_.features.edges.begin(), out_.features.edges.end());
    for (VertexIndex c = 0; c < out_.first_tip; ++c)
      if (is_corner[out_.place[c]]) out_.features.corners.push_back(c);
  }

  const KnownSurface& known_;
  const SurfaceMesh& complex_;
  const EdgeTable& table_;
  const std::uint32_t faces_;
  const RawVector<std::uint32_t> edge_of_;
  DisjointSets fans_;  ///< corners of triangles around a vertex, over edges that are not cut
  std::vector<std::uint8_t> cut_, fan_is_open_;
  SeamedSurface out_;
};

/// The next half-edge of the seam on which h lies; kNone at a vertex where it does not go on.
HalfEdge along_seam(const InputSurface& input, HalfEdge h) {
  HalfEdge next = kNone;
  input.mesh.for_each_outgoing(input.mesh.end(h), [&](HalfEdge o) {
    if (input.is_seam(o) && o != input.mesh.twin[h]) next = o;
  });
  return next;
}

/// The curve from h on: to the next corner, or around, or `most` half-edges.
Curve follow_seam(const InputSurface& input, const std::vector<std::uint8_t>& is_corner, HalfEdge first,
                  std::size_t most) {
  const HalfEdgeMesh& mesh = input.mesh;
  Curve curve;
  curve.closed = !is_corner[mesh.start[first]];
  for (HalfEdge h = first; h != kNone && curve.half_edges.size() < most;) {
    const double l = distance(mesh.points[mesh.start[h]], mesh.points[mesh.end(h)]);
    curve.half_edges.push_back(h);
    curve.reach.push_back(l + (curve.reach.empty() ? 0 : curve.reach.back()));
    if (is_corner[mesh.end(h)]) break;
    h = along_seam(input, h);
    if (h == first) break;
  }
  return curve;
}

/// The seams as curves, each in all of its copies, which run the same way from the same vertex.
class SeamCurves {
 public:
  SeamCurves(const InputSurface& input, const SeamedSurface& seamed, const std::vector<std::uint8_t>& is_corner)
      : input_(input), mesh_(input.mesh), seamed_(seamed), is_corner_(is_corner), visited_(mesh_.start.size(), 0) {
    for (HalfEdge h = 0; h < mesh_.start.size(); ++h)
      if (input.is_seam(h)) copies_[original(h)].push_back(h);
  }

  void add_to(SeamedCurves& to) {
    for (const bool from_corners : {true, false})
      for (HalfEdge h = 0; h < mesh_.start.size(); ++h)
        if (input_.is_seam(h) && !visited_[h] && (is_corner_[mesh_.start[h]] != 0) == from_corners) add_all(h, to);
  }

 private:
  Edge places(HalfEdge h) const { return {seamed_.place[mesh_.start[h]], seamed_.place[mesh_.end(h)]}; }

  /// The places of its ends; of a copy by a period those that it is a copy of.
  Edge original(HalfEdge h) const {
    const PeriodicCell& cell = seamed_.periods.cell;
    if (!cell.is_periodic()) return places(h);
    const auto ends = cell.originals(std::array{mesh_.points[mesh_.start[h]], mesh_.points[mesh_.end(h)]});
    const Edge found{seamed_.vertex_at.find(ends[0]), seamed_.vertex_at.find(ends[1])};
    return found[0] == kNone || found[1] == kNone ? places(h) : found;
  }

  void add_all(HalfEdge first, SeamedCurves& to) {
    const auto number = static_cast<std::uint32_t>(to.curves.size());
    std::map<Edge, std::uint32_t> first_at;
    std::size_t most = kNone;
    for (const HalfEdge h : copies_[original(first)]) {
      Curve curve = follow_seam(input_, is_corner_, h, most);
      most = curve.half_edges.size();
      for (const HalfEdge g : curve.half_edges) visited_[g] = visited_[mesh_.twin[g]] = 1;
      to.group.push_back(first_at.try_emplace(places(h), static_cast<std::uint32_t>(to.curves.size())).first->second);
      to.curves.push_back(std::move(curve));
      to.twin.push_back(number);
    }
  }

  const InputSurface& input_;
  const HalfEdgeMesh& mesh_;
  const SeamedSurface& seamed_;
  const std::vector<std::uint8_t>& is_corner_;
  std::vector<std::uint8_t> visited_;
  std::map<Edge, std::vector<HalfEdge>> copies_;  ///< half-edges along seams by the places of their ends
};

/// Vertices on seams behind their places, sorted: the copies of one vertex of the complex stand side by side.
std::vector<std::pair<PlaceKey, VertexIndex>> copies_on_seams(const WorkingMesh& mesh) {
  std::vector<std::pair<PlaceKey, VertexIndex>> copies;
  for (VertexIndex v = 0; v < mesh.points.size(); ++v)
    if (mesh.outgoing[v] != kNone && mesh.is_sewn(v)) copies.emplace_back(key_of(mesh.points[v]), v);
  std::ranges::sort(copies);
  return copies;
}

Vec3 centroid_of(const WorkingMesh& mesh, std::uint32_t t) {
  return (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3;
}

/// The point of the complex's own patch that is nearest to p. It looks farther and farther, from `reach` on.
TriangleTree::Nearest nearest_of_patch(const KnownSurface& complex, std::uint32_t patch, Vec3 p, double reach) {
  const Box3 all = complex.tree().box();
  for (;; reach *= 2) {
    TriangleTree::Nearest best;
    best.squared_distance = reach * reach;
    const Vec3 r{reach, reach, reach};
    complex.tree().for_each_box_near({p - r, p + r}, [&](std::uint32_t t, const TriangleCorners& c) {
      if (complex.mesh().patch_of(t) != patch) return true;
      const Vec3 q = closest_point_on_triangle(p, c[0], c[1], c[2]);
      const double d = squared_distance(p, q);
      if (d < best.squared_distance || (d == best.squared_distance && t < best.triangle)) best = {q, t, d};
      return true;
    });
    if (best.triangle != kNone || reach > 2 * length(all.hi - all.lo)) return best;
  }
}

/// How far triangles may turn in the passes over the seams, and how many may meet at a vertex.
struct SeamPass {
  TurnLimits turn;
  int valence;
};
constexpr SeamPass kSeamPasses[] = {{{0.8, 0.5}, 12}, {{0.5, 0.2}, 24}, {{0.2, 0.0}, 1000}, {{0.1, -0.6}, 1000}};
constexpr int kMostSeamRepeats = 60;

class SeamCoarsener {
 public:
  SeamCoarsener(WorkingMesh& mesh, const PeriodicCell& cell, const RunContext& context, CoarsenCounts& counts)
      : mesh_(mesh), cell_(cell), context_(context), counts_(counts) {
    auto copies = copies_on_seams(mesh);
    for (auto& [place, v] : copies)
      if (cell.is_periodic()) place = key_of(cell.original({place[0], place[1], place[2]}));
    std::ranges::stable_sort(copies, {}, &std::pair<PlaceKey, VertexIndex>::first);
    for (auto first = copies.begin(); first != copies.end();) {
      const auto last = std::find_if(first, copies.end(), [&](const auto& c) { return c.first != first->first; });
      std::vector<VertexIndex> here;
      for (; first != last; ++first) here.push_back(first->second);
      const bool is_input = std::ranges::all_of(
          here, [&](VertexIndex v) { return mesh.kind[v] == VertexKind::kRemovableCurve && mesh.on_seam(v); });
      if (is_input) left_.push_back(std::move(here));
    }
  }

  void run() {
    for (const SeamPass& limits : kSeamPasses) {
      for (int i = 0; i < kMostSeamRepeats && !left_.empty(); ++i) {
        context_.check();
        edges_.clear();
        const std::size_t before = left_.size();
        std::erase_if(left_, [&](const std::vector<VertexIndex>& copies) { return remove(copies, limits); });
        std::erase_if(edges_, [&](HalfEdge h) { return mesh_.start[h] == kNone; });
        counts_.flips += make_delaunay(mesh_, edges_, limits.turn);
        if (left_.size() == before) break;
      }
    }
  }

 private:
  /// The place at `v` that is the copy of one at `first`, as v is of first.
  PlaceKey copied(const PlaceKey& target, VertexIndex first, VertexIndex v) const {
    if (mesh_.points[first] == mesh_.points[v]) return target;
    return key_of(cell_.carried({target[0], target[1], target[2]}, mesh_.points[first], mesh_.points[v]));
  }

  /// The seam's half-edge from v to the place, or kNone.
  HalfEdge towards(VertexIndex v, const PlaceKey& place) const {
    HalfEdge found = kNone;
    mesh_.for_each_outgoing(v, [&](HalfEdge h) {
      if (mesh_.is_seam(h) && key_of(mesh_.points[mesh_.end(h)]) == place) found = h;
    });
    return found;
  }

  /// Least quality around the copy once it is gone; 0 if it may not go.
  double quality_after(HalfEdge h, const SeamPass& limits) {
    StarCollapse star(mesh_);
    star.gather(mesh_.start[h]);
    const auto& ring = star.ring();
    const auto i = std::find(ring.begin(), ring.end(), h) - ring.begin();
    if (static_cast<int>(ring.size()) + mesh_.valence(mesh_.end(h)) - 4 > limits.valence) return 0;
    return mesh_.may_collapse(h) ? star.quality_after(static_cast<std::size_t>(i), limits.turn, 0) : 0;
  }

  /// Where the star of a copy has another one, or what that goes to, one collapse would change what the other was
  /// judged by: its triangles, or who is whose neighbour.
  bool stars_are_apart(const std::vector<HalfEdge>& collapses) const {
    for (const HalfEdge h : collapses)
      for (const HalfEdge g : collapses) {
        if (g == h) continue;
        const VertexIndex u = mesh_.start[g], w = mesh_.end(g);
        if (u == mesh_.end(h) || w == mesh_.end(h)) return false;
        bool meets = false;
        mesh_.for_each_outgoing(mesh_.start[h],
                                [&](HalfEdge o) { meets = meets || mesh_.end(o) == u || mesh_.end(o) == w; });
        if (meets) return false;
      }
    return true;
  }

  bool remove(const std::vector<VertexIndex>& copies, const SeamPass& limits) {
    std::vector<PlaceKey> targets;
    mesh_.for_each_outgoing(copies[0], [&](HalfEdge h) {
      if (mesh_.is_seam(h)) targets.push_back(key_of(mesh_.points[mesh_.end(h)]));
    });
    std::sort(targets.begin(), targets.end());
    std::vector<HalfEdge> chosen, here;
    double best = 0;
    for (const PlaceKey& target : targets) {
      double worst = 1;
      here.clear();
      for (const VertexIndex v : copies) {
        const HalfEdge h = towards(v, copied(target, copies[0], v));
        worst = h == kNone ? 0 : std::min(worst, quality_after(h, limits));
        if (!(worst > best)) break;
        here.push_back(h);
      }
      if (!(worst > best)) continue;
      best = worst;
      chosen = here;
    }
    if (chosen.empty() || !stars_are_apart(chosen)) return false;
    for (const HalfEdge h : chosen) {
      const VertexIndex target = mesh_.end(h);
      mesh_.collapse(h);
      ++counts_.collapses;
      mesh_.for_each_outgoing(target, [&](HalfEdge o) {
        edges_.push_back(o);
        edges_.push_back(next_of(o));
      });
    }
    return true;
  }

  WorkingMesh& mesh_;
  const PeriodicCell& cell_;
  const RunContext& context_;
  CoarsenCounts& counts_;
  std::vector<std::vector<VertexIndex>> left_;
  std::vector<HalfEdge> edges_;
};

}  // namespace

SeamedSurface cut_along_seams(const KnownSurface& complex, PeriodicFaces periods) {
  return Cutter(complex, std::move(periods)).run();
}

SeamedCurves chained_curves(const InputSurface& input, const SeamedSurface& seamed, const SizeField& sizes,
                            std::vector<std::uint8_t>& is_fixed) {
  const std::vector<std::uint8_t> is_corner = corner_marks(input, seamed.features.corners, is_fixed, sizes);
  std::vector<std::uint8_t> place_is_corner(input.mesh.points.size(), 0);  // there are no more places than copies
  for (VertexIndex c = 0; c < is_corner.size(); ++c)
    if (is_corner[c] || is_fixed[c] || seamed.pinned[c]) place_is_corner[seamed.original[c]] = 1;
  std::vector<std::uint8_t> copy_is_corner(is_fixed.size());
  for (VertexIndex c = 0; c < is_fixed.size(); ++c) {
    copy_is_corner[c] = place_is_corner[seamed.original[c]];
    is_fixed[c] = is_fixed[c] || seamed.pinned[c] || (copy_is_corner[c] && input.on_seam(c));
  }
  SeamedCurves chained{chain_curves(input, seamed.features.corners, is_fixed, sizes), {}, {}};
  std::erase_if(chained.curves, [&](const Curve& c) { return input.is_seam(c.half_edges.front()); });
  for (std::uint32_t c = 0; c < chained.curves.size(); ++c) chained.group.push_back(c);
  chained.twin = chained.group;
  SeamCurves(input, seamed, copy_is_corner).add_to(chained);
  return chained;
}

std::vector<Curve> divided_curves(const InputSurface& input, const SeamedSurface& seamed, const SizeField& sizes,
                                  std::vector<std::uint8_t>& is_fixed) {
  SeamedCurves chained = chained_curves(input, seamed, sizes, is_fixed);
  divide_curves(input, sizes, chained.curves, {chained.group, chained.twin, seamed.place, &seamed.periods.cell});
  return std::move(chained.curves);
}

void coarsen_seams(WorkingMesh& mesh, const PeriodicCell& cell, const RunContext& context, CoarsenCounts& counts) {
  SeamCoarsener(mesh, cell, context, counts).run();
}

void settle_seams(WorkingMesh& mesh, const SizeField& sizes) {
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) {
    if (mesh.outgoing[v] == kNone || !mesh.is_sewn(v)) continue;
    mesh.kind[v] = VertexKind::kCorner;
    if (!(mesh.size[v] > 0)) mesh.size[v] = sizes.at(mesh.points[v]);
  }
}

namespace {

constexpr double kTurnedQuality = 0.2;  // squared
constexpr TurnLimits kTurnedLimits{0.5, 0.2};

/// Turns an edge that there is elsewhere, if the new one runs to a vertex that no other part has.
bool turn_away(WorkingMesh& mesh, HalfEdge h) {
  const VertexIndex a = mesh.start[h], b = mesh.end(h), c = mesh.apex(h), d = mesh.apex(mesh.twin[h]);
  if ((mesh.is_sewn(c) && mesh.is_sewn(d)) || !mesh.may_flip(h)) return false;
  const auto quality = [&](VertexIndex u, VertexIndex v, VertexIndex w) {
    return squared_quality(mesh.points[u], mesh.points[v], mesh.points[w]);
  };
  if (std::min(quality(a, d, c), quality(b, c, d)) < kTurnedQuality || !flip_is_sound(mesh, h, kTurnedLimits))
    return false;
  mesh.flip(h);
  return true;
}

/// The point of the edge's own patch that is nearest to its middle.
TriangleTree::Nearest patch_at_middle(const WorkingMesh& mesh, HalfEdge h, const KnownSurface& complex) {
  const Vec3 a = mesh.points[mesh.start[h]], b = mesh.points[mesh.end(h)];
  return nearest_of_patch(complex, mesh.patch[h / 3], (a + b) * 0.5, distance(a, b));
}

void divide_edge(WorkingMesh& mesh, HalfEdge h, const TriangleTree::Nearest& at, const SizeField& sizes) {
  const Vec3 n = normalized(mesh.area_vector(h / 3) + mesh.area_vector(mesh.twin[h] / 3));
  mesh.split_edge(h, mesh.add_vertex(at.point, VertexKind::kFree, n, sizes.at(at.point), at.triangle));
}

/// Of edges between the same places the one that lies nearest to its patch becomes the last: dividing that would leave
/// it upon the others.
void move_nearest_to_end(std::vector<HalfEdge>& edges, const WorkingMesh& mesh, const KnownSurface& complex) {
  const auto away = [&](HalfEdge h) { return patch_at_middle(mesh, h, complex).squared_distance; };
  std::rotate(edges.begin(), std::ranges::min_element(edges, {}, away) + 1, edges.end());
}

}  // namespace

namespace {

/// Names for what sewn vertices make up: the same for copies by a period.
class SewnNames {
 public:
  SewnNames(const WorkingMesh& mesh, const PeriodicFaces& periods)
      : mesh_(mesh), periods_(periods), sewn_(sewn_vertices(mesh)) {
    if (!periods.cell.is_periodic()) return;
    for (VertexIndex v = 0; v < sewn_.size(); ++v)
      if (mesh.outgoing[v] != kNone && mesh.is_sewn(v)) at_.add(mesh.points[v], sewn_[v]);
  }

  /// Sorted.
  template <std::size_t N>
  std::array<VertexIndex, N> name_of(const std::array<VertexIndex, N>& vertices) const {
    std::array<VertexIndex, N> name{};
    std::array<Vec3, N> places{};
    for (std::size_t i = 0; i < N; ++i) name[i] = sewn_[vertices[i]], places[i] = mesh_.points[vertices[i]];
    if (periods_.cell.is_periodic()) {
      places = periods_.cell.originals(places);
      for (std::size_t i = 0; i < N; ++i)
        if (const VertexIndex v = at_.find(places[i]); v != kNone) name[i] = v;
    }
    std::sort(name.begin(), name.end());
    return name;
  }

  /// Whether the triangle gives way to a copy of another one.
  bool is_replaced(std::uint32_t t) const { return periods_.is_copy(mesh_.patch[t]); }

 private:
  const WorkingMesh& mesh_;
  const PeriodicFaces& periods_;
  const std::vector<VertexIndex> sewn_;
  VerticesByPlace at_;
};

}  // namespace

namespace {

/// A vertex so near to an edge that another part has between two of its neighbours lies on it, in lengths of the edge.
constexpr double kUnderEdge = 0.05;

bool is_on_edge(Vec3 p, Vec3 a, Vec3 b) {
  return dot(a - p, b - p) < 0 && squared_length(cross(a - p, b - p)) <
                                      kUnderEdge * kUnderEdge * squared_distance(a, b) * squared_distance(a, b);
}

/// Edges that run between vertices on seams, by where these are: those on seams, and others.
class EdgesBetweenSeams {
 public:
  EdgesBetweenSeams(const WorkingMesh& mesh, const PeriodicFaces& periods)
      : mesh_(mesh), names_(mesh, periods), is_sewn_(mesh.points.size()) {
    for (VertexIndex v = 0; v < is_sewn_.size(); ++v) is_sewn_[v] = mesh.outgoing[v] != kNone && mesh.is_sewn(v);
    for (HalfEdge h = 0; h < mesh.start.size(); ++h) {
      if (mesh.start[h] == kNone || h > mesh.twin[h]) continue;
      const VertexIndex a = mesh.start[h], b = mesh.end(h);
      if (!is_sewn_[a] || !is_sewn_[b]) continue;
      if (mesh.is_seam(h))
        seams_.insert(names_.name_of(Edge{a, b}));
      else if (!mesh.is_back(h / 3) && !names_.is_replaced(h / 3))
        edges_[names_.name_of(Edge{a, b})].push_back(h);
    }
    find_divided();
  }

  /// Those that there are elsewhere, too, but for one of each, which may stay.
  std::vector<HalfEdge> repeated(const KnownSurface& complex) && {
    std::vector<HalfEdge> found;
    for (auto& [key, edges] : edges_) {
      if (!seams_.contains(key)) {
        if (edges.size() > 1) move_nearest_to_end(edges, mesh_, complex);
        edges.pop_back();
      }
      found.insert(found.end(), edges.begin(), edges.end());
    }
    std::ranges::sort(found);
    return found;
  }

 private:
  /// Two edges in line count as one: a crease from seam to seam may have a vertex between.
  void find_divided() {
    std::vector<VertexIndex> ends;
    for (VertexIndex v = 0; v < mesh_.points.size(); ++v) {
      if (mesh_.outgoing[v] == kNone || is_sewn_[v] || mesh_.is_back(mesh_.outgoing[v] / 3)) continue;
      ends.clear();
      mesh_.for_each_outgoing(v, [&](HalfEdge h) {
        if (is_sewn_[mesh_.end(h)]) ends.push_back(mesh_.end(h));
      });
      for (std::size_t i = 0; i < ends.size(); ++i)
        for (std::size_t j = i + 1; j < ends.size(); ++j) find_under(v, ends[i], ends[j]);
    }
  }

  /// The edges from a to b that v lies on, and which are no side of a flat triangle with it.
  void find_under(VertexIndex v, VertexIndex a, VertexIndex b) {
    if (!is_on_edge(mesh_.points[v], mesh_.points[a], mesh_.points[b])) return;
    const Edge key = names_.name_of(Edge{a, b});
    const auto at = edges_.find(key);
    const auto has_corner = [&](HalfEdge h) { return mesh_.apex(h) == v || mesh_.apex(mesh_.twin[h]) == v; };
    if (at != edges_.end() && std::ranges::none_of(at->second, has_corner)) seams_.insert(key);
  }

  const WorkingMesh& mesh_;
  const SewnNames names_;
  std::vector<char> is_sewn_;
  std::map<Edge, std::vector<HalfEdge>> edges_;
  std::set<Edge> seams_;  ///< and what is divided elsewhere
};

}  // namespace

std::uint64_t divide_repeated_edges(WorkingMesh& mesh, const KnownSurface& complex, const PeriodicFaces& periods,
                                    const SizeField& sizes) {
  const std::vector<HalfEdge> repeated = EdgesBetweenSeams(mesh, periods).repeated(complex);
  for (const HalfEdge h : repeated)
    if (!turn_away(mesh, h)) divide_edge(mesh, h, patch_at_middle(mesh, h, complex), sizes);
  return repeated.size();
}

std::uint64_t divide_repeated_triangles(WorkingMesh& mesh, const KnownSurface& complex, const PeriodicFaces& periods,
                                        const SizeField& sizes) {
  const SewnNames names(mesh, periods);
  std::map<Triangle, std::vector<std::uint32_t>> alike;
  for (const std::uint32_t t : front_triangles(mesh)) {
    const Triangle corners = mesh.triangle(t);
    if (names.is_replaced(t)) continue;
    if (!std::all_of(corners.begin(), corners.end(), [&](VertexIndex v) { return mesh.is_sewn(v); })) continue;
    alike[names.name_of(corners)].push_back(t);
  }
  std::uint64_t divided = 0;
  for (const auto& [key, triangles] : alike) {
    if (triangles.size() < 2) continue;
    for (const std::uint32_t t : triangles) {
      const TriangleTree::Nearest at =
          nearest_of_patch(complex, mesh.patch[t], centroid_of(mesh, t), std::sqrt(length(mesh.area_vector(t))));
      const Vec3 n = normalized(mesh.area_vector(t));
      mesh.split_triangle(t, mesh.add_vertex(at.point, VertexKind::kFree, n, sizes.at(at.point), at.triangle));
      ++divided;
    }
  }
  return divided;
}

std::vector<VertexIndex> sewn_vertices(const WorkingMesh& mesh) {
  std::vector<VertexIndex> sewn(mesh.points.size());
  for (VertexIndex v = 0; v < sewn.size(); ++v) sewn[v] = v;
  const std::vector<std::pair<PlaceKey, VertexIndex>> copies = copies_on_seams(mesh);
  for (std::size_t i = 1; i < copies.size(); ++i)
    if (copies[i].first == copies[i - 1].first) sewn[copies[i].second] = sewn[copies[i - 1].second];
  return sewn;
}

std::vector<std::uint32_t> front_triangles(const WorkingMesh& mesh) {
  std::vector<std::uint32_t> alive = mesh.alive_triangles();
  std::erase_if(alive, [&](std::uint32_t t) { return mesh.is_back(t); });
  return alive;
}

}  // namespace octafront::surface
