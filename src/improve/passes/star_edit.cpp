#include "improve/passes/star_edit.h"

#include "improve/passes/fewest_poor.h"

#include <algorithm>

namespace octafront::improve {

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

double StarEdit::current_deficit() const {
  double sum = 0;
  for (const HalfFace h : faces_) {
    const double lack = 1 - double{mesh_.shape(h / 4).beta};
    sum += lack * lack;
  }
  return sum;
}

double StarEdit::current_lack() const {
  double sum = 0;
  for (const HalfFace h : faces_) sum += lack_of(mesh_.shape(h / 4).score);
  return sum;
}

}  // namespace octafront::improve
