#include <octafront/validity.h>

#include "geometry/measures.h"
#include "geometry/predicates.h"
#include "mesh/adjacency.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <fmt/format.h>

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

std::optional<std::string> point_defect(const TetMesh& mesh) {
  if (mesh.tets.empty()) return "the mesh has no tetrahedra";
  const std::size_t n = mesh.points.size();
  for (std::size_t v = 0; v < n; ++v)
    if (!is_finite(mesh.points[v])) return fmt::format("vertex {} {} is not finite", v, place(mesh.points[v]));
  std::vector<bool> used(n, false);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const VertexIndex v : mesh.tets[t]) {
      if (v >= n) return fmt::format("tetrahedron {} refers to vertex {}, but there are only {}", t, v, n);
      used[v] = true;
    }
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f)
    for (const VertexIndex v : mesh.boundary[f])
      if (v >= n) return fmt::format("boundary face {} refers to vertex {}, but there are only {}", f, v, n);
  const auto unused = std::find(used.begin(), used.end(), false);
  if (unused != used.end()) {
    const auto v = static_cast<std::size_t>(unused - used.begin());
    return fmt::format("vertex {} {} belongs to no tetrahedron", v, place(mesh.points[v]));
  }
  return std::nullopt;
}

std::optional<std::string> array_defect(const TetMesh& mesh) {
  const auto misfit = [](const char* name, std::size_t size, std::size_t wanted,
                         const char* of) -> std::optional<std::string> {
    if (size == 0 || size == wanted) return std::nullopt;
    return fmt::format("{} has {} entries for {} {}", name, size, wanted, of);
  };
  if (auto d = misfit("region", mesh.region.size(), mesh.tets.size(), "tetrahedra")) return d;
  if (auto d = misfit("patch", mesh.patch.size(), mesh.boundary.size(), "boundary faces")) return d;
  return misfit("source", mesh.source.size(), mesh.boundary.size(), "boundary faces");
}

std::optional<std::string> sign_defect(const TetMesh& mesh) {
  const auto& p = mesh.points;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    const int sign = orient3d(p[a], p[b], p[c], p[d]);
    if (sign == 1) continue;
    return fmt::format("tetrahedron {} is {}, volume {:.3g}: vertices {} {} {} {} at {} {} {} {}", t,
                       sign == 0 ? "flat" : "inverted", signed_volume(p[a], p[b], p[c], p[d]), a, b, c, d, place(p[a]),
                       place(p[b]), place(p[c]), place(p[d]));
  }
  return std::nullopt;
}

// A face with its corners sorted; `even` tells which way round it was.
struct SortedFace {
  Triangle corners;
  std::uint32_t owner;  // a tet, or if listed, a face of the boundary list
  bool even, listed;

  SortedFace() = default;
  SortedFace(const Triangle& t, std::uint32_t of, bool in_list) : owner(of), listed(in_list) {
    const FaceKey key(t);
    corners = {key.low, key.middle, key.high};
    even = key.even;
  }
};

// All faces of tets and of the boundary list, grouped by their least corner.
struct FacesByCorner {
  std::vector<std::uint64_t> first;  // per vertex, and one past the end
  std::vector<SortedFace> faces;
};

FacesByCorner group_faces(const TetMesh& mesh) {
  FacesByCorner g;
  g.first.assign(mesh.points.size() + 1, 0);
  const auto for_each_face = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < mesh.tets.size(); ++t)
      for (const auto& [i, j, k] : kTetFaces)
        visit(Triangle{mesh.tets[t][i], mesh.tets[t][j], mesh.tets[t][k]}, t, false);
    for (std::uint32_t f = 0; f < mesh.boundary.size(); ++f) visit(mesh.boundary[f], f, true);
  };
  for_each_face([&](const Triangle& t, std::uint32_t, bool) { ++g.first[std::min({t[0], t[1], t[2]}) + 1]; });
  for (std::size_t v = 0; v + 1 < g.first.size(); ++v) g.first[v + 1] += g.first[v];
  g.faces.resize(g.first.back());
  std::vector<std::uint64_t> next(g.first.begin(), g.first.end() - 1);
  for_each_face([&](const Triangle& t, std::uint32_t owner, bool listed) {
    const SortedFace f(t, owner, listed);
    g.faces[next[f.corners[0]]++] = f;
  });
  return g;
}

std::string name(const SortedFace& f) {
  return fmt::format("{} {}", f.listed ? "boundary face" : "tetrahedron", f.owner);
}

// The faces [begin, end) have the same corners: one or two tets, or one tet and one face of the boundary list.
std::optional<std::string> face_group_defect(const TetMesh& mesh, const SortedFace* begin, const SortedFace* end) {
  const std::string where = "face " + described(mesh.points, begin->corners);
  const auto count = end - begin;
  if (begin->listed) return fmt::format("{} is {} but belongs to no tetrahedron", where, name(*begin));
  if (count == 1) return fmt::format("{} of tetrahedron {} is open but not listed as boundary", where, begin->owner);
  const SortedFace &a = begin[0], &b = begin[1];
  if (count > 2) return fmt::format("{} belongs to {}, {} and {}", where, name(a), name(b), name(begin[2]));
  if (!b.listed && a.even == b.even) return fmt::format("{}: {} and {} lie on the same side", where, name(a), name(b));
  if (b.listed && a.even != b.even) return fmt::format("{}: {} faces inward", where, name(b));
  return std::nullopt;
}

std::optional<std::string> face_defect(const TetMesh& mesh) {
  FacesByCorner g = group_faces(mesh);
  for (std::size_t v = 0; v + 1 < g.first.size(); ++v) {
    SortedFace* const end = g.faces.data() + g.first[v + 1];
    SortedFace* group = g.faces.data() + g.first[v];
    std::sort(group, end, [](const SortedFace& a, const SortedFace& b) {
      return std::tie(a.corners, a.listed, a.owner) < std::tie(b.corners, b.listed, b.owner);
    });
    while (group != end) {
      SortedFace* const next =
          std::find_if(group, end, [&](const SortedFace& f) { return f.corners != group->corners; });
      // The common cases: two tets from opposite sides, a tet and its listed face.
      const bool good = next - group == 2 && !group[0].listed && (group[0].even == group[1].even) == group[1].listed;
      if (!good)
        if (auto defect = face_group_defect(mesh, group, next)) return defect;
      group = next;
    }
  }
  return std::nullopt;
}

// The sum of six volumes of the tetrahedra (a, b, c, o), with what rounding may do to it: little of the sum where they
// are large, but much where they are flat.
struct RoundedSum {
  double six_volumes = 0, magnitude = 0, products = 0;
  void add(Vec3 a, Vec3 b, Vec3 c) {
    const double term = dot(a, cross(b, c));
    six_volumes += term;
    magnitude += std::abs(term);
    products += std::sqrt(squared_length(a) * squared_length(b) * squared_length(c));
  }
};

// Follows from the other laws, so it guards the checks themselves: equal but for rounding.
std::optional<std::string> volume_defect(const TetMesh& mesh) {
  const auto& p = mesh.points;
  const Vec3 o = bounding_box(p).center();
  RoundedSum tets, enclosed;
  for (const auto& [a, b, c, d] : mesh.tets) tets.add(p[b] - p[a], p[c] - p[a], p[d] - p[a]);
  for (const auto& [a, b, c] : mesh.boundary) enclosed.add(p[a] - o, p[b] - o, p[c] - o);
  constexpr double kRoundingsPerTerm = 16, epsilon = std::numeric_limits<double>::epsilon();
  const auto terms = static_cast<double>(mesh.tets.size() + mesh.boundary.size());
  const double rounding = epsilon * (terms * (tets.magnitude + enclosed.magnitude) +
                                     kRoundingsPerTerm * (tets.products + enclosed.products));
  if (std::abs(tets.six_volumes - enclosed.six_volumes) <= rounding) return std::nullopt;
  return fmt::format("the tetrahedra have a volume of {:.17g}, their boundary encloses {:.17g}", tets.six_volumes / 6,
                     enclosed.six_volumes / 6);
}

// A triangle by its coordinates, rotated so that the least corner comes first.
using PlacedTriangle = std::array<std::array<double, 3>, 3>;

std::vector<PlacedTriangle> placed_triangles(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  std::vector<PlacedTriangle> out;
  out.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    PlacedTriangle placed;
    for (int i = 0; i < 3; ++i) placed[i] = {points[t[i]].x, points[t[i]].y, points[t[i]].z};
    std::rotate(placed.begin(), std::min_element(placed.begin(), placed.end()), placed.end());
    out.push_back(placed);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::string place(const PlacedTriangle& t) {
  const auto corner = [](const std::array<double, 3>& p) { return place(Vec3{p[0], p[1], p[2]}); };
  return corner(t[0]) + " " + corner(t[1]) + " " + corner(t[2]);
}

std::optional<std::string> boundary_difference(const TetMesh& mesh, const SurfaceMesh& surface) {
  const auto made = placed_triangles(mesh.points, mesh.boundary);
  const auto wanted = placed_triangles(surface.points, surface.triangles);
  const auto [m, w] = std::mismatch(made.begin(), made.end(), wanted.begin(), wanted.end());
  if (w != wanted.end() && (m == made.end() || *w < *m))
    return "the boundary lacks the surface's triangle " + place(*w);
  if (m != made.end()) return "the boundary has a triangle that the surface has not: " + place(*m);
  return std::nullopt;
}

}  // namespace

std::optional<std::string> first_defect(const TetMesh& mesh) {
  if (mesh.tets.size() >= (std::size_t{1} << 30)) return "a mesh of 2^30 tetrahedra or more cannot be checked";
  for (const auto check : {point_defect, array_defect, sign_defect, face_defect, volume_defect})
    if (auto defect = check(mesh)) return defect;
  return std::nullopt;
}

std::optional<std::string> first_defect(const TetMesh& mesh, const SurfaceMesh& surface) {
  if (auto defect = first_defect(mesh)) return defect;
  for (const Triangle& t : surface.triangles)
    for (const VertexIndex v : t)
      if (v >= surface.points.size()) return fmt::format("the surface has no vertex {} for one of its triangles", v);
  return boundary_difference(mesh, surface);
}

}  // namespace octafront
