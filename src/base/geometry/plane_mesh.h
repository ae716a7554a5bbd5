#pragma once

#include <octafront/ids.h>

#include "base/core/random.h"
#include "base/geometry/exact_point.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace octafront::arrangement {

/// What the meshes of all planes may spend on points where segments cross, together.
class CrossingBudget {
 public:
  explicit CrossingBudget(std::size_t most) : most_(most) {}
  /// Takes one; throws InputError if there is none left.
  void take();

 private:
  const std::size_t most_;
  std::atomic<std::size_t> taken_ = 0;
};

/// A constrained triangulation in a plane, grown point by point and segment by segment; segments that cross get a
/// vertex where they do. All decisions are exact; flips towards Delaunay triangles are a choice of quality.
class PlaneMesh {
 public:
  using Node = std::uint32_t;
  /// Faces of the input whose border an edge is part of, ascending; crossing it leads in or out of them.
  using Border = std::vector<std::uint32_t>;

  /// For points of the plane within the box; `axis` is the one along which they are seen, not parallel to the plane.
  /// Crossings are taken from the budget, if there is one, which must outlive the mesh.
  PlaneMesh(const Homogeneous& plane, int axis, const Box3& box, CrossingBudget* budget = nullptr);
  PlaneMesh(const PlaneMesh&) = delete;
  PlaneMesh& operator=(const PlaneMesh&) = delete;

  /// The vertex at a place; a new one unless there is one. What `exact` points to must outlive the mesh.
  Node add_point(const Place& p);
  /// The segment between two vertices, on a plane that cuts this one there; `face` is one that it borders, or kNone.
  void add_segment(Node a, Node b, const Homogeneous& cut, std::uint32_t face = kNone);
  /// Flips edges of no segment until nearly all triangles are Delaunay.
  void improve();

  std::size_t nodes() const { return place_.size(); }
  const Place& place(Node n) const { return place_[n]; }
  /// Points where segments cross, in the order in which they came: those of nodes that were never added.
  const std::deque<ExactPoint>& crossings() const { return crossings_; }
  Node first_crossing_node(std::size_t i) const { return crossing_nodes_[i]; }

  struct Piece {
    std::array<Node, 3> corners;  ///< counter-clockwise seen along the axis
    Border faces;                 ///< that cover it
  };
  /// The triangles that some face covers.
  std::vector<Piece> pieces() const;

 private:
  struct Triangle3 {
    std::array<Node, 3> v;
    std::array<std::uint32_t, 3> next;  ///< across the edge opposite corner i; kNone at the rim
    std::array<std::uint32_t, 3> mark;  ///< the segments along that edge; kNone without
  };
  struct Mark {
    std::uint32_t cut;
    Border border;
  };
  /// Edge of a triangle, by the corner opposite to it.
  struct Side {
    std::uint32_t triangle;
    int corner;
  };

  int orient(Node a, Node b, Node c) const { return orient_along(axis_, place_[a], place_[b], place_[c]); }
  Node new_node(const Place& p);
  Side locate(const Place& p, int& zeros);
  int corner_of(std::uint32_t t, Node n) const;
  int corner_facing(std::uint32_t t, std::uint32_t neighbour) const;
  void relink(std::uint32_t t, std::uint32_t from, std::uint32_t to);
  void split_triangle(std::uint32_t t, Node x);
  void split_edge(Side side, Node x);
  void flip(Side side);
  bool is_convex(Side side) const;
  bool is_bad(Side side) const;
  void legalize(Node x);
  Side toward(Node a, Node b) const;
  Side find_edge(Node a, Node b) const;
  Node clear_way(Node a, Node b, std::uint32_t cut);
  void flip_in(Node a, Node b, std::vector<std::array<Node, 2>> crossed);
  void mark(Side side, std::uint32_t cut, std::uint32_t face);

  Homogeneous plane_;
  int axis_;
  std::vector<Place> place_;
  std::vector<std::uint32_t> triangle_at_;
  std::vector<Triangle3> triangles_;
  std::vector<Mark> marks_;
  std::vector<Homogeneous> cuts_;
  CrossingBudget* budget_;
  std::deque<ExactPoint> crossings_;
  std::vector<Node> crossing_nodes_;
  std::uint32_t last_ = 0;
  Random random_{1};
};

}  // namespace octafront::arrangement
