#pragma once

#include <octafront/options.h>

#include "base/geometry/triangle_tree.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace octafront {

/// SizeMesh, asked at places. Const and safe on any number of threads. REQUIRES indices in range, finite points and
/// sizes above 0, and an element.
class MeshSizes {
 public:
  explicit MeshSizes(std::shared_ptr<const SizeMesh> mesh);

  struct Answer {
    double size = 0;
    double away = 0;  ///< distance to the mesh; 0 inside of it
  };
  /// Linear in the element that holds p, or that of the nearest point of the mesh.
  Answer at(Vec3 p) const;
  /// The same with the weights: those of the corners, none below 0, together 1. Of a triangle the last one is kNone.
  struct Place {
    std::uint32_t element;
    std::array<VertexIndex, 4> corners;
    std::array<double, 4> weights;
  };
  Place place(Vec3 p) const;
  /// No more than the size at any place of the box.
  double least_in(const Box3& box) const;
  double largest() const { return largest_; }
  Box3 box() const { return nodes_.front().box; }

 private:
  struct Node {
    Box3 box;
    double least;
    std::uint32_t first = 0;  // leaf: its first element; inner: its left child, then the right one
    std::uint32_t count = 0;  // elements of a leaf; 0: inner
  };
  struct Element {
    Box3 box;
    double least;
    std::uint32_t number;
  };

  void build();
  void divide(std::uint32_t node, std::uint32_t begin, std::uint32_t end);
  std::size_t elements() const { return mesh_->tets.empty() ? mesh_->triangles.size() : mesh_->tets.size(); }
  Element element(std::uint32_t number) const;
  double size_at_corner(std::uint32_t element, VertexIndex v) const;
  /// In the tetrahedron that holds p, if one does.
  std::optional<Place> place_inside(Vec3 p) const;
  Place place_on_triangle(std::uint32_t triangle, Vec3 p) const;
  double size_of(const Place& place) const;
  /// The triangles that bound it: those of the mesh, or faces of one tetrahedron, whose numbers are in tet_of_.
  void make_surface();

  std::shared_ptr<const SizeMesh> mesh_;
  std::vector<Node> nodes_;
  std::vector<Element> elements_;
  std::vector<Triangle> faces_;
  std::vector<std::uint32_t> element_of_face_;
  std::optional<TriangleTree> surface_;
  double largest_ = 0;
};

}  // namespace octafront
