#include "base/core/parallel.h"
#include "base/core/wording.h"
#include "images/nets/net_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace octafront::nets {
namespace {

/// The cosine of the smallest angle; 1 where a side has no length.
double cosine_of_least_angle(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = b - a, v = c - b, w = a - c;
  const double uu = squared_length(u), vv = squared_length(v), ww = squared_length(w);
  if (uu == 0 || vv == 0 || ww == 0) return 1;
  return std::max({-dot(u, w) / std::sqrt(uu * ww), -dot(u, v) / std::sqrt(uu * vv), -dot(v, w) / std::sqrt(vv * ww)});
}

struct Judged {
  bool keeps_apart = true;
  double cosine = -1;
};

Judged judge(const Quad& q, std::span<const Vec3> x, Vec3 below, Vec3 above) {
  Judged judged;
  for (const Triangle& t : triangles_of(q)) {
    const Vec3 a = x[t[0]], b = x[t[1]], c = x[t[2]];
    const Vec3 normal = cross(b - a, c - a);
    // A matter of taste, not of validity: no exact sign is wanted.
    judged.keeps_apart = judged.keeps_apart && dot(above - a, normal) > 0 && dot(below - a, normal) < 0;
    judged.cosine = std::max(judged.cosine, cosine_of_least_angle(a, b, c));
  }
  return judged;
}

}  // namespace

void choose_diagonal(Net& net, const Lattice& lattice, std::span<const Vec3> x, std::uint32_t quad) {
  Quad& q = net.quads[quad];
  const Corner voxel = net.corner[q.v[0]];
  Corner lower = voxel;
  --lower[q.axis];
  const Vec3 below = lattice.middle_of(lower), above = lattice.middle_of(voxel);
  q.turned = false;
  const Judged plain = judge(q, x, below, above);
  q.turned = true;
  const Judged turned = judge(q, x, below, above);
  if (plain.keeps_apart != turned.keeps_apart)
    q.turned = turned.keeps_apart;
  else
    q.turned = turned.cosine < plain.cosine;
}

void choose_diagonals(Net& net, const Lattice& lattice, std::span<const Vec3> x) {
  parallel_for(net.quads.size(),
               [&](std::size_t q) { choose_diagonal(net, lattice, x, static_cast<std::uint32_t>(q)); });
}

namespace {

/// Gives what is used numbers from 0 on, in order; kNone to the rest.
std::vector<std::uint32_t> numbered(const std::vector<std::uint8_t>& used) {
  std::vector<std::uint32_t> number(used.size(), kNone);
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i]) number[i] = next++;
  return number;
}

void note_what_was_done(const ResolvedNet& resolved, Complex& complex) {
  if (resolved.moved_back > 0)
    complex.notes.push_back(
        fmt::format("{} moved back toward the corners of voxels, where surfaces would have crossed or met in "
                    "sharp wedges",
                    counted(resolved.moved_back, "vertex", "vertices")));
  if (resolved.joined > 0)
    complex.notes.push_back(fmt::format("regions touch themselves or each other in {} where surfaces found no room",
                                        counted(resolved.joined, "point")));
}

}  // namespace

Complex assemble(const Net& net, const Lattice& lattice, ResolvedNet resolved, std::span<const Vec3> straight,
                 const std::vector<LabelImage::Label>& labels, bool keeps_values) {
  std::vector<std::uint8_t> used_vertex(net.corner.size(), 0), used_label(labels.size(), 0);
  for (const Quad& q : net.quads) {
    for (const VertexIndex v : q.v) used_vertex[v] = 1;
    for (const Label l : {q.lower, q.upper})
      if (l != LabelImage::kNoRegion) used_label[l] = 1;
  }
  const std::vector<std::uint32_t> vertex = numbered(used_vertex), region_of = numbered(used_label);
  const auto region = [&](Label l) { return l == LabelImage::kNoRegion ? kNone : region_of[l]; };
  Complex complex;
  SurfaceMesh& surface = complex.surface;
  const std::vector<double> volumes = volumes_of(net, straight, labels.size());
  for (std::size_t l = 0; l < labels.size(); ++l) {
    if (!used_label[l]) continue;
    surface.region_names.push_back(labels[l].name);
    if (keeps_values) surface.region_labels.push_back(labels[l].value);
    complex.volumes.push_back(volumes[l] * lattice.volume_scale());
  }
  for (std::size_t v = 0; v < resolved.world.size(); ++v)
    if (used_vertex[v]) surface.points.push_back(resolved.world[v]);
  surface.triangles.resize(2 * net.quads.size());
  surface.sides.resize(2 * net.quads.size());
  const bool mirrored = lattice.is_mirrored();
  parallel_for(net.quads.size(), [&](std::size_t q) {
    const Quad& quad = net.quads[q];
    Sides sides{region(quad.upper), region(quad.lower)};
    // The outside, or else the region of the higher number, comes to lie in front.
    const bool turn = sides[0] < sides[1];
    if (turn) std::swap(sides[0], sides[1]);
    const auto triangles = triangles_of(quad);
    for (int i = 0; i < 2; ++i) {
      Triangle t = triangles[i];
      if (turn != mirrored) std::swap(t[1], t[2]);
      for (VertexIndex& v : t) v = vertex[v];
      surface.triangles[2 * q + i] = t;
      surface.sides[2 * q + i] = sides;
    }
  });
  note_what_was_done(resolved, complex);
  return complex;
}

}  // namespace octafront::nets
