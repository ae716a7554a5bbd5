#pragma once

#include <octafront/options.h>

#include "base/geometry/box_tree.h"
#include "base/geometry/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
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
  Box3 box() const { return tree_->bounds().box; }

 private:
  struct Bounds {
    Box3 box{};
    double least = std::numeric_limits<double>::infinity();  ///< size

    void add(const Bounds& other) { box.add(other.box), least = std::min(least, other.least); }
  };

  void build();
  std::size_t elements() const { return mesh_->tets.empty() ? mesh_->triangles.size() : mesh_->tets.size(); }
  Bounds bounds_of(std::uint32_t element) const;
  double size_at_corner(std::uint32_t element, VertexIndex v) const;
  /// In the tetrahedron that holds p, if one does.
  std::optional<Place> place_inside(Vec3 p) const;
  Place place_on_triangle(std::uint32_t triangle, Vec3 p) const;
  double size_of(const Place& place) const;
  /// The triangles that bound it: those of the mesh, or faces of one tetrahedron, whose numbers are in tet_of_.
  void make_surface();

  std::shared_ptr<const SizeMesh> mesh_;
  std::optional<BoxTree<Bounds>> tree_;  ///< of the elements
  std::vector<Triangle> faces_;
  std::vector<std::uint32_t> element_of_face_;
  std::optional<TriangleTree> surface_;
  double largest_ = 0;
};

}  // namespace octafront
