#include "surface/edits/line_edits.h"

#include <algorithm>

namespace octafront::surface {

LineEdits::LineEdits(WorkingMesh& mesh, const std::vector<std::uint8_t>& is_fixed) : mesh_(mesh), is_fixed_(is_fixed) {
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.is_removed(t)) continue;
    patch_size_.resize(std::max<std::size_t>(patch_size_.size(), mesh.patch[t] + std::size_t{1}));
    ++patch_size_[mesh.patch[t]];
  }
}

bool LineEdits::may_collapse(HalfEdge h) const {
  const VertexIndex u = mesh_.start[h], w = mesh_.end(h);
  if (must_stay(u)) return false;
  if (mesh_.kind[u] == VertexKind::kCorner && mesh_.kind[w] != VertexKind::kCorner) return false;
  if (mesh_.on_curve(u) && !mesh_.on_curve(w)) return false;
  return patches_remain(h) && mesh_.keeps_manifold(h);
}

bool LineEdits::patches_remain(HalfEdge h) const {
  const std::uint32_t p = mesh_.patch[h / 3], q = mesh_.patch[mesh_.twin[h] / 3];
  const std::uint32_t least = p == q ? 2 : 1;
  return patch_size_[p] > least && patch_size_[q] > least;
}

void LineEdits::collapse(HalfEdge h) {
  const VertexIndex w = mesh_.end(h), a = mesh_.apex(h), b = mesh_.apex(mesh_.twin[h]);
  --patch_size_[mesh_.patch[h / 3]];
  --patch_size_[mesh_.patch[mesh_.twin[h] / 3]];
  mesh_.collapse(h);
  for (const VertexIndex v : {w, a, b}) settle(v);
}

bool LineEdits::may_flip(HalfEdge h) const {
  const HalfEdge g = mesh_.twin[h];
  if (!mesh_.is_feature[h]) return mesh_.may_flip(h);
  if (must_stay(mesh_.start[h]) && must_stay(mesh_.end(h))) return false;
  if (mesh_.patch[h / 3] != mesh_.patch[g / 3] && patch_size_[mesh_.patch[h / 3]] < 2) return false;
  return mesh_.can_turn(h);
}

void LineEdits::flip(HalfEdge h) {
  if (!mesh_.is_feature[h]) {
    mesh_.flip(h);
    return;
  }
  const VertexIndex a = mesh_.start[h], b = mesh_.end(h), c = mesh_.apex(h);
  --patch_size_[mesh_.patch[h / 3]];
  mesh_.patch[h / 3] = mesh_.patch[mesh_.twin[h] / 3];
  ++patch_size_[mesh_.patch[h / 3]];
  mesh_.set_feature(h, false);
  for (const HalfEdge side : {next_of(h), previous_of(h)}) mesh_.set_feature(side, true);
  mesh_.flip(h);
  for (const VertexIndex v : {a, b, c}) settle(v);
}

/// What a vertex is after lines have moved there: where other than two meet it is a corner.
void LineEdits::settle(VertexIndex v) {
  int lines = 0;
  mesh_.for_each_outgoing(v, [&](HalfEdge h) { lines += mesh_.is_feature[h]; });
  if (lines == 0 || mesh_.kind[v] == VertexKind::kCorner) return;
  if (lines != 2) {
    mesh_.kind[v] = VertexKind::kCorner;
  } else if (mesh_.is_free(v)) {
    mesh_.kind[v] = VertexKind::kCurve;
    mesh_.place[v] = {};
  }
}

}  // namespace octafront::surface
