#include "fill/front/neighborhood.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace octafront {

namespace {

/// A signed distance is computed from a point rounded to float (2^-24 of its size), a normal rounded to float, three
/// products and three sums; 16 times 2^-24 of the largest coordinate covers all of it.
constexpr float kErrorPerExtent = 1e-6f;
/// Planes of triangles thinner than this (height over length) prove nothing: their normal is not accurate enough.
constexpr double kThinnest = 1e-6;

/// A plane n . x = d with |n| = 1, outward; d is infinite where the plane is too ill-conditioned to prove anything.
struct Plane {
  float nx = 0, ny = 0, nz = 0, d = 0;
};

/// The plane through three local points, its normal by the right-hand rule.
Plane plane_through(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = b - a, v = c - a, n = cross(u, v);
  const double l = length(n);
  if (!(l > kThinnest * std::max(squared_length(u), squared_length(v))))
    return {0, 0, 0, std::numeric_limits<float>::infinity()};
  const Vec3 unit = n / l;
  return {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z),
          static_cast<float>(dot(unit, a))};
}

constexpr Neighborhood::Code kBehindBase = 8;

/// Corner i of the tetrahedron lies on all sides but the one opposite.
constexpr Neighborhood::Code code_of_corner(unsigned i) {
  return Neighborhood::kOutside & ~(1u << i);
}

}  // namespace

/// Lists the vertices once each; grows by plain stores into arrays that are large enough beforehand.
class Neighborhood::Listing {
 public:
  Listing(Neighborhood& near, const Front& front, std::size_t most)
      : vertices_(front.vertices().data()), origin_(near.origin_), scale_(near.per_unit_) {
    near.vertex_.resize(most);
    near.x_.resize(most);
    near.y_.resize(most);
    near.z_.resize(most);
    vertex_ = near.vertex_.data();
    x_ = near.x_.data();
    y_ = near.y_.data();
    z_ = near.z_.data();
  }
  Index add(VertexIndex v) {
    const FrontVertex& vertex = vertices_[v];
    // vertex.local is only a hint: it holds if the vertex is really listed there.
    if (vertex.local < size_ && vertex_[vertex.local] == v) return vertex.local;
    vertex.local = size_;
    vertex_[size_] = v;
    x_[size_] = static_cast<float>((vertex.at.x - origin_.x) * scale_);
    y_[size_] = static_cast<float>((vertex.at.y - origin_.y) * scale_);
    z_[size_] = static_cast<float>((vertex.at.z - origin_.z) * scale_);
    return size_++;
  }
  Index size() const { return size_; }

 private:
  const FrontVertex* vertices_;
  Vec3 origin_;
  double scale_;
  VertexIndex* vertex_;
  float *x_, *y_, *z_;
  Index size_ = 0;
};

std::size_t Neighborhood::gather(const Front& front, FaceIndex base, const SearchRegion& region, double unit) {
  const Triangle& corners = front.corners(base);
  origin_ = (front.at(corners[0]) + front.at(corners[1]) + front.at(corners[2])) / 3;
  per_unit_ = 1 / unit;
  found_.clear();
  front.index().find(region, found_);
  Listing listing(*this, front, 3 * found_.size() + 3);
  for (const VertexIndex v : corners) listing.add(v);
  faces_.clear();
  for (const auto& f : found_)
    if (f.face != base)
      faces_.push_back({{listing.add(f.corners[0]), listing.add(f.corners[1]), listing.add(f.corners[2])}, f.face});
  size_ = listing.size();
  float extent = 0;
  for (Index i = 0; i < size_; ++i)
    extent = std::max(extent, std::max(std::abs(x_[i]), std::max(std::abs(y_[i]), std::abs(z_[i]))));
  error_ = kErrorPerExtent * extent;
  code_.resize(size_);
  base_code_.resize(size_);
  for (int i = 0; i < 3; ++i) base_[i] = to_local(front.at(corners[i]));
  drop_faces_behind_base();
  return found_.size();
}

void Neighborhood::drop_faces_behind_base() {
  const Plane base = plane_through(base_[0], base_[2], base_[1]);
  const Index n = size();
  for (Index i = 0; i < n; ++i) {
    const float s = base.nx * x_[i] + base.ny * y_[i] + base.nz * z_[i] - base.d;
    base_code_[i] = s > error_ ? kBehindBase : 0;
  }
  base_code_[0] = base_code_[1] = base_code_[2] = kBehindBase;
  std::erase_if(faces_, [&](const LocalFace& f) {
    return (base_code_[f.corner[0]] & base_code_[f.corner[1]] & base_code_[f.corner[2]]) != 0;
  });
}

void Neighborhood::classify(Index apex, Vec3 apex_at, float margin) {
  const Index n = size();
  const float *x = x_.data(), *y = y_.data(), *z = z_.data();
  const Code* base = base_code_.data();
  Code* code = code_.data();
  const float least = error_, clear = std::max(margin, error_);
  const auto& [a, b, c] = base_;
  const Plane p = plane_through(b, c, apex_at), q = plane_through(c, a, apex_at), r = plane_through(a, b, apex_at);
  for (Index i = 0; i < n; ++i) {
    const float s0 = p.nx * x[i] + p.ny * y[i] + p.nz * z[i] - p.d;
    const float s1 = q.nx * x[i] + q.ny * y[i] + q.nz * z[i] - q.d;
    const float s2 = r.nx * x[i] + r.ny * y[i] + r.nz * z[i] - r.d;
    const int bits = (s0 > least ? 1 : 0) | (s1 > least ? 2 : 0) | (s2 > least ? 4 : 0) | (s0 > clear ? 16 : 0) |
                     (s1 > clear ? 32 : 0) | (s2 > clear ? 64 : 0);
    code[i] = static_cast<Code>(bits | base[i]);
  }
  for (Index i = 0; i < 3; ++i) code[i] = code_of_corner(i);
  if (apex != kNone) code[apex] = code_of_corner(3);
}

}  // namespace octafront
