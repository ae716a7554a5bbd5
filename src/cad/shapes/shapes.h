#pragma once

#include "base/geometry/triangle_tree.h"
#include "base/geometry/true_geometry.h"
#include "cad/shapes/cad_places.h"
#include "cad/shapes/face_groups.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace octafront::cad {

/// A model asked for its true geometry. Patches are groups of faces, parts faces. Points come and go in a unit of so
/// many millimetres.
class Shapes final : public TrueGeometry {
 public:
  Shapes(CadModel model, FaceGroups groups, double millimetres = 1);

  const CadModel& model() const { return model_; }

  std::optional<Vec3> on_face(std::uint32_t patch, Vec3 p) const override;
  std::optional<Vec3> on_edge(std::span<const std::uint32_t> patches, Vec3 p) const override;
  bool is_vertex(Vec3 p) const override;
  const std::vector<std::string>& patch_names() const override { return patch_names_; }
  std::uint32_t part_at(std::uint32_t patch, Vec3 p) const override;
  const std::vector<std::string>& part_names() const override { return part_names_; }
  std::uint32_t patch_of_part(std::uint32_t part) const override { return group_of_[part]; }
  FoundShapes find(const std::string& place) const override { return CadPlaces(model_, millimetres_).find(place); }
  const std::vector<PartGroup>& groups() const override { return labelled_; }

 private:
  struct Group {
    std::vector<std::uint32_t> triangles;  ///< of the model, in the order of the tree's
    TriangleTree tree;
  };
  struct OnEdge {
    std::uint32_t edge = kNone, segment = 0;
    double part = 0;  ///< of the segment
    Vec3 p;
    double squared_distance = TriangleTree::kFar;
  };

  std::optional<Vec3> nearest_on_face(std::uint32_t patch, Vec3 p) const;
  std::optional<Vec3> nearest_on_edge(std::span<const std::uint32_t> patches, Vec3 p) const;
  void nearest_of(std::uint32_t edge, Vec3 p, OnEdge& best) const;
  bool joins(const CadEdge& edge, std::span<const std::uint32_t> patches) const;

  CadModel model_;
  double millimetres_;
  std::vector<std::uint32_t> group_of_;  ///< per face
  std::vector<Group> groups_;
  std::vector<std::vector<std::uint32_t>> edges_of_;  ///< per group: edges between it and others
  std::vector<Vec3> vertices_;                        ///< sorted, in the unit of points
  std::vector<std::string> part_names_, patch_names_;
  std::vector<PartGroup> labelled_;
};

}  // namespace octafront::cad
