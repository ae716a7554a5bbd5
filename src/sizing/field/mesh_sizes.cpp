#include "sizing/field/mesh_sizes.h"

#include <octafront/tet_mesh.h>

#include "base/geometry/measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace octafront {

namespace {

/// Places beyond a face by no more than this part of the height of an element are in it, for rounding's sake.
constexpr double kRounding = 1e-9;

/// Weights of the corners at p; none for a tetrahedron without volume.
std::optional<std::array<double, 4>> weights_at(const std::array<Vec3, 4>& x, Vec3 p) {
  const double whole = six_volumes(x[0], x[1], x[2], x[3]);
  if (whole == 0) return std::nullopt;
  return std::array{six_volumes(p, x[1], x[2], x[3]) / whole, six_volumes(x[0], p, x[2], x[3]) / whole,
                    six_volumes(x[0], x[1], p, x[3]) / whole, six_volumes(x[0], x[1], x[2], p) / whole};
}

/// Faces of tetrahedra with their sorted corners, to find those that occur once.
struct SortedFace {
  Triangle key, face;
  std::uint32_t tet;
};

std::vector<SortedFace> sorted_faces(const SizeMesh& mesh) {
  std::vector<SortedFace> all;
  all.reserve(4 * mesh.tets.size());
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t)
    for (const auto& corners : kTetFaces) {
      const Triangle face{mesh.tets[t][static_cast<std::size_t>(corners[0])],
                          mesh.tets[t][static_cast<std::size_t>(corners[1])],
                          mesh.tets[t][static_cast<std::size_t>(corners[2])]};
      all.push_back({face_key(face), face, t});
    }
  std::sort(all.begin(), all.end(),
            [](const SortedFace& a, const SortedFace& b) { return std::tie(a.key, a.tet) < std::tie(b.key, b.tet); });
  return all;
}

}  // namespace

MeshSizes::MeshSizes(std::shared_ptr<const SizeMesh> mesh) : mesh_(std::move(mesh)) {
  const std::vector<double>& sizes = mesh_->point_sizes.empty() ? mesh_->element_sizes : mesh_->point_sizes;
  largest_ = *std::max_element(sizes.begin(), sizes.end());
  make_surface();
  build();
}

void MeshSizes::make_surface() {
  if (mesh_->tets.empty()) {
    faces_ = mesh_->triangles;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) element_of_face_.push_back(f);
  } else {
    const std::vector<SortedFace> all = sorted_faces(*mesh_);
    for (std::size_t i = 0; i < all.size();) {
      std::size_t end = i + 1;
      while (end < all.size() && all[end].key == all[i].key) ++end;
      if (end == i + 1) faces_.push_back(all[i].face), element_of_face_.push_back(all[i].tet);
      i = end;
    }
  }
  surface_.emplace(mesh_->points, faces_);
}

double MeshSizes::size_at_corner(std::uint32_t element, VertexIndex v) const {
  return mesh_->point_sizes.empty() ? mesh_->element_sizes[element] : mesh_->point_sizes[v];
}

MeshSizes::Bounds MeshSizes::bounds_of(std::uint32_t element) const {
  Bounds made;
  const auto add = [&](VertexIndex v) {
    made.box.add(mesh_->points[v]);
    made.least = std::min(made.least, size_at_corner(element, v));
  };
  if (mesh_->tets.empty())
    for (const VertexIndex v : mesh_->triangles[element]) add(v);
  else
    for (const VertexIndex v : mesh_->tets[element]) add(v);
  return made;
}

void MeshSizes::build() {
  std::vector<BoxTree<Bounds>::Item> items;
  for (std::uint32_t e = 0; e < elements(); ++e) items.push_back({bounds_of(e), e});
  tree_.emplace(std::move(items));
}

std::optional<MeshSizes::Place> MeshSizes::place_inside(Vec3 p) const {
  std::optional<Place> place;
  double best = -kRounding;
  tree_->for_each([&](const Bounds& bounds) { return bounds.box.contains(p); },
                  [&](const auto& item) {
                    const Tet& t = mesh_->tets[item.number];
                    const auto point = [&](std::size_t i) { return mesh_->points[t[i]]; };
                    const auto weights = weights_at({point(0), point(1), point(2), point(3)}, p);
                    if (!weights) return;
                    const double least = *std::min_element(weights->begin(), weights->end());
                    if (least <= best) return;
                    best = least;
                    place = Place{item.number, t, *weights};
                  });
  if (!place) return place;
  double sum = 0;
  for (double& weight : place->weights) sum += weight = std::max(0.0, weight);
  for (double& weight : place->weights) weight /= sum;
  return place;
}

MeshSizes::Place MeshSizes::place_on_triangle(std::uint32_t triangle, Vec3 p) const {
  const auto [i, j, k] = faces_[triangle];
  const Vec3 a = mesh_->points[i], b = mesh_->points[j], c = mesh_->points[k];
  const double u = triangle_area(p, b, c), v = triangle_area(a, p, c), w = triangle_area(a, b, p), sum = u + v + w;
  Place place{element_of_face_[triangle], {i, j, k, kNone}, {1, 0, 0, 0}};
  if (sum > 0) {
    place.weights = {u / sum, v / sum, w / sum, 0};
  } else {
    // Of a triangle without area its least size.
    const std::uint32_t e = place.element;
    const VertexIndex least =
        std::min({i, j, k}, [&](VertexIndex x, VertexIndex y) { return size_at_corner(e, x) < size_at_corner(e, y); });
    place.weights = {least == i ? 1.0 : 0.0, least == j && least != i ? 1.0 : 0.0,
                     least == k && least != i && least != j ? 1.0 : 0.0, 0};
  }
  return place;
}

double MeshSizes::size_of(const Place& place) const {
  double size = 0;
  for (std::size_t k = 0; k < 4; ++k)
    if (place.weights[k] > 0) size += place.weights[k] * size_at_corner(place.element, place.corners[k]);
  return size;
}

MeshSizes::Place MeshSizes::place(Vec3 p) const {
  if (!mesh_->tets.empty())
    if (const auto inside = place_inside(p)) return *inside;
  const TriangleTree::Nearest nearest = surface_->nearest(p);
  return place_on_triangle(nearest.triangle, nearest.point);
}

MeshSizes::Answer MeshSizes::at(Vec3 p) const {
  if (!mesh_->tets.empty())
    if (const auto inside = place_inside(p)) return {size_of(*inside), 0};
  const TriangleTree::Nearest nearest = surface_->nearest(p);
  return {size_of(place_on_triangle(nearest.triangle, nearest.point)), std::sqrt(nearest.squared_distance)};
}

double MeshSizes::least_in(const Box3& box) const {
  // The nearest points of all places of the box lie no farther from its middle than that of the middle, and twice half
  // the diagonal.
  const double around = at(box.center()).away + box.diagonal();
  const Vec3 out{around, around, around};
  const Box3 near{box.center() - out, box.center() + out};
  double least = std::numeric_limits<double>::infinity();
  tree_->for_each([&](const Bounds& bounds) { return bounds.least < least && bounds.box.overlaps(near); },
                  [&](const auto& item) { least = std::min(least, item.bounds.least); });
  return least;
}

}  // namespace octafront
