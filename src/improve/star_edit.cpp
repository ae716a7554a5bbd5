#include "improve/star_edit.h"

#include "geometry/predicates.h"

namespace octafront::improve {

bool StarEdit::load(VertexIndex v) {
  mesh_.star(v, walked_);
  return load(v, walked_);
}

bool StarEdit::load(VertexIndex v, std::span<const HalfFace> faces) {
  vertex_ = v;
  faces_ = faces;
  batch_.size = 0;
  if (faces_.size() > ShapeBatch::kBatch) return false;
  for (const HalfFace h : faces_) {
    const Tet& t = mesh_.tet(h / 4);
    const auto& f = kTetFaces[h % 4];
    batch_.add(mesh_.point(t[f[0]]), mesh_.point(t[f[1]]), mesh_.point(t[f[2]]));
  }
  return true;
}

float StarEdit::current_worst() const {
  float worst = 1;
  for (const HalfFace h : faces_) worst = std::min(worst, mesh_.shape(h / 4).score);
  return worst;
}

float StarEdit::worst_score() const {
  double worst = 1;
  for (int i = 0; i < batch_.size; ++i) worst = batch_.quality[i] < worst ? batch_.quality[i] : worst;
  return static_cast<float>(worst);
}

bool StarEdit::acceptable(const Floor& floor) const {
  for (int i = 0; i < batch_.size; ++i) {
    const Shape s = batch_.shape(i);
    if (!floor.below(s)) return false;
    if (s.beta >= kCertainBeta) continue;
    const Vec3 b{batch_.corner[1][0][i], batch_.corner[1][1][i], batch_.corner[1][2][i]};
    const Vec3 c{batch_.corner[2][0][i], batch_.corner[2][1][i], batch_.corner[2][2][i]};
    const Vec3 d{batch_.corner[3][0][i], batch_.corner[3][1][i], batch_.corner[3][2][i]};
    if (orient3d(at_, b, c, d) <= 0) return false;
  }
  return true;
}

}  // namespace octafront::improve
