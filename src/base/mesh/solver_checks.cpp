#include <octafront/run_context.h>
#include <octafront/solver_checks.h>

#include "base/core/parallel.h"
#include "base/core/thread_limit.h"
#include "base/geometry/measures.h"
#include "base/mesh/quadratic_nodes.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <span>

namespace octafront {

namespace {

// --- measures of an element; docs/use/solver-checks.md says whose they are

constexpr double kInfinite = std::numeric_limits<double>::infinity();

using Corners = std::array<Vec3, 3>;

std::array<Corners, 4> faces_of(const QuadraticTet& q) {
  std::array<Corners, 4> faces;
  for (std::size_t f = 0; f < 4; ++f)
    for (std::size_t i = 0; i < 3; ++i) faces[f][i] = q[static_cast<std::size_t>(kTetFaces[f][i])];
  return faces;
}

/// Through each edge and the middle of the one opposite.
std::array<Corners, 6> sections_of(const QuadraticTet& q) {
  std::array<Corners, 6> sections;
  for (std::size_t e = 0; e < 6; ++e) {
    const auto& [a, b] = kTetEdges[e];
    const auto& [c, d] = kTetEdges[5 - e];  // the edge opposite
    sections[e] = {q[static_cast<std::size_t>(a)], q[static_cast<std::size_t>(b)],
                   0.5 * (q[static_cast<std::size_t>(c)] + q[static_cast<std::size_t>(d)])};
  }
  return sections;
}

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

std::array<double, 3> corner_angles(const Corners& t) {
  return {degrees(angle_at(t[0], t[1], t[2])), degrees(angle_at(t[1], t[2], t[0])),
          degrees(angle_at(t[2], t[0], t[1]))};
}

double least_face_angle(const QuadraticTet& q) {
  double least = 180;
  for (const Corners& face : faces_of(q))
    for (const double angle : corner_angles(face)) least = std::min(least, angle);
  return least;
}

double largest_face_angle(const QuadraticTet& q) {
  double largest = 0;
  for (const Corners& face : faces_of(q))
    for (const double angle : corner_angles(face)) largest = std::max(largest, angle);
  return largest;
}

double largest_angle_with_sections(const QuadraticTet& q) {
  double largest = largest_face_angle(q);
  for (const Corners& section : sections_of(q))
    for (const double angle : corner_angles(section)) largest = std::max(largest, angle);
  return largest;
}

/// Longest over shortest edge.
double edge_ratio(const QuadraticTet& q) {
  double shortest = kInfinite, longest = 0;
  for (const auto& [a, b] : kTetEdges) {
    const double edge = distance(q[static_cast<std::size_t>(a)], q[static_cast<std::size_t>(b)]);
    shortest = std::min(shortest, edge);
    longest = std::max(longest, edge);
  }
  return longest / shortest;
}

/// The most stretched of six rectangles around a triangle; 1 if it is equilateral.
double ansys_aspect_ratio(const Corners& t) {
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 apex = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
    const Vec3 along = 0.5 * (b + c) - apex, across = 0.5 * (c - b);
    const double area = length(cross(along, across));  // of either rectangle
    const double a = squared_length(along) / area, w = squared_length(across) / area;
    most = std::max({most, a, 1 / a, w, 1 / w});
  }
  return most / std::numbers::sqrt3;
}

double ansys_aspect_ratio(const QuadraticTet& q) {
  double most = 0;
  for (const Corners& face : faces_of(q)) most = std::max(most, ansys_aspect_ratio(face));
  for (const Corners& section : sections_of(q)) most = std::max(most, ansys_aspect_ratio(section));
  return most;
}

/// Volume over that of the regular tetrahedron in the same circumsphere.
double shape_factor(const QuadraticTet& q) {
  const double radius = circumradius(q[0], q[1], q[2], q[3]);
  const double regular = 8 * std::numbers::sqrt3 / 27 * radius * radius * radius;
  const double volume = signed_volume(q[0], q[1], q[2], q[3]);
  return volume == 0 ? 0 : volume / regular;
}

double least_of(const QuadraticTet& q, std::span<const std::array<double, 4>> places) {
  double least = jacobian_determinant(q, places[0]);
  for (const auto& place : places) least = std::min(least, jacobian_determinant(q, place));
  return least;
}

constexpr std::array<std::array<double, 4>, 4> kCornerPlaces{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

/// At the four integration points of a tetrahedron of second order.
double least_at_integration_points(const QuadraticTet& q) {
  constexpr double kNear = 0.5854101966249685, kFar = 0.1381966011250105;  // (5 + 3 sqrt 5) / 20, (5 - sqrt 5) / 20
  constexpr std::array<std::array<double, 4>, 4> kPlaces{
      {{kNear, kFar, kFar, kFar}, {kFar, kNear, kFar, kFar}, {kFar, kFar, kNear, kFar}, {kFar, kFar, kFar, kNear}}};
  return least_of(q, kPlaces);
}
double least_at_corners(const QuadraticTet& q) {
  return least_of(q, kCornerPlaces);
}

/// Largest over least at the corners; negative if the signs differ.
double jacobian_ratio(const QuadraticTet& q) {
  double least = jacobian_determinant(q, kCornerPlaces[0]), most = least;
  for (const auto& place : kCornerPlaces) {
    const double at = jacobian_determinant(q, place);
    least = std::min(least, at);
    most = std::max(most, at);
  }
  return least > 0 ? most / least : -1;
}
/// As Ansys takes it: an element that is inverted somewhere is worse than any ratio.
double jacobian_ratio_or_infinite(const QuadraticTet& q) {
  const double ratio = jacobian_ratio(q);
  return ratio > 0 ? ratio : kInfinite;
}

/// The shorter part over the longer part of the edge whose mid-side node lies least in its middle.
double edge_point_ratio(const QuadraticTet& q) {
  double least = 1;
  for (std::size_t e = 0; e < 6; ++e) {
    const double a = distance(q[4 + e], q[static_cast<std::size_t>(kTetEdges[e][0])]),
                 b = distance(q[4 + e], q[static_cast<std::size_t>(kTetEdges[e][1])]);
    least = std::min(least, std::min(a, b) / std::max(a, b));
  }
  return least;
}

// --- limits

struct Limit {
  const char* measure;
  bool refused, above;
  double limit;
  bool second_order_only;
  double (*of)(const QuadraticTet&);
};

constexpr bool kRefused = true, kWarned = false, kAbove = true, kBelow = false, kTet10 = true, kAny = false;

constexpr Limit kAbaqusLimits[] = {
    {"Jacobian at the integration points", kRefused, kBelow, 0, kAny, least_at_integration_points},
    {"shape factor", kWarned, kBelow, 0.0001, kAny, shape_factor},
    {"least face corner angle", kWarned, kBelow, 5, kAny, least_face_angle},
    {"largest face corner angle", kWarned, kAbove, 170, kAny, largest_face_angle},
    {"aspect ratio", kWarned, kAbove, 10, kAny, edge_ratio},
};
constexpr Limit kAnsysLimits[] = {
    {"Jacobian ratio", kRefused, kAbove, 1000, kTet10, jacobian_ratio_or_infinite},
    {"Jacobian ratio", kWarned, kAbove, 30, kTet10, jacobian_ratio_or_infinite},
    {"largest corner angle", kRefused, kAbove, 179.9, kAny, largest_angle_with_sections},
    {"largest corner angle", kWarned, kAbove, 165, kAny, largest_angle_with_sections},
    {"aspect ratio", kRefused, kAbove, 1e6, kAny, ansys_aspect_ratio},
    {"aspect ratio", kWarned, kAbove, 20, kAny, ansys_aspect_ratio},
};
constexpr Limit kNastranLimits[] = {
    {"Jacobian at the integration points (TET_DETJ)", kRefused, kBelow, 0, kAny, least_at_integration_points},
    {"Jacobian at the corners (TET_DETG)", kWarned, kBelow, 0, kAny, least_at_corners},
    {"aspect ratio (TET_AR)", kWarned, kAbove, 100, kAny, edge_ratio},
    {"edge point length ratio (TET_EPLR)", kWarned, kBelow, 0.5, kTet10, edge_point_ratio},
};
constexpr Limit kCalculixLimits[] = {
    {"Jacobian at the integration points", kRefused, kBelow, 1e-20, kAny, least_at_integration_points},
};

std::span<const Limit> limits_of(Solver solver) {
  switch (solver) {
    case Solver::kAbaqus:
      return kAbaqusLimits;
    case Solver::kAnsys:
      return kAnsysLimits;
    case Solver::kNastran:
      return kNastranLimits;
    default:
      return kCalculixLimits;
  }
}

bool is_beyond(const Limit& limit, double value) {
  if (limit.above) return !(value <= limit.limit);
  return limit.limit == 0 ? !(value > 0) : !(value >= limit.limit);
}

SolverFinding apply(const Limit& limit, const TetMesh& mesh) {
  constexpr std::size_t kListed = 10;
  std::vector<double> values(mesh.tets.size());
  parallel_for(values.size(),
               [&](std::size_t t) { values[t] = limit.of(quadratic_nodes(mesh, static_cast<TetIndex>(t))); });
  std::vector<TetIndex> beyond;
  for (TetIndex t = 0; t < values.size(); ++t)
    if (is_beyond(limit, values[t])) beyond.push_back(t);
  SolverFinding found{limit.measure, limit.refused, limit.above, limit.limit, beyond.size(), {}};
  const auto listed = static_cast<std::ptrdiff_t>(std::min(kListed, beyond.size()));
  std::partial_sort(beyond.begin(), beyond.begin() + listed, beyond.end(), [&](TetIndex s, TetIndex t) {
    if (values[s] != values[t]) return (values[s] < values[t]) != limit.above;
    return s < t;
  });
  for (std::ptrdiff_t i = 0; i < listed; ++i) {
    const TetIndex t = beyond[static_cast<std::size_t>(i)];
    const auto& [a, b, c, d] = mesh.tets[t];
    found.worst.push_back({t, centroid(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]), values[t]});
  }
  return found;
}

}  // namespace

std::vector<SolverFinding> check_for_solver(const TetMesh& mesh, Solver solver, const RunContext& context) {
  const ThreadLimit threads(context.threads);
  std::vector<SolverFinding> findings;
  for (const Limit& limit : limits_of(solver)) {
    context.check();
    if (limit.second_order_only && !mesh.is_second_order()) continue;
    findings.push_back(apply(limit, mesh));
  }
  return findings;
}

}  // namespace octafront
