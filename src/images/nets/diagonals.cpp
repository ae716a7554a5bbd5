#include "base/core/parallel.h"
#include "images/nets/net_steps.h"

#include <algorithm>
#include <cmath>

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

}  // namespace octafront::nets
