#include "cad/shapes/shapes.h"

#include "base/core/parallel.h"
#include "cad/shapes/names.h"
#include "cad/shapes/nearest_on.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

namespace octafront::cad {

namespace {

bool before(Vec3 a, Vec3 b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// Barycentric coordinates of a point in the plane of a triangle; a flat one is its first corner.
std::array<double, 3> weights_of(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = b - a, v = c - a, w = p - a;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = uu * vv - uv * uv;
  if (!(det > 0)) return {1, 0, 0};
  const double s = (dot(w, u) * vv - dot(w, v) * uv) / det, t = (dot(w, v) * uu - dot(w, u) * uv) / det;
  return {1 - s - t, s, t};
}

}  // namespace

Shapes::Shapes(CadModel model, FaceGroups groups, double millimetres)
    : model_(std::move(model)),
      millimetres_(millimetres),
      group_of_(std::move(groups.group_of)),
      part_names_(face_names(model_)),
      patch_names_(std::move(groups.names)) {
  const std::size_t count = patch_names_.size();
  std::vector<std::vector<std::uint32_t>> triangles(count);
  for (std::uint32_t t = 0; t < model_.triangles.size(); ++t) triangles[group_of_[model_.face_of[t]]].push_back(t);
  std::vector<std::optional<Group>> made(count);
  parallel_for(count, [&](std::size_t g) {
    std::vector<Triangle> own;
    for (const std::uint32_t t : triangles[g]) own.push_back(model_.triangles[t]);
    made[g].emplace(Group{std::move(triangles[g]), TriangleTree(model_.points, own)});
  });
  for (std::optional<Group>& group : made) groups_.push_back(std::move(*group));
  edges_of_.resize(count);
  for (std::uint32_t e = 0; e < model_.edges.size(); ++e) {
    std::set<std::uint32_t> of;
    for (const std::uint32_t f : model_.edges[e].faces)
      if (group_of_[f] != kNone) of.insert(group_of_[f]);
    if (of.size() > 1)
      for (const std::uint32_t g : of) edges_of_[g].push_back(e);
  }
  for (const VertexIndex v : model_.vertices) vertices_.push_back(model_.points[v] / millimetres_);
  std::sort(vertices_.begin(), vertices_.end(), before);
  const std::vector<std::string> solids = solid_names(model_);
  for (LabelGroup& label : label_groups(model_)) {
    PartGroup& group = labelled_.emplace_back(PartGroup{std::move(label.name), std::move(label.faces), {}});
    for (const std::uint32_t s : label.solids) group.regions.push_back(solids[s]);
  }
}

std::optional<Vec3> Shapes::on_face(std::uint32_t patch, Vec3 p) const {
  const std::optional<Vec3> found = nearest_on_face(patch, millimetres_ * p);
  return found ? std::optional(*found / millimetres_) : std::nullopt;
}

std::optional<Vec3> Shapes::on_edge(std::span<const std::uint32_t> patches, Vec3 p) const {
  const std::optional<Vec3> found = nearest_on_edge(patches, millimetres_ * p);
  return found ? std::optional(*found / millimetres_) : std::nullopt;
}

std::optional<Vec3> Shapes::nearest_on_face(std::uint32_t patch, Vec3 p) const {
  if (patch >= groups_.size()) return std::nullopt;
  const Group& group = groups_[patch];
  const TriangleTree::Nearest found = group.tree.nearest(p);
  if (found.triangle == kNone) return std::nullopt;
  const std::uint32_t t = group.triangles[found.triangle];
  const auto& [a, b, c] = model_.triangles[t];
  const auto w = weights_of(found.point, model_.points[a], model_.points[b], model_.points[c]);
  SurfaceSeed seed{{}, found.point};
  for (std::size_t k = 0; k < 3; ++k)
    seed.at.u += w[k] * model_.corners[t][k].u, seed.at.v += w[k] * model_.corners[t][k].v;
  return nearest_on(model_.faces[model_.face_of[t]].surface, seed, p);
}

std::uint32_t Shapes::part_at(std::uint32_t patch, Vec3 p) const {
  if (patch >= groups_.size()) return kNone;
  const Group& group = groups_[patch];
  const TriangleTree::Nearest found = group.tree.nearest(millimetres_ * p);
  return found.triangle == kNone ? kNone : model_.face_of[group.triangles[found.triangle]];
}

bool Shapes::is_vertex(Vec3 p) const {
  return std::binary_search(vertices_.begin(), vertices_.end(), p, before);
}

bool Shapes::joins(const CadEdge& edge, std::span<const std::uint32_t> patches) const {
  std::uint32_t first = kNone;
  for (const std::uint32_t f : edge.faces) {
    const std::uint32_t g = group_of_[f];
    if (g == kNone || std::find(patches.begin(), patches.end(), g) == patches.end()) continue;
    if (first != kNone && g != first) return true;
    first = g;
  }
  return false;
}

void Shapes::nearest_of(std::uint32_t edge, Vec3 p, OnEdge& best) const {
  const std::vector<VertexIndex>& along = model_.edges[edge].vertices;
  for (std::uint32_t k = 0; k + 1 < along.size(); ++k) {
    const Vec3 a = model_.points[along[k]], d = model_.points[along[k + 1]] - a;
    const double l = dot(d, d), t = l > 0 ? std::clamp(dot(p - a, d) / l, 0.0, 1.0) : 0;
    const Vec3 q = a + t * d;
    if (const double s = squared_length(q - p); s < best.squared_distance) best = {edge, k, t, q, s};
  }
}

std::optional<Vec3> Shapes::nearest_on_edge(std::span<const std::uint32_t> patches, Vec3 p) const {
  OnEdge best;
  for (const std::uint32_t g : patches) {
    if (g >= groups_.size()) continue;
    for (const std::uint32_t e : edges_of_[g])
      if (joins(model_.edges[e], patches)) nearest_of(e, p, best);
  }
  if (best.edge == kNone) return std::nullopt;
  const CadEdge& edge = model_.edges[best.edge];
  const double t = edge.parameters[best.segment];
  const CurveSeed seed{t + best.part * (edge.parameters[best.segment + 1] - t), best.p};
  return nearest_on(edge.curve, seed, p);
}

}  // namespace octafront::cad
