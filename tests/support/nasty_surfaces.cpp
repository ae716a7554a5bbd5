#include "support/nasty_surfaces.h"

#include "base/geometry/predicates.h"
#include "base/geometry/self_intersection.h"
#include "support/named_surfaces.h"
#include "support/random.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace octafront::testing {

namespace {

// A sphere of rings and segments: needles at the poles.
SurfaceMesh globe(int rings, int segments) {
  SurfaceMesh s;
  constexpr double kPi = std::numbers::pi;
  s.points.push_back({0, 0, 1});
  for (int i = 1; i < rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      const double a = kPi * i / rings, b = 2 * kPi * j / segments;
      s.points.push_back({std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)});
    }
  }
  s.points.push_back({0, 0, -1});
  const auto last = static_cast<VertexIndex>(s.points.size() - 1);
  const auto at = [&](int ring, int j) { return static_cast<VertexIndex>(1 + (ring - 1) * segments + j % segments); };
  for (int j = 0; j < segments; ++j) {
    s.triangles.push_back({0, at(1, j), at(1, j + 1)});
    s.triangles.push_back({last, at(rings - 1, j + 1), at(rings - 1, j)});
    for (int i = 1; i + 1 < rings; ++i) {
      s.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      s.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return s;
}

// Each vertex goes to a random distance from the origin: star-shaped, so never self-intersecting.
SurfaceMesh spiky(SurfaceMesh s, double spread, Random& random) {
  for (Vec3& p : s.points) p *= random.magnitude(1 / spread, spread);
  return s;
}

// A slab over an n x n grid between two height fields.
SurfaceMesh slab(int n, double z, double thickness, double noise, Random& random) {
  SurfaceMesh s;
  const auto at = [n](int i, int j, int top) { return static_cast<VertexIndex>(2 * (i * (n + 1) + j) + top); };
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double base = z + noise * random.unit();
      s.points.push_back({double(i) / n, double(j) / n, base});
      s.points.push_back({double(i) / n, double(j) / n, base + thickness * random.between(0.5, 1)});
    }
  }
  const auto quad = [&](VertexIndex a, VertexIndex b, VertexIndex c, VertexIndex d) {
    s.triangles.push_back({a, b, c});
    s.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < n; ++i) {
    quad(at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1));
    quad(at(i + 1, n, 0), at(i, n, 0), at(i, n, 1), at(i + 1, n, 1));
    quad(at(0, i + 1, 0), at(0, i, 0), at(0, i, 1), at(0, i + 1, 1));
    quad(at(n, i, 0), at(n, i + 1, 0), at(n, i + 1, 1), at(n, i, 1));
    for (int j = 0; j < n; ++j) {
      quad(at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1));
      quad(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
    }
  }
  return s;
}

SurfaceMesh shells(int count, double gap, double spread, Random& random) {
  const SurfaceMesh shape = spiky(icosphere(random.integer(0, 1)), spread, random);
  SurfaceMesh all = shape;
  double scale = 1;
  for (int k = 1; k < count; ++k) {
    scale *= 1 - gap;
    const SurfaceMesh inner = transformed(shape, scale, {});
    all = joined(all, k % 2 ? reversed(inner) : inner);
  }
  return all;
}

SurfaceMesh plain_cube(int n) {
  SurfaceMesh s = cube(n);
  s.patch.clear();
  return s;
}

bool lies_inside(const SurfaceMesh& s, const Triangle& t, Vec3 p, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const auto turn = [&](Vec3 a, Vec3 b, Vec3 c) { return orient2d(a[u], a[v], b[u], b[v], c[u], c[v]); };
  const Vec3 a = s.points[t[0]], b = s.points[t[1]], c = s.points[t[2]];
  const int up = turn(a, b, c);
  return up != 0 && turn(a, b, p) == up && turn(b, c, p) == up && turn(c, a, p) == up;
}

// Random points in the sides of a cube, each joined with the corners of the triangle that it lies in: needles over
// needles in one plane.
SurfaceMesh divided_cube(int n, int divisions, Random& random) {
  SurfaceMesh s = plain_cube(n);
  while (divisions-- > 0) {
    const auto f = static_cast<std::size_t>(random.bits() % s.triangles.size());
    const Triangle t = s.triangles[f];
    const Vec3 a = s.points[t[0]], b = s.points[t[1]], c = s.points[t[2]];
    double x = random.unit(), y = random.unit();
    if (x + y > 1) x = 1 - x, y = 1 - y;
    Vec3 p = a + x * (b - a) + y * (c - a);
    int axis = 0;
    while (axis < 2 && !(a[axis] == b[axis] && a[axis] == c[axis])) ++axis;
    p[axis] = a[axis];
    if (!lies_inside(s, t, p, axis)) continue;
    const auto v = static_cast<VertexIndex>(s.points.size());
    s.points.push_back(p);
    s.triangles[f] = {t[0], t[1], v};
    s.triangles.push_back({t[1], t[2], v});
    s.triangles.push_back({t[2], t[0], v});
  }
  return s;
}

SurfaceMesh spiky_sphere(Random& random) {
  return spiky(icosphere(random.integer(0, 2)), random.magnitude(1.1, 100), random);
}

SurfaceMesh needles_at_the_poles(Random& random) {
  return spiky(globe(random.integer(2, 6), random.integer(3, 120)), random.magnitude(1.0001, 5), random);
}

SurfaceMesh flat_globe(Random& random) {
  SurfaceMesh s = spiky(globe(random.integer(2, 10), random.integer(3, 40)), random.magnitude(1, 1.5), random);
  for (Vec3& p : s.points) p.z *= 1e-3;
  return s;
}

SurfaceMesh near_coplanar_slab(Random& random) {
  return slab(random.integer(1, 10), 0, random.magnitude(1e-6, 1), random.magnitude(1e-12, 1e-3), random);
}

SurfaceMesh stacked_slabs(Random& random) {
  const double gap = random.magnitude(1e-6, 0.1);
  SurfaceMesh s = slab(random.integer(1, 6), 0, gap, gap / 10, random);
  for (int k = 1; k < 4; ++k) s = joined(s, slab(random.integer(1, 6), 2 * k * gap, gap, gap / 10, random));
  return s;
}

SurfaceMesh nested_shells(Random& random) {
  return shells(random.integer(2, 5), random.magnitude(1e-6, 0.3), random.magnitude(1.01, 4), random);
}

// A cavity that nearly touches the wall, with another body that nearly touches it from outside.
SurfaceMesh near_touching_boxes(Random& random) {
  const double gap = random.magnitude(1e-9, 1e-2);
  const int n = random.integer(1, 4), m = random.integer(1, 4);
  const SurfaceMesh hole = reversed(transformed(divided_cube(m, random.integer(0, 20), random), 0.5, {gap, 0.2, 0.3}));
  const SurfaceMesh s = joined(plain_cube(n), hole);
  return joined(s, transformed(plain_cube(m), random.between(0.3, 1.5), {1 + gap, 0, 0}));
}

SurfaceMesh twisted_tower(Random& random) {
  const int sides = random.integer(3, 24);
  const double twist = random.between(0, 170.0 / sides);
  return twisted_prism(sides, twist, random.magnitude(0.01, 100), random.integer(1, 5));
}

SurfaceMesh voxels(Random& random) {
  const int n = random.integer(2, 5);
  const double density = random.between(0.2, 0.8);
  return random_voxels(n, density, 0, Pinches::kFilled, random.bits());
}

SurfaceMesh jittered_voxels(Random& random) {
  const int n = random.integer(2, 5);
  const double density = random.between(0.2, 0.8), jitter = random.magnitude(1e-12, 0.1);
  return random_voxels(n, density, jitter, Pinches::kFilled, random.bits());
}

SurfaceMesh chazelle(Random& random) {
  const int notches = random.integer(1, 5);
  return chazelle_polyhedron(notches, random.magnitude(1e-5, 0.1));
}

SurfaceMesh coplanar_needles(Random& random) {
  const int n = random.integer(1, 3);
  return divided_cube(n, random.integer(1, 150), random);
}

// Grids with all points on a few planes and spheres.
SurfaceMesh coplanar_grid(Random& random) {
  SurfaceMesh s = plain_cube(random.integer(2, 9));
  for (std::size_t f = 0; f + 1 < s.triangles.size(); f += 2) {
    Triangle &a = s.triangles[f], &b = s.triangles[f + 1];  // two halves of one square
    if (random.unit() < 0.5 || a[0] != b[0] || a[2] != b[1]) continue;
    const Triangle first{a[0], a[1], b[2]};
    b = {a[1], a[2], b[2]};
    a = first;
  }
  return s;
}

struct Family {
  const char* name;
  SurfaceMesh (*make)(Random& random);
};
constexpr std::array<Family, 13> kFamilies{{{"spiky sphere", spiky_sphere},
                                            {"needles at the poles", needles_at_the_poles},
                                            {"flat globe", flat_globe},
                                            {"near-coplanar slab", near_coplanar_slab},
                                            {"stacked slabs", stacked_slabs},
                                            {"nested shells", nested_shells},
                                            {"near-touching boxes", near_touching_boxes},
                                            {"twisted tower", twisted_tower},
                                            {"voxels", voxels},
                                            {"jittered voxels", jittered_voxels},
                                            {"Chazelle", chazelle},
                                            {"coplanar needles", coplanar_needles},
                                            {"coplanar grid", coplanar_grid}}};

// Turned and moved far away, where coordinates round: what was coplanar is so no more. Left as it was if triangles meet
// afterwards.
void move_far(SurfaceMesh& surface, Random& random) {
  const double angle = random.between(0, 1), c = std::cos(angle), s = std::sin(angle);
  const Vec3 shift{random.magnitude(1, 1e5), -random.magnitude(1, 1e5), random.magnitude(1, 1e5)};
  SurfaceMesh moved = surface;
  for (Vec3& p : moved.points) {
    p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    p = Vec3{p.x, c * p.y - s * p.z, s * p.y + c * p.z} + shift;
  }
  if (self_intersections(moved.points, moved.triangles, 1).empty()) surface = std::move(moved);
}

}  // namespace

NastySurface nasty_surface(std::uint64_t seed) {
  Random random(seed);
  const Family& family = kFamilies[seed % kFamilies.size()];
  NastySurface n{std::string(family.name) + " of seed " + std::to_string(seed), family.make(random)};
  // Powers of two keep the shape exactly.
  if (random.unit() < 0.3) {
    for (int axis = 0; axis < 3; ++axis) {
      const double stretch = std::ldexp(1.0, random.integer(-5, 5));
      for (Vec3& p : n.surface.points) p[axis] *= stretch;
    }
  }
  if (random.unit() < 0.2) move_far(n.surface, random);
  n.surface = transformed(n.surface, std::ldexp(1.0, random.integer(-20, 20)), {});
  return n;
}

}  // namespace octafront::testing
