#include "volume/neighborhood.h"

#include <cmath>
#include <limits>

namespace octafront {

namespace {

/// A signed distance is computed from a point rounded to float (2^-24 of its size), a normal rounded to float, three
/// products and three sums; 16 times 2^-24 of the largest coordinate covers all of it.
constexpr float kErrorPerExtent = 1e-6f;
/// Planes of triangles thinner than this (height over length) prove nothing: their normal is not accurate enough.
constexpr double kThinnest = 1e-6;

}  // namespace

Neighborhood::Plane plane_through(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = b - a, v = c - a, n = cross(u, v);
  const double l = length(n);
  if (!(l > kThinnest * std::max(squared_length(u), squared_length(v))))
    return {0, 0, 0, std::numeric_limits<float>::infinity()};
  const Vec3 unit = n / l;
  return {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z),
          static_cast<float>(dot(unit, a))};
}

Neighborhood::Index Neighborhood::local_index(const Front& front, VertexIndex v) {
  const FrontVertex& vertex = front.vertex(v);
  // vertex.local is only a hint: it holds if the vertex is really listed there.
  if (vertex.local < vertex_.size() && vertex_[vertex.local] == v) return vertex.local;
  vertex.local = size();
  vertex_.push_back(v);
  const Vec3 p = to_local(vertex.at);
  x_.push_back(static_cast<float>(p.x));
  y_.push_back(static_cast<float>(p.y));
  z_.push_back(static_cast<float>(p.z));
  return vertex.local;
}

void Neighborhood::gather(const Front& front, FaceIndex base, const SearchRegion& region, double unit) {
  const Triangle& corners = front.corners(base);
  origin_ = (front.at(corners[0]) + front.at(corners[1]) + front.at(corners[2])) / 3;
  unit_ = unit;
  per_unit_ = 1 / unit;
  found_.clear();
  vertex_.clear();
  x_.clear();
  y_.clear();
  z_.clear();
  faces_.clear();
  front.index().find(region, found_);
  faces_found += found_.size();
  for (const VertexIndex v : corners) local_index(front, v);
  for (const auto& f : found_) {
    if (f.face == base) continue;
    faces_.push_back(
        {{local_index(front, f.corners[0]), local_index(front, f.corners[1]), local_index(front, f.corners[2])},
         f.face});
  }
  float extent = 0;
  for (Index i = 0; i < size(); ++i)
    extent = std::max(extent, std::max(std::abs(x_[i]), std::max(std::abs(y_[i]), std::abs(z_[i]))));
  error_ = kErrorPerExtent * extent;
  code_.resize(size());
  base_code_.resize(size());
  const Vec3 a = to_local(front.at(corners[0])), b = to_local(front.at(corners[1])), c = to_local(front.at(corners[2]));
  drop_faces_behind(plane_through(a, c, b));
}

void Neighborhood::drop_faces_behind(const Plane& base) {
  const Index n = size();
  for (Index i = 0; i < n; ++i) {
    const float s = base.nx * x_[i] + base.ny * y_[i] + base.nz * z_[i] - base.d;
    base_code_[i] = s > error_ ? 8 : 0;
  }
  base_code_[0] = base_code_[1] = base_code_[2] = 8;
  std::erase_if(faces_, [&](const LocalFace& f) {
    return (base_code_[f.corner[0]] & base_code_[f.corner[1]] & base_code_[f.corner[2]]) != 0;
  });
}

void Neighborhood::classify(const std::array<Plane, 3>& planes, float margin) {
  const Index n = size();
  const float *x = x_.data(), *y = y_.data(), *z = z_.data();
  const Code* base = base_code_.data();
  Code* code = code_.data();
  const float least = error_, clear = std::max(margin, error_);
  const Plane p = planes[0], q = planes[1], r = planes[2];
  for (Index i = 0; i < n; ++i) {
    const float s0 = p.nx * x[i] + p.ny * y[i] + p.nz * z[i] - p.d;
    const float s1 = q.nx * x[i] + q.ny * y[i] + q.nz * z[i] - q.d;
    const float s2 = r.nx * x[i] + r.ny * y[i] + r.nz * z[i] - r.d;
    const int c = (s0 > least ? 1 : 0) | (s1 > least ? 2 : 0) | (s2 > least ? 4 : 0) | (s0 > clear ? 16 : 0) |
                  (s1 > clear ? 32 : 0) | (s2 > clear ? 64 : 0);
    code[i] = static_cast<Code>(c | base[i]);
  }
}

}  // namespace octafront
