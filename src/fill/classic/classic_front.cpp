#include "fill/classic/classic_front.h"

#include "base/core/validate.h"
#include "base/geometry/measures.h"

#include <algorithm>
#include <cmath>

namespace octafront {

namespace {

std::array<double, 3> tree_key_of(Vec3 p) {
  return {p.x, p.y, p.z};
}
}  // namespace

ClassicFront::ClassicFront(const Box3& domain)
    : domain_(domain), vertex_tree_(tree_key_of(domain.lo), tree_key_of(domain.hi)) {}

ClassicFront::FaceTree& ClassicFront::tree_for(double extent) {
  const int power = std::ilogb(extent);
  for (FaceTree& t : face_trees_)
    if (t.power == power) return t;
  return face_trees_.emplace_back(
      FaceTree{power, AlternatingTree<3>(tree_key_of(domain_.lo), tree_key_of(domain_.hi))});
}

VertexIndex ClassicFront::add_vertex(Vec3 at) {
  points_.push_back(at);
  faces_at_.push_back(0);
  return static_cast<VertexIndex>(points_.size() - 1);
}

ClassicFront::Face ClassicFront::add_face(const Triangle& corners) {
  const auto face = static_cast<Face>(faces_.size());
  faces_.push_back(corners);
  alive_.push_back(1);
  Box3 box;
  for (const VertexIndex v : corners) {
    box.add(points_[v]);
    if (faces_at_[v]++ == 0) vertex_tree_.insert(v, tree_key_of(points_[v]));
  }
  const Vec3 e = box.extent();
  FaceTree& tree = tree_for(std::max({e.x, e.y, e.z}));
  tree_of_face_.push_back(static_cast<std::uint8_t>(&tree - face_trees_.data()));
  tree.tree.insert(face, tree_key_of(box.center()));
  validate(*this, face);
  return face;
}

void ClassicFront::remove_face(Face face) {
  alive_[face] = 0;
  face_trees_[tree_of_face_[face]].tree.remove(face);
  for (const VertexIndex v : faces_[face])
    if (--faces_at_[v] == 0) vertex_tree_.remove(v);
  validate(*this, face);
}

void ClassicFront::add_tet(const Triangle& face, VertexIndex apex) {
  tets_.push_back({face[0], face[1], face[2], apex});
  six_volumes_ += six_volumes(at(face[0]), at(face[1]), at(face[2]), at(apex));
}

double ClassicFront::size_of(Face face) const {
  const auto& [a, b, c] = faces_[face];
  return triangle_area(at(a), at(b), at(c));
}

void ClassicFront::faces_near(const Box3& box, std::vector<Face>& out) const {
  for (const FaceTree& t : face_trees_) {
    // A little more than half of the largest extent in the tree, for the middle is rounded.
    const double reach = 1.0001 * std::ldexp(1.0, t.power);
    const Vec3 more{reach, reach, reach};
    t.tree.find({tree_key_of(box.lo - more), tree_key_of(box.hi + more)}, [&](Face f) {
      Box3 b;
      for (const VertexIndex v : faces_[f]) b.add(points_[v]);
      if (b.overlaps(box)) out.push_back(f);
    });
  }
}

void ClassicFront::vertices_near(const Box3& box, std::vector<VertexIndex>& out) const {
  vertex_tree_.find({tree_key_of(box.lo), tree_key_of(box.hi)}, [&](VertexIndex v) { out.push_back(v); });
}

std::optional<std::string> ClassicFront::first_inconsistency(Face face) const {
  const auto& [a, b, c] = faces_[face];
  const std::string name = "face " + std::to_string(face);
  if (std::max({a, b, c}) >= points_.size()) return name + " has no such corner";
  if (a == b || b == c || c == a) return name + " has a corner twice";
  if (face_trees_[tree_of_face_[face]].tree.contains(face) != alive(face))
    return name + (alive(face) ? " is on the front, and not in its tree" : " is in its tree, and not on the front");
  for (const VertexIndex v : faces_[face])
    if (vertex_tree_.contains(v) != (faces_at_[v] > 0))
      return "vertex " + std::to_string(v) + " is in the tree of vertices, and on no face, or the other way round";
  return std::nullopt;
}

std::optional<std::string> ClassicFront::first_inconsistency() const {
  std::vector<std::uint32_t> faces_at(points_.size(), 0);
  std::size_t left = 0;
  for (Face f = 0; f < faces_.size(); ++f) {
    if (auto wrong = first_inconsistency(f)) return wrong;
    left += alive(f);
    for (const VertexIndex v : faces_[f]) faces_at[v] += alive(f);
  }
  if (faces_at != faces_at_) return "the vertices have not as many faces as they say";
  for (const FaceTree& t : face_trees_) {
    if (auto wrong = t.tree.first_inconsistency()) return "the tree of faces: " + *wrong;
    left -= t.tree.size();
  }
  if (left != 0) return "the trees of faces have not as many as the front";
  if (auto wrong = vertex_tree_.first_inconsistency()) return "the tree of vertices: " + *wrong;
  return std::nullopt;
}

}  // namespace octafront
