#include "sizing/sources/curvature.h"

#include <octafront/surface_mesh.h>

#include "base/core/elementary.h"
#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "sizing/field/octree.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace octafront {

namespace {

/// Radius of the ball in mean edges: smaller ones follow the noise of scans, larger ones dilute narrow fillets.
constexpr double kBallRadius = 3;
/// A ball answers for the triangles within this part of its radius.
constexpr double kAnsweredPart = 0.7;
/// Balls are laid in blocks of this many triangles, next to each other along the octree's curve: in the same order
/// however the triangles are numbered, and by as many threads as there are.
constexpr std::size_t kFacesPerBlock = 2048;

/// A symmetric tensor and the area that it was gathered over.
struct TensorSum {
  double xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0, area = 0;

  void add(const TensorSum& b) {
    xx += b.xx, yy += b.yy, zz += b.zz, xy += b.xy, yz += b.yz, zx += b.zx, area += b.area;
  }
  void add_line(Vec3 d, double w) {
    xx += w * d.x * d.x, yy += w * d.y * d.y, zz += w * d.z * d.z;
    xy += w * d.x * d.y, yz += w * d.y * d.z, zx += w * d.z * d.x;
  }
  double trace() const { return xx + yy + zz; }
};

/// Largest magnitude of the eigenvalues, by the trigonometric solution of the characteristic cubic.
double spectral_radius(const TensorSum& t) {
  const double mean = t.trace() / 3, x = t.xx - mean, y = t.yy - mean, z = t.zz - mean;
  const double off = t.xy * t.xy + t.yz * t.yz + t.zx * t.zx;
  const double p = std::sqrt((x * x + y * y + z * z + 2 * off) / 6);
  if (p == 0) return std::abs(mean);
  const double det = x * (y * z - t.yz * t.yz) - t.xy * (t.xy * z - t.yz * t.zx) + t.zx * (t.xy * t.yz - y * t.zx);
  const double angle = elementary::acos(std::clamp(det / (2 * p * p * p), -1.0, 1.0)) / 3;
  const double most = mean + 2 * p * elementary::cos(angle);
  const double least = mean + 2 * p * elementary::cos(angle + 2 * std::numbers::pi / 3);
  return std::max(std::abs(most), std::abs(least));
}

class CurvatureFinder {
 public:
  CurvatureFinder(const SurfaceMesh& surface, const FaceNeighbours& across) : surface_(surface), across_(across) {
    const std::size_t faces = surface.triangles.size();
    normal_.resize(faces);
    center_.resize(faces);
    own_.resize(faces);
    parallel_for(faces, [&](std::size_t f) {
      const auto [a, b, c] = corners(f);
      const Vec3 n = double_area_normal(a, b, c);
      own_[f] = {};
      own_[f].area = 0.5 * length(n);
      normal_[f] = normalized(n);
      center_[f] = centroid(a, b, c);
    });
    parallel_for(faces, [&](std::size_t f) { add_edges(f); });
  }

  SurfaceCurvature run(const RunContext& context) {
    const std::size_t faces = own_.size();
    SurfaceCurvature result;
    result.largest.assign(faces, -1);
    result.sum.assign(faces, 0);
    const RawVector<std::uint32_t> order = along_the_curve();
    block_.resize(faces);
    parallel_for(faces, [&](std::size_t i) { block_[order[i]] = static_cast<std::uint32_t>(i / kFacesPerBlock); });
    PerThread<Ball> balls;
    const std::size_t blocks = (faces + kFacesPerBlock - 1) / kFacesPerBlock;
    parallel_for(blocks, [&](std::size_t b) {
      context.check();
      Ball& ball = balls.local([&] { return Ball{std::vector<std::uint32_t>(faces, kNone), {}}; });
      for (std::size_t i = b * kFacesPerBlock; i < std::min(faces, (b + 1) * kFacesPerBlock); ++i) {
        if (result.largest[order[i]] < 0) answer_around(order[i], ball, result);
      }
    });
    return result;
  }

 private:
  /// The faces in a ball, and for each face the last seed in whose ball it was.
  struct Ball {
    std::vector<std::uint32_t> visited_by, faces;
  };

  RawVector<std::uint32_t> along_the_curve() const {
    struct Place {
      OctreeKey cell;
      std::uint32_t face;
      auto operator<=>(const Place&) const = default;
    };
    const RootCube root = RootCube::around(bounding_box(surface_.points), 0);
    RawVector<Place> places(center_.size());
    parallel_for(places.size(), [&](std::size_t f) {
      places[f] = {root.cell(center_[f]), static_cast<std::uint32_t>(f)};
    });
    parallel_sort(places);
    RawVector<std::uint32_t> order(places.size());
    parallel_for(order.size(), [&](std::size_t i) { order[i] = places[i].face; });
    return order;
  }

  std::array<Vec3, 3> corners(std::size_t f) const {
    const Triangle& t = surface_.triangles[f];
    return {surface_.points[t[0]], surface_.points[t[1]], surface_.points[t[2]]};
  }

  /// Each face takes half of the turning at each of its edges.
  void add_edges(std::size_t f) {
    const auto p = corners(f);
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t g = across_[f][i];
      if (g == kNone) continue;
      const Vec3 along = p[(i + 1) % 3] - p[i];
      const double l = length(along);
      if (l == 0) continue;
      const Vec3 d = along / l;
      const double turn = elementary::atan2(dot(cross(normal_[f], normal_[g]), d), dot(normal_[f], normal_[g]));
      own_[f].add_line(d, 0.5 * turn * l);
    }
  }

  double ball_radius(std::uint32_t f) const {
    double sum = own_[f].area;
    int n = 1;
    for (const std::uint32_t g : across_[f]) {
      if (g != kNone) sum += own_[g].area, ++n;
    }
    return kBallRadius * kEdgeOfUnitArea * std::sqrt(sum / n);
  }

  /// Writes to the seed's own block only.
  void answer_around(std::uint32_t seed, Ball& around, SurfaceCurvature& result) const {
    auto& [visited_by, ball] = around;
    const double radius = ball_radius(seed), r2 = radius * radius;
    ball.assign(1, seed);
    visited_by[seed] = seed;
    TensorSum sum;
    for (std::size_t i = 0; i < ball.size(); ++i) {
      sum.add(own_[ball[i]]);
      for (const std::uint32_t g : across_[ball[i]]) {
        if (g == kNone || visited_by[g] == seed || squared_distance(center_[g], center_[seed]) > r2) continue;
        visited_by[g] = seed;
        ball.push_back(g);
      }
    }
    const double largest = sum.area > 0 ? spectral_radius(sum) / sum.area : 0;
    const double trace = sum.area > 0 ? sum.trace() / sum.area : 0;
    for (const std::uint32_t f : ball) {
      if (block_[f] != block_[seed] || result.largest[f] >= 0) continue;
      if (f != seed && squared_distance(center_[f], center_[seed]) > kAnsweredPart * kAnsweredPart * r2) continue;
      result.largest[f] = largest;
      result.sum[f] = trace;
    }
  }

  const SurfaceMesh& surface_;
  const FaceNeighbours& across_;
  RawVector<Vec3> normal_, center_;
  RawVector<TensorSum> own_;
  RawVector<std::uint32_t> block_;
};

/// The centroid of an equilateral triangle with its corners on a sphere of curvature k lies k h^2 / 6 below it.
double size_of_chord_error(double error, double k) {
  return std::sqrt(6 * error / k);
}

SurfaceCurvature curvature_between_features(const KnownSurface& known, const RunContext& context) {
  return surface_curvature(known.mesh(), smooth_face_neighbours(known.edges(), known.features().edges), context);
}

}  // namespace

FaceNeighbours smooth_face_neighbours(const EdgeTable& table, const std::vector<Edge>& features) {
  FaceNeighbours across(table.half_edges.size() / 3, {kNone, kNone, kNone});
  parallel_ranges(table.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
    auto feature = std::lower_bound(features.begin(), features.end(), table.edges[begin]);
    for (std::size_t e = begin; e < end; ++e) {
      while (feature != features.end() && *feature < table.edges[e]) ++feature;
      const bool is_feature = feature != features.end() && *feature == table.edges[e];
      if (table.uses(e).size() != 2 || is_feature) continue;
      const HalfEdge g = table.uses(e)[0], h = table.uses(e)[1];
      across[g / 3][g % 3] = h / 3;
      across[h / 3][h % 3] = g / 3;
    }
  });
  return across;
}

SurfaceCurvature surface_curvature(const SurfaceMesh& surface, const FaceNeighbours& across,
                                   const RunContext& context) {
  return CurvatureFinder(surface, across).run(context);
}

void apply_curvature(const SurfaceCurvature& curvature, double elements, double floor, std::vector<double>& face) {
  const double turn = 2 * std::numbers::pi / elements;
  for (std::size_t f = 0; f < face.size(); ++f) {
    if (curvature.largest[f] * face[f] > turn) face[f] = std::max(floor, turn / curvature.largest[f]);
  }
}

void apply_chord_errors(const SurfaceCurvature& curvature, const std::function<double(std::size_t face)>& error_of,
                        double floor, std::vector<double>& face) {
  for (std::size_t f = 0; f < face.size(); ++f) {
    const double k = curvature.largest[f], error = error_of(f);
    if (k * face[f] * face[f] > 6 * error) face[f] = std::max(floor, size_of_chord_error(error, k));
  }
}

void refuse_huge_curvature(const Affordable& affordable, const SizeOptions& options,
                           const SurfaceCurvature& curvature) {
  if (options.curvature) {
    const double turn = 2 * std::numbers::pi / *options.curvature;
    affordable.require("curvature", *options.curvature,
                       affordable.tets_on_faces([&](std::size_t f) { return turn / curvature.largest[f]; }));
  }
  if (options.chord_error)
    affordable.require("max_deviation", *options.chord_error, affordable.tets_on_faces([&](std::size_t f) {
      return size_of_chord_error(*options.chord_error, curvature.largest[f]);
    }));
}

// The corners of an equilateral triangle lie h / sqrt(3) from its centre, where it is parallel to the surface.
void refuse_huge_turning(const KnownSurface& known, const SizeOptions& options, double degrees,
                         const RunContext& context) {
  const SurfaceCurvature curvature = curvature_between_features(known, context);
  const double turn = degrees * std::numbers::pi / 180;
  const Affordable affordable(known.mesh(), options);
  affordable.require("normal_deviation", degrees, affordable.tets_on_faces([&](std::size_t f) {
    return std::numbers::sqrt3 * turn / curvature.largest[f];
  }));
}

// Vertices lie on the surface, with edges of length h between them: the triangles lie h^2 (k1 + k2) / 16 below it on
// average.
double predicted_volume_loss(const SurfaceMesh& surface, const SurfaceCurvature& curvature,
                             const std::vector<double>& face) {
  double sum = 0;
  for (std::size_t f = 0; f < face.size(); ++f) {
    const Triangle& t = surface.triangles[f];
    sum += triangle_area(surface.points, t) * curvature.sum[f] * face[f] * face[f] / 16;
  }
  return std::abs(sum);
}

double predicted_volume_loss(const KnownSurface& known, const SizeField& sizes, const RunContext& context) {
  const SurfaceMesh& surface = known.mesh();
  const SurfaceCurvature curvature = curvature_between_features(known, context);
  std::vector<double> face;
  for (const auto& [a, b, c] : surface.triangles)
    face.push_back(sizes.at(centroid(surface.points[a], surface.points[b], surface.points[c])));
  return predicted_volume_loss(surface, curvature, face) / std::abs(enclosed_volume(surface));
}

}  // namespace octafront
