#include "surface/edits/walk.h"

#include <octafront/surface_mesh.h>

#include <algorithm>

namespace octafront::surface {

namespace {

/// A vertex has no normal where a face around it turns from their mean by more than this cosine says: at the tip of a
/// cone that is its axis, and every point near the tip would seem to lie above all others, on a sheet of its own.
constexpr double kPointed = 0.6;

/// Longest path of a walk, in crossed triangles: dense scans under coarse elements cross some hundreds.
constexpr int kMaxSteps = 20000;

/// The section of the surface with a plane through `origin`; sides are decided by sign alone, zero counting as
/// positive, so that every triangle that is entered through one edge is left through exactly one other.
struct Section {
  const HalfEdgeMesh& mesh;
  Vec3 origin, direction, plane;
  double distance;

  double side(VertexIndex v) const { return dot(mesh.points[v] - origin, plane); }
  Vec3 crossing(HalfEdge h, double start_side, double end_side) const {
    const Vec3 a = mesh.points[mesh.start[h]], b = mesh.points[mesh.end(h)];
    const double s = start_side / (start_side - end_side);
    return a + (b - a) * s;
  }
};

/// The point of the segment from a to b (within and beyond the sphere) at `distance` from the origin.
Vec3 at_distance(Vec3 a, Vec3 b, Vec3 origin, double distance) {
  const Vec3 d = b - a, o = a - origin;
  const double dd = dot(d, d), od = dot(o, d), c = dot(o, o) - distance * distance;
  const double root = std::sqrt(std::max(0.0, od * od - dd * c));
  const double s = dd > 0 ? std::clamp((root - od) / dd, 0.0, 1.0) : 0.0;
  return a + d * s;
}

/// Goes on from `at`, inside the triangle of `exit`, through `exit` and further.
WalkEnd march(const Section& section, Vec3 at, HalfEdge exit, double start_side, double end_side,
              SurfacePoint& result) {
  const HalfEdgeMesh& mesh = section.mesh;
  double path = 0;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Vec3 x = section.crossing(exit, start_side, end_side);
    result.face = exit / 3;
    if (squared_length(x - section.origin) >= section.distance * section.distance) {
      result.p = at_distance(at, x, section.origin, section.distance);
      return WalkEnd::kArrived;
    }
    result.p = x;
    if (mesh.is_feature[exit]) return WalkEnd::kFeature;
    path += distance(at, x);
    if (path > 4 * section.distance) return WalkEnd::kLost;
    at = x;
    const HalfEdge entry = mesh.twin[exit];
    const double apex_side = section.side(mesh.apex(entry));
    // entry runs from the vertex with end_side to that with start_side.
    if ((apex_side >= 0) == (start_side >= 0)) {
      exit = previous_of(entry);
      start_side = apex_side;
    } else {
      exit = next_of(entry);
      end_side = apex_side;
    }
  }
  return WalkEnd::kLost;
}

}  // namespace

Vec3 InputSurface::normal_at(std::uint32_t face, Vec3 p) const {
  const Vec3 n = face_normal[face];
  const VertexIndex v[3] = {mesh.start[3 * face], mesh.start[3 * face + 1], mesh.start[3 * face + 2]};
  const Vec3 a = mesh.points[v[0]] - p, b = mesh.points[v[1]] - p, c = mesh.points[v[2]] - p;
  const double w[3] = {std::max(0.0, dot(cross(b, c), n)), std::max(0.0, dot(cross(c, a), n)),
                       std::max(0.0, dot(cross(a, b), n))};
  const double sum = w[0] + w[1] + w[2];
  if (!(sum > 0)) return is_smooth_at(v[0]) ? vertex_normal[v[0]] : n;
  Vec3 result;
  for (int i = 0; i < 3; ++i) result += (is_smooth_at(v[i]) ? vertex_normal[v[i]] : n) * (w[i] / sum);
  const double l = length(result);
  return l > 0.1 ? result / l : n;
}

void set_features(InputSurface& input, const std::vector<Edge>& edges) {
  HalfEdgeMesh& mesh = input.mesh;
  std::fill(mesh.is_feature.begin(), mesh.is_feature.end(), std::uint8_t{0});
  input.on_feature.assign(mesh.points.size(), 0);
  for (const Edge& e : edges) {
    const HalfEdge h = mesh.find(e[0], e[1]);
    if (h == kNone) continue;
    mesh.set_feature(h, true);
    input.on_feature[e[0]] = input.on_feature[e[1]] = 1;
  }
  if (input.first_back == kNone) return;
  // Around a slit two seams run between the same two vertices, of which find() knows one.
  for (HalfEdge h = 0; h < mesh.start.size(); ++h) {
    if (!input.is_seam(h)) continue;
    mesh.set_feature(h, true);
    input.on_feature[mesh.start[h]] = 1;
  }
}

void find_normals(InputSurface& input) {
  const HalfEdgeMesh& mesh = input.mesh;
  const std::size_t faces = mesh.triangle_count();
  input.face_normal.resize(faces);
  input.vertex_normal.assign(mesh.points.size(), Vec3{});
  for (std::uint32_t t = 0; t < faces; ++t) {
    const Vec3 n = mesh.area_vector(t);
    input.face_normal[t] = normalized(n);
    for (int i = 0; i < 3; ++i) input.vertex_normal[mesh.start[3 * t + i]] += n;
  }
  for (Vec3& n : input.vertex_normal) n = normalized(n);
  std::vector<std::uint8_t> is_pointed(mesh.points.size(), 0);
  for (HalfEdge h = 0; h < mesh.start.size(); ++h)
    if (dot(input.vertex_normal[mesh.start[h]], input.face_normal[h / 3]) < kPointed) is_pointed[mesh.start[h]] = 1;
  for (VertexIndex v = 0; v < is_pointed.size(); ++v)
    if (is_pointed[v]) input.vertex_normal[v] = {};
}

InputSurface make_input_surface(const SurfaceMesh& surface, const EdgeTable& edges) {
  InputSurface input;
  input.mesh = make_half_edge_mesh(surface, edges);
  input.patch.resize(input.mesh.triangle_count());
  for (std::uint32_t t = 0; t < input.patch.size(); ++t) input.patch[t] = surface.patch_of(t);
  find_normals(input);
  set_features(input, {});
  return input;
}

WalkEnd walk(const InputSurface& input, SurfacePoint from, Vec3 direction, Vec3 normal, double distance,
             SurfacePoint& result) {
  const HalfEdgeMesh& mesh = input.mesh;
  const Section section{mesh, from.p, direction, normalized(cross(normal, direction)), distance};
  double side[3];
  for (int i = 0; i < 3; ++i) side[i] = section.side(mesh.start[3 * from.face + i]);
  int best = -1;
  double farthest = 0;
  for (int i = 0; i < 3; ++i) {
    const double a = side[i], b = side[(i + 1) % 3];
    if ((a >= 0) == (b >= 0)) continue;
    const double ahead = dot(section.crossing(3 * from.face + i, a, b) - from.p, direction);
    if (best < 0 || ahead > farthest) {
      best = i;
      farthest = ahead;
    }
  }
  if (best < 0) return WalkEnd::kLost;
  return march(section, from.p, 3 * from.face + best, side[best], side[(best + 1) % 3], result);
}

WalkEnd walk_from_vertex(const InputSurface& input, HalfEdge corner, Vec3 direction, double distance,
                         SurfacePoint& result) {
  const HalfEdgeMesh& mesh = input.mesh;
  const Vec3 normal = input.face_normal[corner / 3];
  const Section section{mesh, mesh.points[mesh.start[corner]], direction, normalized(cross(normal, direction)),
                        distance};
  const HalfEdge opposite = next_of(corner);
  const double a = section.side(mesh.start[opposite]), b = section.side(mesh.end(opposite));
  if ((a >= 0) == (b >= 0)) return WalkEnd::kLost;
  return march(section, section.origin, opposite, a, b, result);
}

}  // namespace octafront::surface
