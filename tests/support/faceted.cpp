#include "support/faceted.h"

#include <cmath>
#include <utility>
#include <vector>

namespace octafront::testing {
namespace {

const double kPi = std::acos(-1);

Vec3 on_circle(double radius, double angle, double z) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

void add_quad(SurfaceMesh& s, VertexIndex a, VertexIndex b, VertexIndex c, VertexIndex d) {
  s.triangles.push_back({a, b, c});
  s.triangles.push_back({a, c, d});
}

constexpr double kThreadHeight = 1.2;

/// Rows of points around a thread, from below.
void add_thread(SurfaceMesh& s, int sides, int steps, double turn) {
  constexpr double kDepth = .12, kPitch = .8;
  for (int k = 0; k <= steps; ++k)
    for (int i = 0; i < sides; ++i) {
      const double z = kThreadHeight * k / steps, angle = turn + 2 * kPi * i / sides;
      const double fade = std::sin(kPi * z / kThreadHeight);
      s.points.push_back(on_circle(1 + kDepth * fade * fade * std::sin(2 * kPi * z / kPitch - angle), angle, z));
    }
}

/// Radii and heights.
using Profile = std::vector<std::pair<double, double>>;

void add_circles(SurfaceMesh& s, const Profile& profile, int sides, double turn) {
  for (const auto& [radius, z] : profile)
    for (int i = 0; i < sides; ++i) s.points.push_back(on_circle(radius, turn + 2 * kPi * i / sides, z));
}

/// From its lower end to its upper one, both closed.
SurfaceMesh turned_stack(const Profile& profile, int sides, double turn) {
  SurfaceMesh body;
  const auto n = static_cast<VertexIndex>(sides), rows = static_cast<VertexIndex>(profile.size());
  add_circles(body, profile, sides, turn);
  body.points.push_back({0, 0, profile.front().second});
  body.points.push_back({0, 0, profile.back().second});
  const VertexIndex low = rows * n, high = low + 1, last = low - n;
  for (VertexIndex i = 0; i < n; ++i) {
    const VertexIndex j = (i + 1) % n;
    for (VertexIndex k = 0; k + 1 < rows; ++k) add_quad(body, k * n + i, k * n + j, (k + 1) * n + j, (k + 1) * n + i);
    body.triangles.push_back({low, j, i});
    body.triangles.push_back({high, last + i, last + j});
  }
  return body;
}

/// A closed profile, its inside on the right.
SurfaceMesh turned_loop(const Profile& profile, int sides) {
  SurfaceMesh ring;
  const auto n = static_cast<VertexIndex>(sides), rows = static_cast<VertexIndex>(profile.size());
  add_circles(ring, profile, sides, 0);
  for (VertexIndex i = 0; i < n; ++i)
    for (VertexIndex k = 0; k < rows; ++k) {
      const VertexIndex j = (i + 1) % n, l = (k + 1) % rows;
      add_quad(ring, k * n + i, l * n + i, l * n + j, k * n + j);
    }
  return ring;
}

}  // namespace

SurfaceMesh faceted_pin(int sides, double radius, double low, double high, double turn) {
  return turned_stack({{radius, low}, {radius, high}}, sides, turn);
}

SurfaceMesh faceted_ring(int sides, double inner, double outer, double height) {
  return turned_loop({{inner, 0}, {inner, height}, {outer, height}, {outer, 0}}, sides);
}

SurfaceMesh faceted_plug(int sides, double turn) {
  return turned_stack({{1, 0}, {1, .7}, {1.5, 1.2}}, sides, turn);
}

SurfaceMesh faceted_countersink(int sides) {
  return turned_loop({{1, 0}, {1, .7}, {1.5, 1.2}, {2.5, 1.2}, {2.5, 0}}, sides);
}

SurfaceMesh faceted_ball(int around, int down, double radius) {
  SurfaceMesh ball;
  const auto n = static_cast<VertexIndex>(around), rows = static_cast<VertexIndex>(down - 1);
  for (int k = 1; k < down; ++k)
    for (int i = 0; i < around; ++i)
      ball.points.push_back(
          on_circle(radius * std::sin(kPi * k / down), 2 * kPi * i / around, radius * std::cos(kPi * k / down)));
  ball.points.push_back({0, 0, radius});
  ball.points.push_back({0, 0, -radius});
  const VertexIndex top = rows * n, bottom = top + 1;
  for (VertexIndex i = 0; i < n; ++i) {
    const VertexIndex j = (i + 1) % n;
    ball.triangles.push_back({top, i, j});
    ball.triangles.push_back({bottom, (rows - 1) * n + j, (rows - 1) * n + i});
    for (VertexIndex k = 0; k + 1 < rows; ++k) add_quad(ball, k * n + i, (k + 1) * n + i, (k + 1) * n + j, k * n + j);
  }
  return ball;
}

SurfaceMesh faceted_segment(int sides, double inner, double outer, double low, double high, double from, double to) {
  SurfaceMesh part;
  const auto n = static_cast<VertexIndex>(sides + 1);
  for (const auto& [radius, z] :
       {std::pair{inner, low}, std::pair{inner, high}, std::pair{outer, high}, std::pair{outer, low}})
    for (int i = 0; i <= sides; ++i) part.points.push_back(on_circle(radius, from + (to - from) * i / sides, z));
  for (VertexIndex i = 0; i + 1 < n; ++i)
    for (VertexIndex k = 0; k < 4; ++k) {
      const VertexIndex l = (k + 1) % 4;
      add_quad(part, k * n + i, l * n + i, l * n + i + 1, k * n + i + 1);
    }
  add_quad(part, 0, 3 * n, 2 * n, n);
  add_quad(part, n - 1, 2 * n - 1, 3 * n - 1, 4 * n - 1);
  return part;
}

SurfaceMesh faceted_screw(int sides, int steps, double turn) {
  SurfaceMesh screw;
  add_thread(screw, sides, steps, turn);
  const auto n = static_cast<VertexIndex>(sides), top = static_cast<VertexIndex>(steps) * n, low = top + n;
  screw.points.push_back({0, 0, 0});
  screw.points.push_back({0, 0, kThreadHeight});
  for (VertexIndex i = 0; i < n; ++i) {
    const VertexIndex j = (i + 1) % n;
    for (VertexIndex k = 0; k < top; k += n) add_quad(screw, k + j, k + n + j, k + n + i, k + i);
    screw.triangles.push_back({low, j, i});
    screw.triangles.push_back({low + 1, top + i, top + j});
  }
  return screw;
}

SurfaceMesh faceted_nut(int sides, int steps) {
  SurfaceMesh nut;
  add_thread(nut, sides, steps, 0);
  const auto n = static_cast<VertexIndex>(sides), rows = static_cast<VertexIndex>(steps + 3);
  for (const double z : {kThreadHeight, 0.})
    for (int i = 0; i < sides; ++i) nut.points.push_back(on_circle(2, 2 * kPi * i / sides, z));
  for (VertexIndex i = 0; i < n; ++i)
    for (VertexIndex k = 0; k < rows; ++k) {
      const VertexIndex j = (i + 1) % n, l = (k + 1) % rows;
      add_quad(nut, k * n + i, l * n + i, l * n + j, k * n + j);
    }
  return nut;
}

}  // namespace octafront::testing
