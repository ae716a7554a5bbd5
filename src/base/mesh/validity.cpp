#include <octafront/run_context.h>
#include <octafront/validity.h>

#include "base/core/buckets.h"
#include "base/core/parallel.h"
#include "base/core/shared_value.h"
#include "base/geometry/curved_tet.h"
#include "base/geometry/measures.h"
#include "base/geometry/predicates.h"
#include "base/mesh/complex.h"
#include "base/mesh/complex_defects.h"
#include "base/mesh/face_table.h"
#include "base/mesh/mesh_share.h"
#include "base/mesh/quadratic_nodes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <span>
#include <utility>

#include <fmt/core.h>

namespace octafront {

namespace {

// All digits, so that a report can be reproduced.
std::string place(Vec3 p) {
  return fmt::format("({}, {}, {})", p.x, p.y, p.z);
}

std::string described(const std::vector<Vec3>& points, const Triangle& t) {
  return fmt::format("{} {} {} at {} {} {}", t[0], t[1], t[2], place(points[t[0]]), place(points[t[1]]),
                     place(points[t[2]]));
}

/// A row of vertices that are not all there.
template <class Rows>
std::optional<std::string> range_defect(const Rows& rows, std::size_t n, const char* what) {
  const auto too_large = [n](VertexIndex v) { return v >= n; };
  const std::size_t i = parallel_find(
      rows.size(), [&](std::size_t row) { return std::any_of(rows[row].begin(), rows[row].end(), too_large); });
  if (i == rows.size()) return std::nullopt;
  const VertexIndex v = *std::find_if(rows[i].begin(), rows[i].end(), too_large);
  return fmt::format("{} {} refers to vertex {}, but there are only {}", what, i, v, n);
}

std::optional<std::string> unused_defect(const TetMesh& mesh, const std::vector<std::uint8_t>& is_used) {
  const std::size_t v = parallel_find(is_used.size(), [&](std::size_t i) { return is_used[i] == 0; });
  if (v == is_used.size()) return std::nullopt;
  return fmt::format("vertex {} {} belongs to no tetrahedron", v, place(mesh.points[v]));
}

std::optional<std::string> point_defect(const TetMesh& mesh) {
  const std::size_t n = mesh.points.size();
  if (const std::size_t v = parallel_find(n, [&](std::size_t i) { return !is_finite(mesh.points[i]); }); v < n)
    return fmt::format("vertex {} {} is not finite", v, place(mesh.points[v]));
  if (auto d = range_defect(mesh.tets, n, "tetrahedron")) return d;
  if (auto d = range_defect(mesh.mid_nodes, n, "tetrahedron")) return d;
  for (std::size_t i = 0; i < mesh.high_nodes.size(); ++i)
    if (mesh.high_nodes[i] >= n)
      return fmt::format("tetrahedron {} refers to vertex {} of {}", i / mesh.high_nodes_per_tet(), mesh.high_nodes[i],
                         n);
  if (auto d = range_defect(mesh.boundary, n, "boundary face")) return d;
  if (auto d = range_defect(mesh.interfaces, n, "interface")) return d;
  if (auto d = range_defect(mesh.curve_edges, n, "curve edge")) return d;
  return std::nullopt;
}

std::optional<std::string> use_defect(const TetMesh& mesh) {
  if (mesh.tets.empty()) return "the mesh has no tetrahedra";
  return unused_defect(mesh, vertices_in_use(mesh));
}

std::optional<std::string> array_defect(const TetMesh& mesh) {
  const auto misfit = [](const char* name, std::size_t size, std::size_t wanted,
                         const char* of) -> std::optional<std::string> {
    if (size == 0 || size == wanted) return std::nullopt;
    return fmt::format("{} has {} entries for {} {}", name, size, wanted, of);
  };
  if (auto d = misfit("region", mesh.region.size(), mesh.tets.size(), "tetrahedra")) return d;
  if (auto d = misfit("patch", mesh.patch.size(), mesh.boundary.size(), "boundary faces")) return d;
  if (auto d = misfit("source", mesh.source.size(), mesh.boundary.size(), "boundary faces")) return d;
  if (auto d = misfit("interface_patch", mesh.interface_patch.size(), mesh.interfaces.size(), "interfaces")) return d;
  if (auto d = misfit("curve", mesh.curve.size(), mesh.curve_edges.size(), "curve edges")) return d;
  if (auto d = misfit("face_layers", mesh.face_layers.size(), mesh.boundary.size() + mesh.interfaces.size(), "faces"))
    return d;
  if (mesh.high_order > 0 && (mesh.high_order < 3 || mesh.high_order > 4 || mesh.is_second_order()))
    return fmt::format("high_order is {}{}", mesh.high_order,
                       mesh.is_second_order() ? ", and there are mid_nodes" : "");
  if (auto d = misfit("high_nodes", mesh.high_nodes.size(), mesh.tets.size() * mesh.high_nodes_per_tet(),
                      "nodes of tetrahedra"))
    return d;
  return misfit("mid_nodes", mesh.mid_nodes.size(), mesh.tets.size(), "tetrahedra");
}

std::optional<std::string> set_defect(const TetMesh& mesh) {
  for (const NamedSet& set : mesh.sets) {
    const auto& m = set.members;
    if (std::adjacent_find(m.begin(), m.end(), std::greater_equal<>()) != m.end())
      return fmt::format("the members of set {} are not ascending", set.name);
    const std::size_t most = mesh.count(set.kind);
    if (!m.empty() && m.back() >= most)
      return fmt::format("set {} has the member {}, but there are only {}", set.name, m.back(), most);
  }
  return std::nullopt;
}

/// The nodes of some elements or faces, each once.
template <class Rows>
std::vector<VertexIndex> nodes_of_rows(const Rows& rows, std::size_t first, std::size_t count) {
  std::vector<VertexIndex> nodes;
  for (std::size_t i = first; i < first + count; ++i) nodes.insert(nodes.end(), rows[i].begin(), rows[i].end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::optional<std::string> wide_defect(const TetMesh& mesh) {
  const auto differ = [](std::vector<VertexIndex> own, const std::vector<VertexIndex>& of_parts) {
    std::sort(own.begin(), own.end());
    return own != of_parts;
  };
  std::size_t end = 0;
  for (const WideCell& cell : mesh.wide_cells) {
    const std::size_t count = cell.tet_count, nodes = count + 3;
    if ((count != 2 && count != 3) || cell.first < end || cell.first + count > mesh.tets.size() ||
        differ({cell.nodes.begin(), cell.nodes.begin() + static_cast<std::ptrdiff_t>(nodes)},
               nodes_of_rows(mesh.tets, cell.first, count)))
      return fmt::format("the wedge or pyramid of tetrahedron {} is not made of it and those behind it", cell.first);
    end = cell.first + count;
  }
  end = 0;
  for (const WideFace& face : mesh.wide_faces) {
    if (face.first < end || face.first + 2 > mesh.boundary.size() ||
        differ({face.nodes.begin(), face.nodes.end()}, nodes_of_rows(mesh.boundary, face.first, 2)))
      return fmt::format("the quadrilateral of boundary face {} is not made of it and the one behind it", face.first);
    end = face.first + 2;
  }
  return std::nullopt;
}

Edge edge_of(const Tet& t, std::size_t e) {
  const VertexIndex a = t[static_cast<std::size_t>(kTetEdges[e][0])], b = t[static_cast<std::size_t>(kTetEdges[e][1])];
  return sorted_edge(a, b);
}

std::optional<std::string> curve_defect(const TetMesh& mesh) {
  if (mesh.curve_edges.empty()) return std::nullopt;
  std::vector<Edge> wanted = mesh.curve_edges;
  std::vector<bool> at_curve(mesh.points.size(), false);
  for (auto& [a, b] : wanted) {
    if (a > b) std::swap(a, b);
    at_curve[a] = at_curve[b] = true;
  }
  std::sort(wanted.begin(), wanted.end());
  std::vector<bool> found(wanted.size(), false);
  for (const Tet& t : mesh.tets)
    for (std::size_t e = 0; e < 6; ++e) {
      const Edge edge = edge_of(t, e);
      if (!at_curve[edge[0]] || !at_curve[edge[1]]) continue;
      for (auto at = std::lower_bound(wanted.begin(), wanted.end(), edge); at != wanted.end() && *at == edge; ++at)
        found[static_cast<std::size_t>(at - wanted.begin())] = true;
    }
  const auto lost = std::find(found.begin(), found.end(), false);
  if (lost == found.end()) return std::nullopt;
  const auto [a, b] = wanted[static_cast<std::size_t>(lost - found.begin())];
  return fmt::format("the curve edge {} {} at {} {} is no edge of a tetrahedron", a, b, place(mesh.points[a]),
                     place(mesh.points[b]));
}

/// Each edge has one mid-side node, which no other edge has, and which is no corner.
std::optional<std::string> mid_node_defect(const TetMesh& mesh) {
  if (!mesh.is_second_order()) return std::nullopt;
  VertexIndex corners = 0;
  for (const Tet& t : mesh.tets) corners = std::max(corners, 1 + *std::max_element(t.begin(), t.end()));
  std::vector<Edge> edge_at(mesh.points.size(), Edge{kNone, kNone});
  std::size_t nodes = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const VertexIndex mid = mesh.mid_nodes[t][e];
      const Edge edge = edge_of(mesh.tets[t], e);
      if (mid < corners) return fmt::format("the mid-side node {} of tetrahedron {} is not behind all corners", mid, t);
      nodes += edge_at[mid][0] == kNone;
      if (edge_at[mid][0] == kNone) edge_at[mid] = edge;
      if (edge_at[mid] != edge)
        return fmt::format("the mid-side node {} {} is on two edges: {} {} and {} {}", mid, place(mesh.points[mid]),
                           edge_at[mid][0], edge_at[mid][1], edge[0], edge[1]);
    }
  std::sort(edge_at.begin(), edge_at.end());
  const auto twice = std::adjacent_find(edge_at.begin(), edge_at.begin() + static_cast<std::ptrdiff_t>(nodes));
  if (twice == edge_at.begin() + static_cast<std::ptrdiff_t>(nodes)) return std::nullopt;
  return fmt::format("the edge {} {} has several mid-side nodes", (*twice)[0], (*twice)[1]);
}

/// `first`: of the first tetrahedron the number in the whole, where this is a share.
std::optional<std::string> sign_defect(const TetMesh& mesh, std::uint64_t first) {
  const auto& p = mesh.points;
  const auto sign_of = [&](std::size_t t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    return orient3d(p[a], p[b], p[c], p[d]);
  };
  const std::size_t t = parallel_find(mesh.tets.size(), [&](std::size_t i) { return sign_of(i) != 1; });
  if (t == mesh.tets.size()) return std::nullopt;
  const auto& [a, b, c, d] = mesh.tets[t];
  return fmt::format("tetrahedron {} is {}, volume {:.3g}: vertices {} {} {} {} at {} {} {} {}", first + t,
                     sign_of(t) == 0 ? "flat" : "inverted", signed_volume(p[a], p[b], p[c], p[d]), a, b, c, d,
                     place(p[a]), place(p[b]), place(p[c]), place(p[d]));
}

std::optional<std::string> high_jacobian_defect(const TetMesh& mesh) {
  const auto t = static_cast<TetIndex>(parallel_find(mesh.tets.size(), [&](std::size_t i) {
    std::array<Vec3, 35> room;
    return validity_of(mesh.order(), nodes_of_tet(mesh, static_cast<TetIndex>(i), room)) != Validity::kValid;
  }));
  if (t == mesh.tets.size()) return std::nullopt;
  std::array<Vec3, 35> room;
  const std::span<const Vec3> nodes = nodes_of_tet(mesh, t, room);
  return fmt::format("the Jacobian of tetrahedron {} at {} is not proven positive: its least coefficient is {:.3g}", t,
                     place(centroid(nodes[0], nodes[1], nodes[2], nodes[3])),
                     jacobian_range(mesh.order(), nodes).least);
}

std::optional<std::string> jacobian_defect(const TetMesh& mesh) {
  if (mesh.high_order > 0) return high_jacobian_defect(mesh);
  if (!mesh.is_second_order()) return std::nullopt;
  const auto t = static_cast<TetIndex>(parallel_find(mesh.tets.size(), [&](std::size_t i) {
    return !has_positive_jacobian(quadratic_nodes(mesh, static_cast<TetIndex>(i)));
  }));
  if (t == mesh.tets.size()) return std::nullopt;
  const auto nodes = quadratic_nodes(mesh, t);
  const auto coefficients = jacobian_coefficients(nodes);
  return fmt::format("the Jacobian of tetrahedron {} at {} is not proven positive: its least coefficient is {:.3g}", t,
                     place(centroid(nodes[0], nodes[1], nodes[2], nodes[3])),
                     *std::min_element(coefficients.begin(), coefficients.end()));
}

// What a face is of, packed into a number of the face table: faces of tets sort before those of the boundary list.
struct FaceOwner {
  std::uint32_t number;
  explicit FaceOwner(std::uint32_t face) : number(face) {}
  FaceOwner(std::uint32_t of, bool listed, const Triangle& corners)
      : number(static_cast<std::uint32_t>(listed) << 31 | of << 1 | static_cast<std::uint32_t>(is_even(corners))) {}

  bool listed() const { return number >> 31 != 0; }
  bool even() const { return (number & 1) != 0; }
  std::uint32_t of() const { return number >> 1 & (kMostOwners - 1); }  // a tet, or if listed, a face of the list

  static constexpr std::uint32_t kMostOwners = 1u << 30;
};

/// Interfaces count on behind the boundary.
const Triangle& listed_face(const TetMesh& mesh, std::size_t f) {
  return f < mesh.boundary.size() ? mesh.boundary[f] : mesh.interfaces[f - mesh.boundary.size()];
}

/// All faces are looked at.
struct AllFaces {
  static bool has_face(const Triangle&) { return true; }
  static bool has_listed(const Triangle&) { return true; }
};

/// Those that no other share can have a tetrahedron at.
struct FacesOfShare {
  const MeshShare& share;
  bool has_face(const Triangle& t) const { return !share.is_at_rim(t); }
  bool has_listed(const Triangle& t) const { return share.is_here_alone(t); }
};

bool is_interface(const TetMesh& mesh, FaceOwner f) {
  return f.listed() && f.of() >= mesh.boundary.size();
}

/// Who has each of some faces, in numbers alone: nothing is sorted, and nobody is named.
class FaceTally {
 public:
  /// Room for as many faces with the least vertex first + k as faces_of_least_vertex[k] says.
  FaceTally(VertexIndex first, std::vector<std::uint32_t>&& faces_of_least_vertex)
      : first_(first), end_(std::move(faces_of_least_vertex)) {
    std::uint32_t at = 0;
    for (std::uint32_t& n : end_) at += std::exchange(n, at);
    begin_ = end_;
    faces_.resize(at);
  }

  void add(const Triangle& key, FaceOwner owner, bool is_of_interface) {
    const VertexIndex v = key[0] - first_;
    const std::uint64_t others = std::uint64_t{key[1]} << 32 | key[2];
    std::uint32_t i = begin_[v];
    while (i < end_[v] && faces_[i].others != others) ++i;
    if (i == end_[v]) faces_[end_[v]++] = {others, 0};
    const int kind = is_of_interface ? kInterface : 2 * owner.listed() + !owner.even();
    if ((faces_[i].owners >> 2 * kind & 3) < 3) faces_[i].owners += 1u << 2 * kind;
  }

  /// Two tets from opposite sides, with an interface or without; a tet and its listed face.
  bool is_good() const {
    constexpr std::uint32_t kTets = 1 | 1 << 2, kInner = kTets | 1 << 2 * kInterface, kEven = 1 | 1 << 4,
                            kOdd = 1 << 2 | 1 << 6;
    for (std::size_t v = 0; v < begin_.size(); ++v)
      for (std::uint32_t i = begin_[v]; i < end_[v]; ++i)
        if (const std::uint32_t o = faces_[i].owners; o != kTets && o != kEven && o != kOdd && o != kInner)
          return false;
    return true;
  }

 private:
  /// Owners of a kind are counted in two bits, up to three: even and odd faces of tets, of the boundary; interfaces.
  static constexpr int kInterface = 4;
  struct Face {
    std::uint64_t others;  ///< its middle and last vertex
    std::uint32_t owners;
  };
  VertexIndex first_;
  std::vector<std::uint32_t> begin_, end_;
  std::vector<Face> faces_;
};

/// The faces of the tets and the listed ones, by ranges of their least vertices: a range at a time is looked at. Those
/// of some ranges only, so that the lists of them stay small beside a large mesh.
class FacesInRanges {
 public:
  struct Window {
    std::size_t begin, end;  ///< of ranges
    std::size_t size() const { return end - begin; }
  };

  template <class Faces>
  FacesInRanges(const TetMesh& mesh, const Faces& faces, const RangeBuckets& ranges, const Window& window)
      : mesh_(mesh),
        ranges_(ranges),
        window_(window),
        half_faces_(mesh.tets.size(), window.size(),
                    [&](std::size_t t, const auto& add) {
                      for (int i = 0; i < 4; ++i)
                        if (const Triangle face = face_of(mesh.tets[t], i); is_here(face) && faces.has_face(face))
                          add(place_of(face), static_cast<std::uint32_t>(4 * t) + i);
                    }),
        listed_(mesh.boundary.size() + mesh.interfaces.size(), window.size(), [&](std::size_t f, const auto& add) {
          if (const Triangle& face = listed_face(mesh, f); is_here(face) && faces.has_listed(face))
            add(place_of(face), static_cast<std::uint32_t>(f));
        }) {}

  bool is_good(std::size_t range) const {
    const auto first = static_cast<VertexIndex>(ranges_.begin(range));
    std::vector<std::uint32_t> count(ranges_.end(range) - first, 0);
    for_each_face(range, [&](const Triangle& corners, FaceOwner) { ++count[face_key(corners)[0] - first]; });
    FaceTally tally(first, std::move(count));
    for_each_face(range, [&](const Triangle& corners, FaceOwner owner) {
      tally.add(face_key(corners), owner, is_interface(mesh_, owner));
    });
    return tally.is_good();
  }
  /// The faces of one range, numbered by their owners.
  FaceTable table(std::size_t range) const {
    const auto first = static_cast<VertexIndex>(ranges_.begin(range));
    return {first, ranges_.end(range) - first, [&](const auto& add) {
              for_each_face(range, [&](const Triangle& corners, FaceOwner owner) { add(corners, owner.number); });
            }};
  }

 private:
  template <class Visit>
  void for_each_face(std::size_t range, const Visit& visit) const {
    for (const std::uint32_t h : half_faces_[range - window_.begin]) {
      const Triangle corners = face_of(mesh_.tets[h / 4], static_cast<int>(h % 4));
      visit(corners, FaceOwner(h / 4, false, corners));
    }
    for (const std::uint32_t f : listed_[range - window_.begin]) {
      const Triangle& corners = listed_face(mesh_, f);
      visit(corners, FaceOwner(f, true, corners));
    }
  }
  /// Among the ranges of the window; of those before it, beyond its end.
  std::size_t place_of(const Triangle& t) const { return ranges_.of(std::min({t[0], t[1], t[2]})) - window_.begin; }
  bool is_here(const Triangle& t) const { return place_of(t) < window_.size(); }

  const TetMesh& mesh_;
  RangeBuckets ranges_;
  Window window_;
  Buckets<> half_faces_, listed_;
};

/// `first`: as for sign_defect().
std::string name(const TetMesh& mesh, FaceOwner f, std::uint64_t first) {
  if (is_interface(mesh, f)) return fmt::format("interface {}", f.of() - mesh.boundary.size());
  return f.listed() ? fmt::format("boundary face {}", f.of()) : fmt::format("tetrahedron {}", first + f.of());
}

// The common cases: two tets from opposite sides, with an interface or without; a tet and its listed face.
bool is_good(const TetMesh& mesh, std::span<const FaceTable::Entry> group) {
  if (group.size() < 2 || group.size() > 3) return false;
  const FaceOwner a(group[0].face), b(group[1].face), last(group.back().face);
  if (a.listed() || (a.even() == b.even()) != b.listed()) return false;
  return group.size() == 2 ? !is_interface(mesh, b) : !b.listed() && is_interface(mesh, last);
}

// Faces with the same corners: one or two tets, or one tet and one face of the boundary list.
std::optional<std::string> face_group_defect(const TetMesh& mesh, const Triangle& corners,
                                             std::span<const FaceTable::Entry> group, std::uint64_t first) {
  const auto name_of = [&](FaceOwner f) { return name(mesh, f, first); };
  const std::string where = "face " + described(mesh.points, corners);
  const FaceOwner a(group[0].face);
  if (a.listed()) return fmt::format("{} is {} but belongs to no tetrahedron", where, name_of(a));
  if (group.size() == 1) return fmt::format("{} of {} is open but not listed as boundary", where, name_of(a));
  const FaceOwner b(group[1].face);
  if (group.size() > 2)
    return fmt::format("{} belongs to {}, {} and {}", where, name_of(a), name_of(b),
                       name_of(FaceOwner(group.back().face)));
  if (!b.listed()) return fmt::format("{}: {} and {} lie on the same side", where, name_of(a), name_of(b));
  if (is_interface(mesh, b)) return fmt::format("{}: {} has no tetrahedron behind it", where, name_of(b));
  return fmt::format("{}: {} faces inward", where, name_of(b));
}

std::optional<std::string> defect_in_table(const TetMesh& mesh, const FaceTable& faces, std::uint64_t first) {
  std::optional<std::string> defect;
  faces.for_each_group([&](const Triangle& key, std::span<const FaceTable::Entry> group) {
    if (!defect && !is_good(mesh, group)) defect = face_group_defect(mesh, key, group, first);
  });
  return defect;
}

template <class Faces>
std::optional<std::string> face_defect(const TetMesh& mesh, const Faces& which, std::uint64_t first) {
  constexpr std::size_t kFacesAtOnce = std::size_t{1} << 27;  // about: 512 MB
  const RangeBuckets ranges(mesh.points.size());
  const std::size_t rounds = std::min(4 * mesh.tets.size() / kFacesAtOnce + 1, ranges.count());
  for (std::size_t i = 0; i < rounds; ++i) {
    const FacesInRanges::Window window{ranges.count() * i / rounds, ranges.count() * (i + 1) / rounds};
    const FacesInRanges faces(mesh, which, ranges, window);
    const std::size_t bad =
        window.begin + parallel_find(window.size(), [&](std::size_t r) { return !faces.is_good(window.begin + r); });
    if (bad < window.end) return defect_in_table(mesh, faces.table(bad), first);
  }
  return std::nullopt;
}

// A triangle by its coordinates, rotated so that the least corner comes first.
using PlacedTriangle = std::array<std::array<double, 3>, 3>;

RawVector<PlacedTriangle> placed_triangles(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  RawVector<PlacedTriangle> placed(triangles.size());
  parallel_for(triangles.size(), [&](std::size_t t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 p = points[triangles[t][i]];
      placed[t][i] = {p.x, p.y, p.z};
    }
    std::rotate(placed[t].begin(), std::min_element(placed[t].begin(), placed[t].end()), placed[t].end());
  });
  return placed;
}

std::string place(const PlacedTriangle& t) {
  const auto corner = [](const std::array<double, 3>& p) { return place(Vec3{p[0], p[1], p[2]}); };
  return corner(t[0]) + " " + corner(t[1]) + " " + corner(t[2]);
}

std::optional<std::string> boundary_difference(const TetMesh& mesh, const SurfaceMesh& surface) {
  RawVector<PlacedTriangle> made = placed_triangles(mesh.points, mesh.boundary),
                            wanted = placed_triangles(surface.points, surface.triangles);
  // In the same order as a rule.
  const std::size_t both = std::min(made.size(), wanted.size());
  if (made.size() == wanted.size() && parallel_find(both, [&](std::size_t i) { return made[i] != wanted[i]; }) == both)
    return std::nullopt;
  parallel_sort(made), parallel_sort(wanted);
  const auto [m, w] = std::mismatch(made.begin(), made.end(), wanted.begin(), wanted.end());
  if (w != wanted.end() && (m == made.end() || *w < *m))
    return "the boundary lacks the surface's triangle " + place(*w);
  if (m != made.end()) return "the boundary has a triangle that the surface has not: " + place(*m);
  return std::nullopt;
}

using Check = std::optional<std::string> (*)(const TetMesh&);

std::optional<std::string> first_of(std::initializer_list<Check> checks, const TetMesh& mesh,
                                    const RunContext& context) {
  for (const Check check : checks) {
    context.check();
    if (auto defect = check(mesh)) return defect;
  }
  return std::nullopt;
}

std::optional<std::string> count_defect(const TetMesh& mesh) {
  if (std::max(mesh.tets.size(), mesh.boundary.size() + mesh.interfaces.size()) >= FaceOwner::kMostOwners)
    return "a mesh of 2^30 tetrahedra or more cannot be checked";
  return std::nullopt;
}

std::optional<std::string> volume_defect(const TetMesh& mesh) {
  return volume_defect(mesh, volume_of_tets(mesh));
}

}  // namespace

std::vector<std::uint8_t> vertices_in_use(const TetMesh& mesh) {
  std::vector<std::uint8_t> is_used(mesh.points.size(), 0);
  const auto use = [&](const auto& rows) {
    parallel_for(rows.size(), [&](std::size_t i) {
      for (const VertexIndex v : rows[i]) SharedValue(is_used[v]).store(1);
    });
  };
  use(mesh.tets);
  use(mesh.mid_nodes);
  for (const VertexIndex v : mesh.high_nodes) is_used[v] = 1;
  return is_used;
}

RoundedSum volume_of_tets(const TetMesh& mesh) {
  const auto& p = mesh.points;
  RoundedSum sum = parallel_sum(mesh.tets.size(), [&](std::size_t begin, std::size_t end) {
    RoundedSum part;
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c, d] = mesh.tets[t];
      part.add(p[b] - p[a], p[c] - p[a], p[d] - p[a]);
    }
    return part;
  });
  return sum;
}

std::optional<std::string> volume_defect(const TetMesh& mesh, const RoundedSum& tets) {
  const auto& p = mesh.points;
  const Vec3 o = bounding_box(p).center();
  const RoundedSum enclosed = parallel_sum(mesh.boundary.size(), [&](std::size_t begin, std::size_t end) {
    RoundedSum part;
    for (std::size_t f = begin; f < end; ++f) {
      const auto& [a, b, c] = mesh.boundary[f];
      part.add(p[a] - o, p[b] - o, p[c] - o);
    }
    return part;
  });
  constexpr double kRoundingsPerTerm = 16, epsilon = std::numeric_limits<double>::epsilon();
  const double rounding = epsilon * ((tets.terms + enclosed.terms) * (tets.magnitude + enclosed.magnitude) +
                                     kRoundingsPerTerm * (tets.products + enclosed.products));
  if (std::abs(tets.six_volumes - enclosed.six_volumes) <= rounding) return std::nullopt;
  return fmt::format("the tetrahedra have a volume of {:.17g}, their boundary encloses {:.17g}", tets.six_volumes / 6,
                     enclosed.six_volumes / 6);
}

std::optional<std::string> indices_defect(const TetMesh& mesh) {
  return first_of({count_defect, point_defect}, mesh, {});
}

std::optional<std::string> share_defect(const TetMesh& mesh, const MeshShare& share, const RunContext& context) {
  if (auto defect = unused_defect(mesh, share.used_by_any)) return defect;
  if (auto defect = first_of({array_defect, set_defect, wide_defect}, mesh, context)) return defect;
  if (auto defect = sign_defect(mesh, share.first_tet)) return defect;
  return face_defect(mesh, FacesOfShare{share}, share.first_tet);
}

std::vector<RimFace> rim_faces(const TetMesh& mesh, const MeshShare& share) {
  std::vector<RimFace> faces;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (int i = 0; i < 4; ++i)
      if (const Triangle face = face_of(mesh.tets[t], i); share.is_at_rim(face))
        faces.push_back({face, static_cast<std::uint32_t>(share.first_tet + t)});
  return faces;
}

std::optional<std::string> rim_defect(const TetMesh& mesh, const MeshShare& share, std::span<const RimFace> faces,
                                      VertexIndex begin, VertexIndex end) {
  const FaceTable table(begin, end - begin, [&](const auto& add) {
    for (const RimFace& f : faces) add(f.corners, FaceOwner(f.tet, false, f.corners).number);
    for (std::size_t f = 0; f < mesh.boundary.size() + mesh.interfaces.size(); ++f) {
      const Triangle& corners = listed_face(mesh, f);
      const VertexIndex least = face_key(corners)[0];
      if (share.is_at_rim(corners) && least >= begin && least < end)
        add(corners, FaceOwner(static_cast<std::uint32_t>(f), true, corners).number);
    }
  });
  return defect_in_table(mesh, table, 0);
}

std::optional<std::string> difference_to(const TetMesh& mesh, const SurfaceMesh& surface) {
  for (const Triangle& t : surface.triangles)
    for (const VertexIndex v : t)
      if (v >= surface.points.size()) return fmt::format("the surface has no vertex {} for one of its triangles", v);
  return is_complex(surface) ? difference_to_complex(mesh, surface) : boundary_difference(mesh, surface);
}

std::optional<std::string> first_defect(const TetMesh& mesh, const RunContext& context) {
  if (auto defect =
          first_of({count_defect, point_defect, use_defect, array_defect, set_defect, wide_defect}, mesh, context))
    return defect;
  if (auto defect = sign_defect(mesh, 0)) return defect;
  context.check();
  if (auto defect = face_defect(mesh, AllFaces(), 0)) return defect;
  return first_of({curve_defect, mid_node_defect, jacobian_defect, volume_defect}, mesh, context);
}

std::optional<std::string> first_defect(const TetMesh& mesh, const SurfaceMesh& surface, const RunContext& context) {
  if (auto defect = first_defect(mesh, context)) return defect;
  return difference_to(mesh, surface);
}

}  // namespace octafront
