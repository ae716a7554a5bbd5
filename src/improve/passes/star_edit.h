#pragma once

// The star of a vertex made ready for trying other places for it.

#include "improve/shape/edit_mesh.h"

#include <span>

namespace octafront::improve {

/// Loads a vertex's star once, evaluates it for any place of the vertex, and commits the last place evaluated.
class StarEdit {
 public:
  explicit StarEdit(EditMesh& mesh) : mesh_(mesh), batch_(mesh.objective()) {}

  /// `faces`: the star, which must outlive its use. False if it is too large to be worth it (over ShapeBatch::kBatch
  /// elements).
  bool load(VertexIndex v, std::span<const HalfFace> faces);
  std::span<const HalfFace> faces() const { return faces_; }
  /// Worst score of the star as it stands in the mesh.
  float current_worst() const;
  /// Sum of (1 - beta)^2 of the star as it stands in the mesh.
  double current_deficit() const;
  /// Sum of what its elements lack (fewest_poor.h) as it stands in the mesh.
  double current_lack() const;

  void evaluate(Vec3 at) {
    at_ = at;
    batch_.evaluate_star(at);
  }
  ShapeBatch& batch() { return batch_; }
  const ShapeBatch& batch() const { return batch_; }
  float worst_score() const { return static_cast<float>(batch_.worst()); }
  /// True if all elements, as evaluated, are strictly above the floor, and positive with the vertex at `at`.
  bool acceptable(Vec3 at, const Floor& floor) const { return batch_.star_acceptable(at, floor); }
  bool acceptable(const Floor& floor) const { return batch_.star_acceptable(at_, floor); }
  void commit() { mesh_.move(vertex_, at_, faces_, batch_); }

 private:
  EditMesh& mesh_;
  VertexIndex vertex_ = kNone;
  Vec3 at_;
  std::span<const HalfFace> faces_;
  ShapeBatch batch_;
};

}  // namespace octafront::improve
