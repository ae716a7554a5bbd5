#include "improve/shape/edit_mesh.h"

#include <octafront/error.h>

#include "base/core/fixed_point.h"
#include "base/core/groups.h"
#include "base/core/index_range.h"
#include "base/core/parallel.h"
#include "base/core/validate.h"
#include "base/geometry/predicates.h"
#include "base/mesh/labels.h"
#include "base/mesh/renumber_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

namespace octafront::improve {

namespace {

/// Room for slots: otherwise the first to ask has all of them copied.
constexpr std::size_t kMeshRoomPart = 16, kLeastRoom = 1024;

/// To `size`, with room for some more: by itself a vector would double.
template <class Item>
void grow(std::vector<Item>& items, std::size_t size, const std::type_identity_t<Item>& fresh) {
  if (size > items.capacity()) items.reserve(size + size / kMeshRoomPart);
  items.resize(size, fresh);
}

}  // namespace

Groups<> order_by_key(const std::vector<Tet>& tets, std::size_t vertices) {
  static_assert(kNone == kNoOwner);
  Groups<> by_corner = group_by_owner(vertices, static_cast<TetIndex>(tets.size()), [&](TetIndex t) {
    return std::min({tets[t][0], tets[t][1], tets[t][2], tets[t][3]});
  });
  // Those of a group differ in the other three corners of their keys, which are made once.
  struct Keyed {
    std::uint64_t middle;
    VertexIndex last;
    TetIndex tet;
    auto operator<=>(const Keyed&) const = default;
  };
  parallel_ranges(by_corner.size(), Split::kAdaptive, [&](std::size_t begin, std::size_t end) {
    std::vector<Keyed> keyed;
    for (std::size_t v = begin; v < end; ++v) {
      const std::span<TetIndex> group = by_corner[v];
      if (group.size() < 2) continue;
      keyed.clear();
      for (const TetIndex t : group) {
        const Tet key = tet_key(tets[t]);
        keyed.push_back({std::uint64_t{key[1]} << 32 | key[2], key[3], t});
      }
      std::ranges::sort(keyed);
      std::ranges::transform(keyed, group.begin(), &Keyed::tet);
    }
  });
  return by_corner;
}

EditMesh::EditMesh(TetMesh&& mesh, ImproveOptions::Objective objective, Rim rim) : objective_(objective), rim_(rim) {
  require_in_range(mesh.tets.size(), kMostTetsToImprove, "tetrahedra to improve");
  take(mesh);
  rest_ = std::move(mesh);
  connect();
  compute_shapes();
}

/// Tets in order of their keys: what comes of the mesh must not hang on the order in which they came.
void EditMesh::take(TetMesh& mesh) {
  points_ = std::exchange(mesh.points, {});
  had_regions_ = !mesh.region.empty();
  const std::size_t room = mesh.tets.size() + mesh.tets.size() / kMeshRoomPart + kLeastRoom;
  complex_.tets.reserve(room);
  complex_.across.reserve(4 * room);
  shapes_.reserve(room);
  if (had_regions_) region_.reserve(room);
  const Groups<> order = order_by_key(mesh.tets, points_.size());
  complex_.tets.resize(mesh.tets.size());
  region_.resize(mesh.region.size());
  parallel_for(mesh.tets.size(), [&](std::size_t k) {
    complex_.tets[k] = mesh.tets[order.items()[k]];
    if (had_regions_) region_[k] = mesh.region[order.items()[k]];
  });
  numbers_.assign(order.items().begin(), order.items().end());
  mesh.tets = std::vector<Tet>();
}

void EditMesh::connect() {
  complex_.connect(points_.size(), rest_.boundary);
  complex_.part(points_.size(), rest_.interfaces, kBetweenRegions);
  complex_.marks = std::vector<std::uint32_t>();
  on_boundary_.assign(points_.size(), 0);
  for (const Triangle& t : rest_.boundary)
    for (const VertexIndex v : t) on_boundary_[v] = 1;
  for (const Triangle& t : rest_.interfaces)
    for (const VertexIndex v : t) on_boundary_[v] = 1;
  auto& across = complex_.across;
  for (HalfFace h = 0; rim_ == Rim::kHeld && h < across.size(); ++h)
    if (across[h] == kNone) part(h, h);
  if (const std::size_t h = parallel_find(across.size(), [&](std::size_t i) { return across[i] == kNone; });
      h < across.size())
    throw_unmatched(static_cast<HalfFace>(h));
  if (!had_regions_) return;
  for (HalfFace h = 0; h < across.size(); ++h)
    if (const HalfFace o = across[h]; !is_outside(o) && region_[h / 4] != region_[o / 4]) part(h, o);
}

void EditMesh::throw_unmatched(HalfFace h) const {
  const Triangle f = face_key(complex_.face(h));
  throw MeshingError(fmt::format("face ({}, {}, {}) of tetrahedron {} is neither shared nor on the boundary", f[0],
                                 f[1], f[2], h / 4));
}

void EditMesh::part(HalfFace h, HalfFace other) {
  for (const HalfFace side : {h, other}) complex_.across[side] = kBetweenRegions;
  for (const VertexIndex v : complex_.face(h)) on_boundary_[v] = 1;
}

void EditMesh::compute_shapes() {
  shapes_.resize(complex_.tets.size());
  parallel_ranges(shapes_.size(), Split::kAdaptive, [this](std::size_t begin, std::size_t end) {
    for_each_shape(points_, complex_.tets, objective_, begin, end,
                   [this](std::size_t t, const Shape& shape) { shapes_[t] = shape; });
  });
}

void EditMesh::remember() {
  taken_.emplace(Taken{points_, numbers_, {}, rest_.boundary});
}

EditMesh::Change EditMesh::change() const {
  Change change;
  const auto taken = static_cast<VertexIndex>(taken_->points.size());
  for (VertexIndex v = 0; v < taken; ++v)
    if (points_[v] != taken_->points[v]) change.moved.push_back({v, points_[v]});
  std::vector<VertexIndex> number(points_.size(), kNone);
  std::iota(number.begin(), number.begin() + taken, VertexIndex{0});
  for (VertexIndex v = taken; v < points_.size(); ++v) {
    if (complex_.tet_at[v] == kNone) continue;
    number[v] = taken + static_cast<VertexIndex>(change.added.size());
    change.added.push_back(points_[v]);
  }
  const auto numbered = [&](auto corners) {
    for (VertexIndex& v : corners)
      if (v != kNone) v = number[v];
    return corners;
  };
  change.gone = taken_->gone;
  for (TetIndex t = 0; t < slots(); ++t) {
    if (!alive(t) || taken_->number[t] != kNone) continue;
    change.made.push_back(numbered(tet(t)));
    if (had_regions_) change.region_of_made.push_back(region_[t]);
  }
  for (std::uint32_t t = 0; t < rest_.boundary.size(); ++t)
    if (rest_.boundary[t] != taken_->boundary[t]) change.boundary.push_back({t, numbered(rest_.boundary[t])});
  return change;
}

TetMesh EditMesh::release() {
  taken_.reset();
  TetMesh mesh = std::move(rest_);
  std::vector<VertexIndex> new_of_old(points_.size(), kNone);
  for (VertexIndex v = 0; v < points_.size(); ++v)
    if (complex_.tet_at[v] != kNone) new_of_old[v] = 0;
  mesh.points = points_;
  keep_numbered(mesh.points, new_of_old);
  drop_removed_triangles(mesh);
  renumber_vertices(mesh, new_of_old);
  complex_.across = std::vector<HalfFace>();
  shapes_ = std::vector<Shape>();
  const Groups<> order = order_by_key(complex_.tets, points_.size());
  const std::span<const TetIndex> kept = order.items();
  mesh.tets.resize(kept.size());
  if (had_regions_) mesh.region.resize(kept.size());
  parallel_for(kept.size(), [&](std::size_t k) {
    for (int i = 0; i < 4; ++i) mesh.tets[k][i] = new_of_old[complex_.tets[kept[k]][i]];
    if (had_regions_) mesh.region[k] = region_[kept[k]];
  });
  complex_.tets = std::vector<Tet>();
  return mesh;
}

void drop_removed_triangles(TetMesh& mesh) {
  const std::size_t outer = mesh.boundary.size();
  std::vector<std::uint32_t> faces(outer + mesh.interfaces.size());
  std::iota(faces.begin(), faces.end(), 0u);
  std::vector<std::uint32_t> left(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(outer));
  for (std::size_t t = outer; t-- > 0;) {
    if (mesh.boundary[t][0] != kNone) continue;
    left[t] = left.back();
    left.pop_back();
  }
  if (left.size() == outer) return;
  const TetMesh before = mesh;
  mesh.boundary.clear();
  for (const std::uint32_t f : left) mesh.boundary.push_back(before.boundary[f]);
  left.insert(left.end(), faces.begin() + static_cast<std::ptrdiff_t>(outer), faces.end());
  inherit(mesh, before, NamedSet::Kind::kFaces, left);
}

void EditMesh::move(VertexIndex v, Vec3 to, std::span<const HalfFace> star_faces, const ShapeBatch& shapes) {
  points_[v] = to;
  for (std::size_t k = 0; k < star_faces.size(); ++k) shapes_[star_faces[k] / 4] = shapes.shape(static_cast<int>(k));
  for (std::size_t k = 0; kValidate && k < star_faces.size(); ++k) validate(*this, std::array{star_faces[k] / 4});
}

void EditMesh::reserve_tets(std::size_t more) {
  const std::size_t first = complex_.tets.size(), last = first + more;
  grow(complex_.tets, last, {kNone, kNone, kNone, kNone});
  grow(complex_.across, 4 * last, kNone);
  grow(shapes_, last, kNoShape);
  if (had_regions_) grow(region_, last, 0);
  if (taken_) grow(taken_->number, last, kNone);
  for (std::size_t t = last; t-- > first;) complex_.free.push_back(static_cast<TetIndex>(t));
}

void EditMesh::reserve_points(std::size_t more) {
  const std::size_t first = points_.size(), last = first + more;
  points_.resize(last);
  complex_.tet_at.resize(last, kNone);
  on_boundary_.resize(last, 0);
  for (std::size_t v = last; v-- > first;) free_points_.push_back(static_cast<VertexIndex>(v));
}

std::optional<std::string> EditMesh::wrong_at_tet(TetIndex t) const {
  if (!alive(t)) return shapes_[t] == kNoShape ? std::nullopt : std::optional{fmt::format("slot {} has a shape", t)};
  for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
    const HalfFace o = across(h);
    if (!is_outside(o) || o == kBetweenRegions) continue;
    const std::uint32_t b = o - kFirstOutside;
    if (b >= rest_.boundary.size() || face_key(rest_.boundary[b]) != face_key(complex_.face(h)))
      return fmt::format("across face {} of tetrahedron {} lies no boundary triangle on its corners", h % 4, t);
  }
  const Tet& c = tet(t);
  const Vec3 p = point(c[0]), q = point(c[1]), r = point(c[2]), s = point(c[3]);
  if (orient3d(p, q, r, s) <= 0) return fmt::format("tetrahedron {} is not positive", t);
  if (shapes_[t] != shape_of(p, q, r, s, objective_))
    return fmt::format("the shape of tetrahedron {} is not its own", t);
  return std::nullopt;
}

std::optional<std::string> EditMesh::first_inconsistency() const {
  if (auto wrong = complex_.first_inconsistency()) return wrong;
  for (TetIndex t = 0; t < slots(); ++t)
    if (auto wrong = wrong_at_tet(t)) return wrong;
  return std::nullopt;
}

std::optional<std::string> EditMesh::first_inconsistency(std::span<const TetIndex> touched) const {
  if (auto wrong = complex_.first_inconsistency(touched)) return wrong;
  for (const TetIndex t : touched)
    if (auto wrong = wrong_at_tet(t)) return wrong;
  return std::nullopt;
}

Floor EditMesh::floor() const {
  return parallel_sum(shapes_.size(), [this](std::size_t begin, std::size_t end) {
    // All four at once by a vector unit.
    std::array<float, 4> least{2, 2, 2, 2};
    for (std::size_t t = begin; t < end; ++t) {
      const auto of_tet = std::bit_cast<std::array<float, 4>>(shapes_[t]);
      for (std::size_t k = 0; k < 4; ++k) least[k] = of_tet[k] < least[k] ? of_tet[k] : least[k];
    }
    return std::bit_cast<Floor>(least);
  });
}

double EditMesh::mean_beta() const {
  const Fixed sum = parallel_sum(shapes_.size(), [this](std::size_t begin, std::size_t end) {
    Fixed part = 0;
    for (std::size_t t = begin; t < end; ++t)
      if (complex_.alive(static_cast<TetIndex>(t))) part += to_fixed(shapes_[t].beta);
    return part;
  });
  return from_fixed(sum) / static_cast<double>(live_tets());
}

float worst_score(const TetMesh& mesh, ImproveOptions::Objective objective) {
  const Floor floor = parallel_sum(mesh.tets.size(), [&](std::size_t begin, std::size_t end) {
    Floor part;
    for_each_shape(mesh.points, mesh.tets, objective, begin, end,
                   [&](std::size_t, const Shape& shape) { part.add(shape); });
    return part;
  });
  return floor.score;
}

}  // namespace octafront::improve
