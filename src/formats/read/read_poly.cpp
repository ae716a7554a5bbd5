// TetGen's piecewise linear complexes. .poly: nodes; facets of several polygons, with points in their holes and a
// marker; points in holes; points in regions with an attribute. .smesh: the same with one polygon a facet. Where there
// are 0 nodes, they stand in NAME.node. Numbers count from 0 or 1, as the first node says.

#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "base/geometry/plane_mesh.h"
#include "base/geometry/predicates.h"
#include "formats/containers/scanner.h"
#include "formats/parts/surface_builder.h"
#include "formats/read/readers.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include <fmt/core.h>

namespace octafront::io {
namespace {

using arrangement::PlaneMesh;

struct Facet {
  std::vector<std::vector<std::uint32_t>> polygons;
  std::vector<Vec3> holes;
};

/// Divides a facet of several polygons: covered is what lies in some polygon, but for the innermost ones around points
/// in holes. Polygons of two corners are lines that its triangles follow, of one corner points.
class FacetDivision {
 public:
  FacetDivision(std::vector<Vec3>& points, const Facet& facet) : points_(points), facet_(facet) {}

  /// False if no polygon spans a plane.
  bool divide(std::vector<Triangle>& triangles) {
    if (!find_plane()) return false;
    Box3 box;
    for (const auto& polygon : facet_.polygons)
      for (const std::uint32_t v : polygon) box.add(points_[v]);
    PlaneMesh mesh(arrangement::plane_through(corner_[0], corner_[1], corner_[2]), axis_, box);
    for (const auto& polygon : facet_.polygons)
      for (const std::uint32_t v : polygon) add_point(mesh, v);
    for (std::uint32_t k = 0; k < facet_.polygons.size(); ++k) add_polygon(mesh, k);
    mesh.improve();
    for (std::size_t i = 0; i < mesh.crossings().size(); ++i) {
      set_vertex(mesh.first_crossing_node(i), static_cast<std::uint32_t>(points_.size()));
      points_.push_back(mesh.crossings()[i].at);
    }
    const std::vector<std::uint32_t> hollow = polygons_around_holes();
    for (const PlaneMesh::Piece& piece : mesh.pieces()) {
      const auto in_hole = [&](std::uint32_t k) {
        return std::binary_search(piece.faces.begin(), piece.faces.end(), k);
      };
      if (std::none_of(hollow.begin(), hollow.end(), in_hole))
        triangles.push_back({vertex_[piece.corners[0]], vertex_[piece.corners[1]], vertex_[piece.corners[2]]});
    }
    return true;
  }

 private:
  /// Three corners that span the plane, and the axis along which it is seen best.
  bool find_plane() {
    double largest = 0;
    for (const auto& polygon : facet_.polygons)
      for (std::size_t i = 2; i < polygon.size(); ++i) {
        const Vec3 a = points_[polygon[0]], b = points_[polygon[i - 1]], c = points_[polygon[i]];
        const Vec3 n = double_area_normal(a, b, c);
        if (squared_length(n) <= largest || collinear(a, b, c)) continue;
        largest = squared_length(n);
        corner_ = {a, b, c};
        const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
        axis_ = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
      }
    return largest > 0;
  }

  void set_vertex(PlaneMesh::Node n, std::uint32_t v) {
    if (n >= vertex_.size()) vertex_.resize(n + 1, kNone);
    if (vertex_[n] == kNone) vertex_[n] = v;
  }

  void add_point(PlaneMesh& mesh, std::uint32_t v) {
    const PlaneMesh::Node n = mesh.add_point({points_[v]});
    set_vertex(n, v);
    node_.try_emplace(v, n);
  }

  void add_polygon(PlaneMesh& mesh, std::uint32_t k) {
    const auto& polygon = facet_.polygons[k];
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const std::uint32_t a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      if (node_.at(a) == node_.at(b)) continue;
      mesh.add_segment(node_.at(a), node_.at(b), arrangement::plane_along_axis(points_[a], points_[b], axis_),
                       polygon.size() > 2 ? k : kNone);
      if (polygon.size() == 2) break;
    }
  }

  double area_seen(std::uint32_t k) const {
    const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
    double area = 0;
    const auto& polygon = facet_.polygons[k];
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 p = points_[polygon[i]], q = points_[polygon[(i + 1) % polygon.size()]];
      area += p[u] * q[v] - p[v] * q[u];
    }
    return std::abs(area);
  }

  bool contains(std::uint32_t k, Vec3 p) const {
    const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
    bool inside = false;
    const auto& polygon = facet_.polygons[k];
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 a = points_[polygon[i]], b = points_[polygon[(i + 1) % polygon.size()]];
      if ((a[v] > p[v]) == (b[v] > p[v])) continue;
      const int side = orient2d(a[u], a[v], b[u], b[v], p[u], p[v]);
      inside ^= (side > 0) == (b[v] > a[v]);
    }
    return inside;
  }

  std::vector<std::uint32_t> polygons_around_holes() const {
    std::vector<std::uint32_t> hollow;
    for (const Vec3 hole : facet_.holes) {
      std::uint32_t innermost = kNone;
      for (std::uint32_t k = 0; k < facet_.polygons.size(); ++k)
        if (facet_.polygons[k].size() > 2 && contains(k, hole) &&
            (innermost == kNone || area_seen(k) < area_seen(innermost)))
          innermost = k;
      if (innermost != kNone) hollow.push_back(innermost);
    }
    return hollow;
  }

  std::vector<Vec3>& points_;
  const Facet& facet_;
  std::array<Vec3, 3> corner_;
  int axis_ = 0;
  std::vector<std::uint32_t> vertex_;              ///< per node
  std::map<std::uint32_t, PlaneMesh::Node> node_;  ///< of vertices
};

class Poly {
 public:
  Poly(const Input& input, bool simple, const Input* nodes)
      : input_(input), scan_(input, '#'), nodes_(nodes), simple_(simple) {}

  SurfaceFile read() {
    read_nodes();
    read_facets();
    read_holes();
    read_regions();
    name_patches();
    if (degenerate_ > 0) builder_.notes.push_back(counted(degenerate_, "facet") + " without area left out");
    SurfaceFile file = builder_.finish(input_, simple_ ? "TetGen .smesh" : "TetGen .poly", true, first_);
    file.regions = std::move(regions_);
    file.voids = std::move(voids_);
    return file;
  }

 private:
  void read_nodes() {
    const std::uint64_t n = read_count(scan_, input_, "nodes", 8);
    scan_.skip_line();
    if (n > 0) return read_node_lines(scan_, n);
    if (nodes_ == nullptr) scan_.fail("there are 0 nodes here, and no file .node beside");
    Scanner scan(*nodes_, '#');
    const std::uint64_t beside = read_count(scan, *nodes_, "nodes", 8);
    scan.skip_line();
    read_node_lines(scan, beside);
  }

  void read_node_lines(Scanner& scan, std::uint64_t n) {
    builder_.points.reserve(n);
    for (std::uint64_t i = 0; i < n; ++i) {
      const std::int64_t id = scan.integer("the number of a node");
      if (i == 0) first_ = static_cast<int>(std::clamp<std::int64_t>(id, -1, 2));
      if ((first_ != 0 && first_ != 1) || id != first_ + static_cast<std::int64_t>(i))
        scan.fail(fmt::format("expected node {}, found {}; nodes count from 0 or 1, one after the other",
                              static_cast<std::int64_t>(i) + (first_ == 0 ? 0 : 1), id));
      builder_.points.push_back(scan.point());
      scan.skip_line();
    }
  }

  std::uint32_t corner() {
    const std::int64_t c = scan_.integer("the number of a node");
    if (c < first_ || static_cast<std::uint64_t>(c - first_) >= builder_.points.size())
      scan_.fail(fmt::format("there is no node {} ({} to {} are)", c, first_,
                             static_cast<std::int64_t>(builder_.points.size()) - 1 + first_));
    return static_cast<std::uint32_t>(c - first_);
  }

  std::vector<std::uint32_t> polygon() {
    const std::uint64_t corners = read_count(scan_, input_, "corners of a polygon", 2);
    std::vector<std::uint32_t> all;
    for (std::uint64_t k = 0; k < corners; ++k) all.push_back(corner());
    return all;
  }

  void read_facets() {
    const std::uint64_t facets = read_count(scan_, input_, "facets", 4);
    const bool has_markers = !scan_.at_line_end() && scan_.integer("whether there are markers") > 0;
    scan_.skip_line();
    const std::size_t nodes = builder_.points.size();
    for (std::uint64_t f = 0; f < facets; ++f) {
      if (simple_) {
        scan_.at_end();
        const char* const at = scan_.position();
        const Facet facet{{polygon()}, {}};
        add_facet(facet, has_markers && !scan_.at_line_end() ? scan_.integer("a marker") : 0, at);
        scan_.skip_line();
      } else {
        read_facet(has_markers);
      }
    }
    crossings_ = builder_.points.size() - nodes;
    if (crossings_ > 0)
      builder_.notes.push_back(fmt::format("lines of facets cross at {}",
                                           counted(crossings_, "point that is no node", "points that are no nodes")));
  }

  void read_facet(bool has_markers) {
    scan_.at_end();
    const char* const at = scan_.position();
    const std::uint64_t polygons = read_count(scan_, input_, "polygons of a facet", 2);
    const std::uint64_t holes = scan_.at_line_end() ? 0 : read_count(scan_, input_, "holes of a facet", 6);
    const std::int64_t marker = has_markers && !scan_.at_line_end() ? scan_.integer("a marker") : 0;
    scan_.skip_line();
    Facet facet;
    for (std::uint64_t k = 0; k < polygons; ++k) {
      facet.polygons.push_back(polygon());
      scan_.skip_line();
    }
    for (std::uint64_t k = 0; k < holes; ++k) {
      scan_.integer("the number of a hole");
      facet.holes.push_back(scan_.point());
      scan_.skip_line();
    }
    add_facet(facet, marker, at);
  }

  void add_facet(const Facet& facet, std::int64_t marker, const char* at) {
    const auto [known, is_new] = patch_.try_emplace(marker, static_cast<std::uint32_t>(patch_.size()));
    const std::uint32_t patch = known->second;
    if (facet.polygons.size() == 1 && facet.holes.empty()) {
      if (facet.polygons[0].size() < 3) {
        ++degenerate_;
      } else {
        builder_.add_face(facet.polygons[0], at, patch);
      }
      return;
    }
    std::vector<Triangle> triangles;
    if (!FacetDivision(builder_.points, facet).divide(triangles)) ++degenerate_;
    for (const Triangle& t : triangles) builder_.add_face(t, at, patch);
  }

  void read_holes() {
    if (scan_.at_end()) return;
    const std::uint64_t holes = read_count(scan_, input_, "holes", 6);
    for (std::uint64_t k = 0; k < holes; ++k) {
      scan_.integer("the number of a hole");
      voids_.push_back(scan_.point());
      scan_.skip_line();
    }
  }

  void read_regions() {
    if (scan_.at_end()) return;
    const std::uint64_t regions = read_count(scan_, input_, "regions", 6);
    bool sized = false;
    for (std::uint64_t k = 0; k < regions; ++k) {
      scan_.integer("the number of a region");
      const Vec3 at = scan_.point();
      const double attribute = scan_.at_line_end() ? 0 : scan_.number("an attribute");
      sized = sized || !scan_.at_line_end();
      regions_.push_back({fmt::format("region_{:g}", attribute), at});
      scan_.skip_line();
    }
    if (sized) builder_.notes.emplace_back("largest volumes of elements in regions are not taken over; give sizes");
  }

  void name_patches() {
    if (patch_.size() < 2) return;
    builder_.patch_names.resize(patch_.size());
    for (const auto& [marker, patch] : patch_) builder_.patch_names[patch] = fmt::format("marker_{}", marker);
  }

  const Input& input_;
  Scanner scan_;
  const Input* nodes_;
  bool simple_;
  int first_ = 1;
  SurfaceBuilder builder_;
  std::map<std::int64_t, std::uint32_t> patch_;  ///< of markers
  std::vector<RegionSeed> regions_;
  std::vector<Vec3> voids_;
  std::uint64_t degenerate_ = 0, crossings_ = 0;
};

}  // namespace

Told told_poly(const FileHead& head) {
  return head.ends_in({".poly", ".smesh"}) ? Told::kEnding : Told::kNot;
}

SurfaceFile read_poly(const Input& input, bool simple, const Input* nodes) {
  return Poly(input, simple, nodes).read();
}

SurfaceFile read_poly(const Input& input) {
  namespace fs = std::filesystem;
  const bool simple = equal_ignoring_case(fs::path(input.name).extension().string(), ".smesh");
  const fs::path nodes = fs::path(input.name).replace_extension(".node");
  std::optional<LoadedFile> beside;
  std::error_code error;
  if (fs::exists(nodes, error)) beside.emplace(nodes, input.context);
  return read_poly(input, simple, beside ? &beside->input() : nullptr);
}

}  // namespace octafront::io
