// Is a mesh of a CAD file what the file says? OpenCASCADE reads the file and measures; nothing of octafront-cad or of
// the mesher has a part in it. Prints one JSON object:
//   octafront_judge_cad MESH FILE [--millimetres N] [--nodes N]
// millimetres: how many a unit of the mesh has; nodes: of more, so many at most are looked at, evenly taken;
// whether corners and mid-side nodes of the boundary are on the geometry (distances are to the nearest face, edge or
// vertex, whichever the node was meant to lie on), the area of each region and the box, patches, and of poor elements
// what is narrow in the shape where they are.

#include <octafront/io.h>
#include <octafront/quality.h>

#include "base/geometry/measures.h"
#include "judged_shape.h"
#include "narrow_places.h"

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Standard_Failure.hxx>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace {

using namespace octafront;
using Json = nlohmann::ordered_json;

/// A node is on the geometry if it is nearer to it than this part of the diagonal, or than the tolerance of the file
/// there.
constexpr double kOnGeometry = 1e-9;

/// Elements below are poor; so many of them are looked at, the worst by beta.
constexpr double kPoorBeta = 0.2, kPoorAngle = 10;
constexpr std::size_t kMostPoor = 50;

struct Asked {
  double millimetres = 1;
  std::size_t nodes = std::size_t{1} << 40;

  /// False: not understood.
  bool take(const std::string& option, const char* value) {
    if (option == "--millimetres") return (millimetres = std::strtod(value, nullptr)) > 0;
    if (option == "--nodes") return (nodes = std::strtoul(value, nullptr, 10)) > 0;
    return false;
  }
};

/// The faces of boundary and interfaces, with their mid-side nodes.
struct Skin {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> patches;            ///< one per triangle
  std::vector<std::array<VertexIndex, 3>> mids;  ///< one per triangle: of its sides 01, 12, 20; or none at all
};

Edge sorted(VertexIndex a, VertexIndex b) {
  return {std::min(a, b), std::max(a, b)};
}

std::map<Edge, VertexIndex> mids_at(const TetMesh& mesh, const std::vector<Triangle>& triangles) {
  std::map<Edge, VertexIndex> mids;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) mids[sorted(t[k], t[(k + 1) % 3])] = kNone;
  for (std::size_t t = 0; t < mesh.mid_nodes.size(); ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const auto& [a, b] = kTetEdges[e];
      const auto found =
          mids.find(sorted(mesh.tets[t][static_cast<std::size_t>(a)], mesh.tets[t][static_cast<std::size_t>(b)]));
      if (found != mids.end()) found->second = mesh.mid_nodes[t][e];
    }
  return mids;
}

Skin skin_of(const TetMesh& mesh) {
  Skin skin{mesh.boundary, mesh.patch, {}};
  skin.patches.resize(skin.triangles.size(), 0);
  skin.triangles.insert(skin.triangles.end(), mesh.interfaces.begin(), mesh.interfaces.end());
  skin.patches.insert(skin.patches.end(), mesh.interface_patch.begin(), mesh.interface_patch.end());
  skin.patches.resize(skin.triangles.size(), 0);
  if (!mesh.is_second_order()) return skin;
  const auto mids = mids_at(mesh, skin.triangles);
  for (const Triangle& t : skin.triangles)
    skin.mids.push_back({mids.at(sorted(t[0], t[1])), mids.at(sorted(t[1], t[2])), mids.at(sorted(t[2], t[0]))});
  return skin;
}

/// Each node once, with the patch of a face that it is on; ordered by patch.
std::vector<std::pair<std::uint32_t, VertexIndex>> nodes_of(const Skin& skin,
                                                            const std::vector<std::array<VertexIndex, 3>>& of) {
  std::map<VertexIndex, std::uint32_t> patch_of;
  for (std::size_t t = 0; t < of.size(); ++t)
    for (const VertexIndex v : of[t]) patch_of.insert({v, skin.patches[t]});
  std::vector<std::pair<std::uint32_t, VertexIndex>> nodes;
  for (const auto& [v, patch] : patch_of) nodes.push_back({patch, v});
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

Json on_geometry(const TetMesh& mesh, const Skin& skin, const std::vector<std::array<VertexIndex, 3>>& of,
                 const JudgedShape& shape, const Asked& asked) {
  const double unit = asked.millimetres, diagonal = unit * bounding_box(mesh.points).diagonal(),
               allowed = kOnGeometry * diagonal;
  std::size_t nodes = 0, off = 0, last = 0;
  double largest = 0;
  Vec3 where;
  const auto all = nodes_of(skin, of);
  const std::size_t step = (all.size() + asked.nodes - 1) / asked.nodes;
  for (std::size_t i = 0; i < all.size(); i += step) {
    const VertexIndex v = all[i].second;
    const JudgedShape::Found found = shape.nearest(unit * mesh.points[v], allowed / 10, last);
    if (!std::isfinite(found.distance)) throw std::runtime_error("the file has no face and no edge to measure to");
    ++nodes, last = found.face;
    off += found.distance > std::max(allowed, found.tolerance);
    if (found.distance / diagonal > largest) largest = found.distance / diagonal, where = mesh.points[v];
  }
  return {{"nodes", nodes}, {"off", off}, {"largest", largest}, {"where", {where.x, where.y, where.z}}};
}

/// Of the quadratic triangle, by Gauss's rule of degree 5 with seven points (G. R. Cowper, 1973).
double curved_area(const std::array<Vec3, 3>& corner, const std::array<Vec3, 3>& mid) {
  const double r = std::sqrt(15.0);
  const double a = (6 - r) / 21, b = (6 + r) / 21, wa = (155 - r) / 1200, wb = (155 + r) / 1200;
  const double rule[7][3] = {{1. / 3, 1. / 3, 9. / 40}, {a, a, wa}, {1 - 2 * a, a, wa},
                             {a, 1 - 2 * a, wa},        {b, b, wb}, {1 - 2 * b, b, wb},
                             {b, 1 - 2 * b, wb}};
  double area = 0;
  for (const auto& [u, v, weight] : rule) {
    const double w = 1 - u - v;
    const Vec3 du =
        (4 * u - 1) * corner[1] - (4 * w - 1) * corner[0] + 4 * (w - u) * mid[0] + 4 * v * mid[1] - 4 * v * mid[2];
    const Vec3 dv =
        (4 * v - 1) * corner[2] - (4 * w - 1) * corner[0] - 4 * u * mid[0] + 4 * u * mid[1] + 4 * (w - v) * mid[2];
    area += weight * length(cross(du, dv)) / 2;
  }
  return area;
}

double area_of(const TetMesh& mesh, const Skin& skin, std::size_t t) {
  const auto at = [&](const std::array<VertexIndex, 3>& v) {
    return std::array<Vec3, 3>{mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]};
  };
  const auto corners = at(skin.triangles[t]);
  return skin.mids.empty() ? triangle_area(corners[0], corners[1], corners[2]) : curved_area(corners, at(skin.mids[t]));
}

/// What bounds each region, by number: a face between two counts for both.
std::vector<double> areas_of(const TetMesh& mesh, const Skin& skin) {
  std::map<Triangle, double> area;
  for (std::size_t t = 0; t < skin.triangles.size(); ++t) {
    Triangle key = skin.triangles[t];
    std::sort(key.begin(), key.end());
    area[key] = area_of(mesh, skin, t);
  }
  std::vector<char> is_outer(mesh.points.size(), 0);
  for (const Triangle& t : skin.triangles)
    for (const VertexIndex v : t) is_outer[v] = 1;
  std::vector<double> of_region;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const std::size_t r = mesh.region.empty() ? 0 : mesh.region[t];
    if (r >= of_region.size()) of_region.resize(r + 1, 0);
    for (const auto& f : kTetFaces) {
      Triangle key;
      for (std::size_t k = 0; k < 3; ++k) key[k] = mesh.tets[t][static_cast<std::size_t>(f[k])];
      if (!is_outer[key[0]] || !is_outer[key[1]] || !is_outer[key[2]]) continue;
      std::sort(key.begin(), key.end());
      if (const auto found = area.find(key); found != area.end()) of_region[r] += found->second;
    }
  }
  return of_region;
}

/// By how much a side of one box is beside that of the other at most.
double beside(const Box3& a, const Box3& b) {
  const Vec3 lo = a.lo - b.lo, hi = a.hi - b.hi;
  return std::max({std::abs(lo.x), std::abs(lo.y), std::abs(lo.z), std::abs(hi.x), std::abs(hi.y), std::abs(hi.z)});
}

Json number(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

/// Elements that are poor, and how many of them the shape does not force; what is narrow at the worst.
Json poor_elements_of(const TetMesh& mesh, const NarrowPlaces& narrow, double unit) {
  std::vector<std::pair<double, TetIndex>> poor;
  for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    const double beta = tet_radius_ratio(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
    const auto angles = dihedral_angles(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
    if (beta < kPoorBeta || *std::min_element(angles.begin(), angles.end()) < kPoorAngle) poor.push_back({beta, t});
  }
  std::sort(poor.begin(), poor.end());
  Json found{{"elements", poor.size()}, {"judged", std::min(poor.size(), kMostPoor)}, {"unforced", 0}};
  for (std::size_t i = 0; i < std::min(poor.size(), kMostPoor); ++i) {
    const auto& [a, b, c, d] = mesh.tets[poor[i].second];
    const Vec3 p = mesh.points[a], q = mesh.points[b], r = mesh.points[c], s = mesh.points[d];
    const Narrow at = narrow.at(unit * centroid(p, q, r, s), unit * std::sqrt(longest_squared_edge(p, q, r, s)));
    if (i == 0)
      found["wedge"] = number(at.wedge), found["corner"] = number(at.corner), found["edge"] = number(at.edge),
      found["gap"] = number(at.gap);
    if (!at.forces_poor_elements()) found["unforced"] = found["unforced"].get<int>() + 1;
  }
  return found;
}

Json judged(const TetMesh& mesh, const TopoDS_Shape& file, const Asked& asked) {
  const double unit = asked.millimetres;
  const Skin skin = skin_of(mesh);
  const JudgedShape shape(file);
  const ShapeMeasures measures = measures_of(file);
  Json j{{"vertices", on_geometry(mesh, skin, skin.triangles, shape, asked)},
         {"mid_side", on_geometry(mesh, skin, skin.mids, shape, asked)}};
  j["areas"] = areas_of(mesh, skin);
  j["true"] = {{"solids", measures.solids}, {"faces", measures.faces}, {"area", measures.area / (unit * unit)}};
  Box3 box = bounding_box(mesh.points);
  box.lo = unit * box.lo, box.hi = unit * box.hi;
  j["box"] = beside(box, measures.box) / measures.box.diagonal();
  j["patches"] = std::set<std::uint32_t>(skin.patches.begin(), skin.patches.end()).size();
  j["poor"] = poor_elements_of(mesh, NarrowPlaces(sewn(file)), unit);
  return j;
}

}  // namespace

int main(int argc, char** argv) {
  Asked asked;
  bool understood = argc >= 3 && argc % 2 == 1;
  for (int i = 3; understood && i < argc; i += 2) understood = asked.take(argv[i], argv[i + 1]);
  if (!understood) {
    std::fputs("octafront_judge_cad MESH FILE [--millimetres N] [--nodes N]\n", stderr);
    return 2;
  }
  try {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    const TetMesh mesh = read_mesh(argv[1]);
    fmt::print("{}\n", judged(mesh, shape_of(argv[2]), asked).dump());
    return 0;
  } catch (const Standard_Failure& failure) {
    std::fprintf(stderr, "octafront_judge_cad: %s\n", failure.GetMessageString());
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "octafront_judge_cad: %s\n", failure.what());
  }
  return 1;
}
