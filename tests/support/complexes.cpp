#include "support/complexes.h"

#include "support/convex_cells.h"
#include "support/named_surfaces.h"
#include "support/random.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace octafront::testing {
namespace {

/// Collects triangles; vertices at the same place become one.
class Builder {
 public:
  VertexIndex vertex(Vec3 p) {
    const auto [at, is_new] = number_.try_emplace({p.x, p.y, p.z}, static_cast<VertexIndex>(mesh.points.size()));
    if (is_new) mesh.points.push_back(p);
    return at->second;
  }
  void triangle(Vec3 a, Vec3 b, Vec3 c, Sides sides, std::uint32_t patch = 0) {
    mesh.triangles.push_back({vertex(a), vertex(b), vertex(c)});
    mesh.sides.push_back(sides);
    mesh.patch.push_back(patch);
  }
  /// Counter-clockwise seen from the front.
  void quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Sides sides, std::uint32_t patch = 0) {
    triangle(a, b, c, sides, patch);
    triangle(a, c, d, sides, patch);
  }
  void surface(const SurfaceMesh& other, Sides sides, std::uint32_t patch = 0) {
    for (const auto& [a, b, c] : other.triangles)
      triangle(other.points[a], other.points[b], other.points[c], sides, patch);
  }
  /// A fan about `center`, counter-clockwise seen from the front.
  void fan(Vec3 center, const std::vector<Vec3>& ring, Sides sides, std::uint32_t patch = 0) {
    for (std::size_t i = 0; i < ring.size(); ++i) triangle(center, ring[i], ring[(i + 1) % ring.size()], sides, patch);
  }

  KnownComplex finished(std::string name, std::vector<std::string> regions, std::vector<std::string> patches = {}) {
    mesh.region_names = std::move(regions);
    mesh.patch_names = std::move(patches);
    KnownComplex known{std::move(name), std::move(mesh), {}};
    known.volumes = region_volumes(known.surface);
    return known;
  }

  SurfaceMesh mesh;

 private:
  std::map<std::array<double, 3>, VertexIndex> number_;
};

std::vector<Vec3> lifted(std::vector<Vec3> ring, double z) {
  for (Vec3& p : ring) p.z = z;
  return ring;
}
std::vector<Vec3> backwards(const std::vector<Vec3>& ring) {
  return {ring.rbegin(), ring.rend()};
}

/// A sum or difference of such numbers is exact.
double on_grid(double x) {
  return std::round(x * 0x1p30) * 0x1p-30;
}

/// Trapezoidal teeth around the origin, counter-clockwise; points 0 and 1 are the flank that rises last before the
/// angle 0.
std::vector<Vec3> gear_outline(int teeth) {
  constexpr double kRoot = 0.87, kTip = 1.07;
  const double pitch = 2 * std::numbers::pi / teeth;
  std::vector<Vec3> ring;
  const auto add = [&](double r, double angle) {
    ring.push_back({on_grid(r * std::cos(angle)), on_grid(r * std::sin(angle)), 0});
  };
  for (int k = 0; k < teeth; ++k) {
    // A tooth is a little thinner than a gap, so that only one flank touches.
    const double at = k * pitch;
    add(kTip, at - 0.12 * pitch);
    add(kRoot, at + 0.11 * pitch);
    add(kRoot, at + 0.49 * pitch);
    add(kTip, at + 0.72 * pitch);
  }
  return ring;
}

void add_gear(Builder& b, const std::vector<Vec3>& ring, Vec3 center, std::uint32_t region, bool with_contact) {
  constexpr double kHigh = 0.25;
  b.fan({center.x, center.y, kHigh}, lifted(ring, kHigh), {kNone, region});
  b.fan(center, backwards(ring), {kNone, region});
  for (std::size_t i = with_contact ? 0 : 1; i < ring.size(); ++i) {
    const Vec3 p = ring[i], q = ring[(i + 1) % ring.size()], up{0, 0, kHigh};
    const bool contact = i == 0;
    b.quad(p, q, q + up, p + up, {contact ? 1 : kNone, region}, contact);
  }
}

std::vector<Vec3> circle(int corners, double radius) {
  std::vector<Vec3> ring;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    ring.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  return ring;
}

/// The point of the square [-1, 1]^2 in the direction of p.
Vec3 on_square(Vec3 p) {
  const double far = std::max(std::abs(p.x), std::abs(p.y));
  const auto scaled = [&](double x) { return std::abs(x) > 0.999999 * far ? std::copysign(1.0, x) : x / far; };
  return {scaled(p.x), scaled(p.y), 0};
}

double prism_volume(const std::vector<Vec3>& ring, double height) {
  long double area = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec3 p = ring[i], q = ring[(i + 1) % ring.size()];
    area += (static_cast<long double>(p.x) * q.y - static_cast<long double>(p.y) * q.x) / 2;
  }
  return static_cast<double>(area * height);
}

SurfaceMesh without_sides(SurfaceMesh mesh) {
  mesh.sides.clear();
  mesh.patch.clear();
  return mesh;
}

}  // namespace

std::vector<double> region_volumes(const SurfaceMesh& complex) {
  std::vector<long double> six;
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const auto& [a, b, c] = complex.triangles[t];
    const Vec3 p = complex.points[a], q = complex.points[b], r = complex.points[c];
    const auto det = [](double x, double y, double z, double w) {
      return static_cast<long double>(x) * w - static_cast<long double>(y) * z;
    };
    const long double v = p.x * det(q.y, q.z, r.y, r.z) + p.y * det(q.z, q.x, r.z, r.x) + p.z * det(q.x, q.y, r.x, r.y);
    const auto [front, behind] = complex.sides_of(t);
    for (const std::uint32_t region : {front, behind})
      if (region != kNone && region >= six.size()) six.resize(region + 1, 0);
    if (behind != kNone) six[behind] += v;
    if (front != kNone) six[front] -= v;
  }
  std::vector<double> volumes;
  for (const long double v : six) volumes.push_back(static_cast<double>(v / 6));
  return volumes;
}

KnownComplex stacked_layers(const std::vector<double>& thickness) {
  Builder b;
  double z = 0;
  std::vector<std::string> names;
  for (std::uint32_t k = 0; k <= thickness.size(); ++k) {
    const bool last = k == thickness.size();
    b.quad({0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}, {last ? kNone : k, k == 0 ? kNone : k - 1}, k);
    if (last) break;
    const double top = z + thickness[k];
    const std::vector<Vec3> ring{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const std::vector<Vec3> low = lifted(ring, z), high = lifted(ring, top);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      b.quad(low[i], low[j], high[j], high[i], {kNone, k}, static_cast<std::uint32_t>(thickness.size()) + 1);
    }
    names.push_back("layer_" + std::to_string(k));
    z = top;
  }
  return b.finished("layers", names);
}

KnownComplex plane_cuts(int planes, std::uint64_t seed) {
  Random random(seed);
  ConvexCells cells({1, 1, 1});
  for (int i = 0; i < planes; ++i) {
    const double z = random.between(-1, 1), angle = random.between(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
    const Vec3 n{r * std::cos(angle), r * std::sin(angle), z};
    const Vec3 through{random.between(0.2, 0.8), random.between(0.2, 0.8), random.between(0.2, 0.8)};
    cells.cut(n, dot(n, through));
  }
  KnownComplex known{"planes_" + std::to_string(planes) + "_" + std::to_string(seed), cells.complex(), {}};
  known.volumes = region_volumes(known.surface);
  return known;
}

KnownComplex foam(int count, std::uint64_t seed) {
  Random random(seed);
  ConvexCells cells({1, 1, 1});
  for (int i = 0; i < count; ++i) {
    const double x = random.unit(), y = random.unit(), z = random.unit();
    cells.insert_site({x, y, z});
  }
  KnownComplex known{"foam_" + std::to_string(count) + "_" + std::to_string(seed), cells.complex(), {}};
  known.volumes = region_volumes(known.surface);
  return known;
}

KnownComplex packed_spheres(int n, std::uint64_t seed) {
  Random random(seed);
  Builder b;
  b.surface(box(n, n, n, 2 * n), {kNone, 0});
  std::vector<std::string> names{"matrix"};
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double radius = random.between(0.3, 0.45);
        const double slack = 0.48 - radius;
        const auto at = [&](int c) { return c + 0.5 + random.between(-slack, slack); };
        const double x = at(i), y = at(j), z = at(k);
        const auto region = static_cast<std::uint32_t>(names.size());
        b.surface(transformed(icosphere(2), radius, {x, y, z}), {0, region}, region);
        names.push_back("sphere_" + std::to_string(region));
      }
  return b.finished("spheres", names);
}

KnownComplex nested_shells(int shells) {
  Builder b;
  std::vector<std::string> names;
  for (int k = 0; k < shells; ++k) {
    const auto region = static_cast<std::uint32_t>(k);
    b.surface(icosphere(3, 1 - static_cast<double>(k) / shells), {k == 0 ? kNone : region - 1, region}, region);
    names.push_back("shell_" + std::to_string(k));
  }
  return b.finished("shells", names);
}

KnownComplex gear_pair(int teeth) {
  Builder b;
  const std::vector<Vec3> first = gear_outline(teeth);
  add_gear(b, first, {}, 0, true);
  // The other gear is this one turned half about the middle of the flank, whose ends change places.
  const Vec3 sum = first[0] + first[1];
  std::vector<Vec3> second;
  for (const Vec3 p : first) second.push_back({sum.x - p.x, sum.y - p.y, 0});
  add_gear(b, second, {sum.x, sum.y, 0}, 1, false);
  return b.finished("gears", {"driver", "driven"}, {"surface", "contact"});
}

KnownComplex cracked_plate() {
  Builder b;
  constexpr double kHigh = 0.25;
  const Vec3 tip{1, 0.5, 0}, mouth{1, 0, 0}, up{0, 0, kHigh};
  const std::vector<Vec3> ring{{0, 0, 0}, mouth, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  b.fan(tip + up, lifted(ring, kHigh), {kNone, 0});
  b.fan(tip, backwards(ring), {kNone, 0});
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec3 p = ring[i], q = ring[(i + 1) % ring.size()];
    b.quad(p, q, q + up, p + up, {kNone, 0});
  }
  b.quad(mouth, tip, tip + up, mouth + up, {0, 0}, 1);
  return b.finished("crack", {"plate"}, {"surface", "crack"});
}

KnownComplex buried_crack() {
  Builder b;
  b.surface(cube(2), {kNone, 0});
  b.quad({0.25, 0.25, 0.5}, {0.75, 0.25, 0.5}, {0.75, 0.75, 0.625}, {0.25, 0.75, 0.625}, {0, 0}, 1);
  return b.finished("buried_crack", {"cube"}, {"surface", "crack"});
}

KnownComplex insulated_wire(int turns, int steps_per_turn, int corners) {
  Builder b;
  const int steps = turns * steps_per_turn;
  const auto ring_at = [&](int step, double radius) {
    const double angle = 2 * std::numbers::pi * step / steps_per_turn, rise = 1.2;
    const Vec3 radial{std::cos(angle), std::sin(angle), 0};
    const Vec3 center = 2 * radial + Vec3{0, 0, rise * angle / (2 * std::numbers::pi)};
    const Vec3 along = normalized({-2 * std::sin(angle), 2 * std::cos(angle), rise / (2 * std::numbers::pi)});
    const Vec3 side = cross(along, radial);
    std::vector<Vec3> ring;
    for (int k = 0; k < corners; ++k) {
      const double turn = 2 * std::numbers::pi * k / corners;
      // Counter-clockwise seen against `along`, from where the wire goes.
      ring.push_back(center + radius * (std::cos(turn) * radial - std::sin(turn) * side));
    }
    return std::pair(center, ring);
  };
  constexpr double kWire = 0.2, kOuter = 0.4;
  const auto tube = [&](double radius, Sides sides, std::uint32_t patch) {
    for (int s = 0; s < steps; ++s) {
      const auto low = ring_at(s, radius).second, high = ring_at(s + 1, radius).second;
      for (std::size_t i = 0; i < low.size(); ++i) {
        const std::size_t j = (i + 1) % low.size();
        b.quad(low[i], high[i], high[j], low[j], sides, patch);
      }
    }
  };
  tube(kWire, {1, 0}, 1);
  tube(kOuter, {kNone, 1}, 0);
  for (const int end : {0, steps}) {
    const auto [center, wire] = ring_at(end, kWire);
    const auto outer = ring_at(end, kOuter).second;
    const bool forward = end == 0;
    b.fan(center, forward ? wire : backwards(wire), {kNone, 0}, 2);
    for (std::size_t i = 0; i < wire.size(); ++i) {
      const std::size_t j = (i + 1) % wire.size();
      if (forward) {
        b.quad(wire[i], outer[i], outer[j], wire[j], {kNone, 1}, 2);
      } else {
        b.quad(wire[j], outer[j], outer[i], wire[i], {kNone, 1}, 2);
      }
    }
  }
  return b.finished("wire", {"wire", "insulation"}, {"surface", "contact", "ends"});
}

KnownComplex touching_in_edge() {
  Builder b;
  b.surface(cube(1), {kNone, 0});
  b.surface(transformed(cube(1), 1, {1, 1, 0}), {kNone, 1}, 1);
  return b.finished("edge", {"first", "second"});
}

KnownComplex touching_in_point() {
  Builder b;
  b.surface(cube(1), {kNone, 0});
  b.surface(transformed(cube(1), 1, {1, 1, 1}), {kNone, 1}, 1);
  return b.finished("point", {"first", "second"});
}

std::vector<KnownComplex> known_complexes() {
  std::vector<KnownComplex> all;
  all.push_back(stacked_layers({1, 0.001, 0.5, 0.01, 0.001, 0.25}));
  all.push_back(plane_cuts(20, 1));
  all.push_back(foam(200, 1));
  all.push_back(packed_spheres(3, 1));
  all.push_back(nested_shells(5));
  all.push_back(gear_pair(16));
  all.push_back(cracked_plate());
  all.push_back(buried_crack());
  all.push_back(insulated_wire(3, 24, 12));
  all.push_back(touching_in_edge());
  all.push_back(touching_in_point());
  return all;
}

KnownParts bolt_in_hole(int corners, bool finer) {
  const double plate_high = 0.375, radius = 0.5;
  const std::vector<Vec3> hole = circle(corners, radius);
  Builder plate;
  for (std::size_t i = 0; i < hole.size(); ++i) {
    const std::size_t j = (i + 1) % hole.size();
    const Vec3 p = hole[i], q = hole[j], a = on_square(p), c = on_square(q), up{0, 0, plate_high};
    plate.quad(p + up, a + up, c + up, q + up, {});
    plate.quad(p, q, c, a, {});
    plate.quad(a, c, c + up, a + up, {});
    plate.quad(p, p + up, q + up, q, {});
  }
  Builder bolt;
  const std::vector<double> levels{-0.5, 0.1, 0.25, 0.7, 1};
  std::vector<Vec3> ring;
  for (std::size_t i = 0; i < hole.size(); ++i) {
    ring.push_back(hole[i]);
    if (finer) ring.push_back(0.4 * hole[i] + 0.6 * hole[(i + 1) % hole.size()]);
  }
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    const std::vector<Vec3> low = lifted(ring, levels[k]), high = lifted(ring, levels[k + 1]);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::size_t j = (i + 1) % ring.size();
      // The other diagonal than the plate has.
      bolt.quad(low[j], high[j], high[i], low[i], {});
    }
  }
  bolt.fan({0, 0, levels.back()}, lifted(ring, levels.back()), {});
  bolt.fan({0, 0, levels.front()}, backwards(lifted(ring, levels.front())), {});
  KnownParts known{finer ? "bolt_finer" : "bolt", {}, {"plate", "bolt"}, {}};
  known.parts = {without_sides(plate.mesh), without_sides(bolt.mesh)};
  known.volumes = {4 * plate_high - prism_volume(hole, plate_high), prism_volume(hole, levels.back() - levels.front())};
  return known;
}

KnownParts overlapping_boxes() {
  KnownParts known{"boxes", {}, {"first", "second"}, {}};
  known.parts = {box(2, 1, 1), transformed(box(1, 1, 1), 0.5, {0.25, 0.25, 0.625})};
  known.volumes = {2 - 0.25 * 0.375, 0.125};
  return known;
}

std::vector<KnownParts> known_parts() {
  return {bolt_in_hole(32, false), bolt_in_hole(32, true), overlapping_boxes()};
}

}  // namespace octafront::testing
