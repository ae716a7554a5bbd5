#include "fill/front/front.h"

#include "base/geometry/measures.h"

#include <algorithm>
#include <string>

namespace octafront {

namespace {
/// Cells of the index at level 0 in units of the smallest size; 2 to 2.4 is a flat optimum.
constexpr double kCellPerSize = 2.2;
}  // namespace

Front::Front(const Box3& domain, double finest_size) : domain_(domain), index_(domain, kCellPerSize * finest_size) {}

VertexIndex Front::add_vertex(Vec3 at, double size) {
  vertices_.push_back({at, static_cast<float>(size), 0});
  return static_cast<VertexIndex>(vertices_.size() - 1);
}

FaceIndex Front::add_face(const FrontFace& added) {
  FaceIndex face;
  if (free_.empty()) {
    face = static_cast<FaceIndex>(faces_.size());
    faces_.emplace_back();
  } else {
    face = free_.back();
    free_.pop_back();
  }
  faces_[face].face = added;
  Box3 box;
  for (const VertexIndex v : added.corners) box.add(vertices_[v].at);
  index_.insert(face, added.corners, box, added.region);
  return face;
}

void Front::remove_face(FaceIndex face) {
  index_.remove(face);
  ++faces_[face].generation;
  free_.push_back(face);
}

void Front::add_tet(const Triangle& face, VertexIndex apex) {
  tets_.push_back({face[0], face[1], face[2], apex});
  six_volumes_ += six_volumes(at(face[0]), at(face[1]), at(face[2]), at(apex));
}

std::optional<std::string> Front::first_inconsistency() const {
  if (index_.size() + free_.size() != faces_.size()) return "faces of the front are neither in its index nor free";
  for (const FaceIndex face : free_)
    if (index_.contains(face)) return "face " + std::to_string(face) + " is free and in the index";
  for (FaceIndex face = 0; face < faces_.size(); ++face) {
    const auto& [a, b, c] = faces_[face].face.corners;
    if (std::max({a, b, c}) >= vertices_.size()) return "face " + std::to_string(face) + " has no such corner";
    if (a == b || b == c || c == a) return "face " + std::to_string(face) + " has a corner twice";
  }
  return index_.first_inconsistency();
}

}  // namespace octafront
