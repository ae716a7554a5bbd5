#pragma once

// Triangles alone, as a mesh that is changed: any number of them may meet in an edge.

#include <octafront/surface_mesh.h>

#include "adapt/metric/metric.h"
#include "adapt/passes/piece.h"
#include "base/core/flat_map.h"
#include "base/geometry/triangle_intersection.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront::adapt {

/// A surface that is changed: triangles with the number of their part, lines, vertices with metrics. Triangles keep the
/// way they are turned.
class Sheet {
 public:
  struct Face {
    Triangle corners;
    std::uint32_t part;
  };

  Sheet(std::vector<Vertex> vertices, std::span<const Triangle> triangles, std::span<const std::uint32_t> part);

  std::vector<Vertex> vertices;
  LineEdges line_edges;

  std::uint32_t slots() const { return static_cast<std::uint32_t>(faces_.size()); }
  bool alive(std::uint32_t t) const { return faces_[t].corners[0] != kNone; }
  const Triangle& corners(std::uint32_t t) const { return faces_[t].corners; }
  std::uint32_t part(std::uint32_t t) const { return faces_[t].part; }
  const std::vector<std::uint32_t>& star(VertexIndex v) const { return star_[v]; }
  Vec3 point(VertexIndex v) const { return vertices[v].at; }
  TriangleCorners places(const Triangle& t) const { return {point(t[0]), point(t[1]), point(t[2])}; }

  /// The triangles that have both.
  std::vector<std::uint32_t> around(VertexIndex a, VertexIndex b) const;
  /// All vertices that share a triangle with v, ascending.
  std::vector<VertexIndex> neighbours(VertexIndex v) const;
  static VertexIndex apex(const Triangle& t, VertexIndex a, VertexIndex b) {
    for (const VertexIndex v : t)
      if (v != a && v != b) return v;
    return kNone;
  }

  const std::uint32_t* line(VertexIndex a, VertexIndex b) const { return line_edges.find(a, b); }

  double edge_length(VertexIndex a, VertexIndex b) const { return length_between(vertices[a], vertices[b]); }
  static double length_between(const Vertex& a, const Vertex& b) {
    return metric_length(b.at - a.at, a.metric, b.metric);
  }
  /// Area over the sum of squared edges, both in the metric of the corner of greatest density: 1 for a triangle that is
  /// regular there, 0 for a flat one.
  double score(const Triangle& t) const { return score_of({&vertices[t[0]], &vertices[t[1]], &vertices[t[2]]}); }
  static double score_of(const std::array<const Vertex*, 3>& corners);

  /// Something around the vertex changed.
  void touch(VertexIndex v) { vertices[v].active = vertices[v].touched = true; }
  VertexIndex add(const Vertex& v);
  /// Puts triangles in the place of others.
  void replace(std::span<const std::uint32_t> old, std::span<const Face> fresh);

  /// What is wrong with stars and lines (base/core/validate.h).
  std::optional<std::string> first_inconsistency() const;

 private:
  std::vector<Face> faces_;
  std::vector<std::uint32_t> free_;
  std::vector<std::vector<std::uint32_t>> star_;
};

}  // namespace octafront::adapt
