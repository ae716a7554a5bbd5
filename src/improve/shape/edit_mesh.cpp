#include "improve/shape/edit_mesh.h"

#include <octafront/error.h>

#include "base/core/fixed_point.h"
#include "base/core/groups.h"
#include "base/core/parallel.h"
#include "base/core/validate.h"
#include "base/geometry/predicates.h"
#include "base/geometry/spatial_order.h"
#include "base/mesh/index_range.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include <fmt/core.h>

namespace octafront::improve {

namespace {

/// Fewer would have more of their elements at rims, more share less well among threads.
constexpr std::size_t kMostVerticesOfCell = 8192;

/// Room for the slots that blocks will ask for: otherwise the first to ask has the whole mesh copied.
constexpr std::size_t kMeshRoomPart = 16, kLeastRoom = 1024;

/// To `size`, with room for some more: by itself a vector would double.
template <class Item>
void grow(std::vector<Item>& items, std::size_t size, const std::type_identity_t<Item>& fresh) {
  if (size > items.capacity()) items.reserve(size + size / kMeshRoomPart);
  items.resize(size, fresh);
}

void renumber_faces(TetMesh& mesh, const std::vector<VertexIndex>& new_of_old) {
  for (std::vector<Triangle>* faces : {&mesh.boundary, &mesh.interfaces})
    for (Triangle& t : *faces)
      for (VertexIndex& v : t) v = new_of_old[v];
}

/// Calls visit(t, shape) for the tets begin ... end - 1.
template <class Visit>
void for_each_shape(const std::vector<Vec3>& points, const std::vector<Tet>& tets, ImproveOptions::Objective objective,
                    std::size_t begin, std::size_t end, const Visit& visit) {
  ShapeBatch batch(objective);
  for (std::size_t first = begin; first < end; first += ShapeBatch::kBatch) {
    batch.size = 0;
    for (std::size_t t = first; t < std::min<std::size_t>(end, first + ShapeBatch::kBatch); ++t) {
      const Tet& c = tets[t];
      batch.add(points[c[0]], points[c[1]], points[c[2]], points[c[3]]);
    }
    batch.evaluate();
    for (int i = 0; i < batch.size; ++i) visit(first + static_cast<std::size_t>(i), batch.shape(i));
  }
}

/// The numbers of the tets in ascending order of their keys; free slots, whose corners are kNone, are none.
Groups<> order_by_key(const std::vector<Tet>& tets, std::size_t vertices) {
  static_assert(kNone == kNoOwner);
  Groups<> by_corner = group_by_owner(vertices, static_cast<TetIndex>(tets.size()), [&](TetIndex t) {
    return std::min({tets[t][0], tets[t][1], tets[t][2], tets[t][3]});
  });
  parallel_for(by_corner.size(), [&](std::size_t v) {
    std::ranges::sort(by_corner[v], [&](TetIndex s, TetIndex t) { return tet_key(tets[s]) < tet_key(tets[t]); });
  });
  return by_corner;
}

}  // namespace

EditMesh::EditMesh(TetMesh&& mesh, ImproveOptions::Objective objective) : objective_(objective) {
  require_in_range(mesh.tets.size(), kMostTetsToImprove, "tetrahedra to improve");
  take(mesh);
  rest_ = std::move(mesh);
  connect();
  compute_shapes();
}

void EditMesh::take(TetMesh& mesh) {
  original_ = spatial_order(mesh.points);
  std::vector<VertexIndex> new_of_old(mesh.points.size());
  points_.reserve(mesh.points.size());
  for (VertexIndex v = 0; v < original_.size(); ++v) {
    new_of_old[original_[v]] = v;
    points_.push_back(mesh.points[original_[v]]);
  }
  divide_in_cells();
  parallel_for(mesh.tets.size(), [&](std::size_t t) {
    for (VertexIndex& v : mesh.tets[t]) v = new_of_old[v];
  });
  renumber_faces(mesh, new_of_old);
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
  mesh.tets = std::vector<Tet>();
  mesh.points = std::vector<Vec3>();
}

void EditMesh::divide_in_cells() {
  Box3 box;
  for (const Vec3& p : points_) box.add(p);
  for (int stage = 0; stage < kCellStages; ++stage)
    cells_[stage] = cells_of(points_, cube_of_stage(box, stage), kMostVerticesOfCell);
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
  const auto& across = complex_.across;
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

std::vector<VertexIndex> EditMesh::numbers_taken() const {
  const std::vector<VertexIndex> here = numbers_here();
  std::vector<VertexIndex> taken;
  for (VertexIndex v = 0; v < points_.size(); ++v)
    if (complex_.tet_at[v < here.size() ? here[v] : v] != kNone) taken.push_back(v < here.size() ? v : kNone);
  return taken;
}

void EditMesh::remember() {
  taken_.emplace(Taken{points_, std::vector<std::uint8_t>(slots(), 1), {}, {}, rest_});
}

TetMesh EditMesh::taken() {
  TetMesh mesh = std::move(taken_->rest);
  mesh.points.resize(original_.size());
  for (VertexIndex v = 0; v < original_.size(); ++v) mesh.points[original_[v]] = taken_->points[v];
  std::vector<Tet> tets = std::move(taken_->gone);
  std::vector<std::uint32_t> region = std::move(taken_->region_of_gone);
  for (TetIndex t = 0; t < slots(); ++t) {
    if (!taken_->is_there[t]) continue;
    tets.push_back(complex_.tets[t]);
    if (had_regions_) region.push_back(region_[t]);
  }
  const Groups<> order = order_by_key(tets, points_.size());
  mesh.tets.resize(tets.size());
  mesh.region.resize(region.size());
  parallel_for(tets.size(), [&](std::size_t k) {
    for (int i = 0; i < 4; ++i) mesh.tets[k][i] = original_[tets[order.items()[k]][i]];
    if (had_regions_) mesh.region[k] = region[order.items()[k]];
  });
  renumber_faces(mesh, original_);
  return mesh;
}

bool EditMesh::moved_boundary() const {
  const std::vector<Triangle>& was = taken_->rest.boundary;
  return rest_.boundary != was || std::any_of(was.begin(), was.end(), [&](const Triangle& t) {
           return std::any_of(t.begin(), t.end(), [&](VertexIndex v) { return points_[v] != taken_->points[v]; });
         });
}

TetMesh EditMesh::release() {
  taken_.reset();
  TetMesh mesh = std::move(rest_);
  // Vertices go back to where they were; those that improvement added follow.
  std::vector<VertexIndex> here = numbers_here();
  for (auto v = static_cast<VertexIndex>(here.size()); v < points_.size(); ++v) here.push_back(v);
  std::vector<VertexIndex> new_of_old(points_.size(), kNone);
  for (const VertexIndex v : here)
    if (complex_.tet_at[v] != kNone) {
      new_of_old[v] = static_cast<VertexIndex>(mesh.points.size());
      mesh.points.push_back(points_[v]);
    }
  complex_.across = std::vector<HalfFace>();
  shapes_ = std::vector<Shape>();
  const Groups<> order = order_by_key(complex_.tets, points_.size());
  const std::vector<TetIndex>& kept = order.items();
  mesh.tets.resize(kept.size());
  if (had_regions_) mesh.region.resize(kept.size());
  parallel_for(kept.size(), [&](std::size_t k) {
    for (int i = 0; i < 4; ++i) mesh.tets[k][i] = new_of_old[complex_.tets[kept[k]][i]];
    if (had_regions_) mesh.region[k] = region_[kept[k]];
  });
  complex_.tets = std::vector<Tet>();
  drop_removed_triangles(mesh);
  renumber_faces(mesh, new_of_old);
  return mesh;
}

void EditMesh::drop_removed_triangles(TetMesh& mesh) {
  const auto last_into = [](auto& list, std::size_t t) {
    if (list.empty()) return;
    list[t] = list.back();
    list.pop_back();
  };
  for (std::size_t t = mesh.boundary.size(); t-- > 0;) {
    if (mesh.boundary[t][0] != kNone) continue;
    last_into(mesh.boundary, t);
    last_into(mesh.patch, t);
    last_into(mesh.source, t);
  }
}

void EditMesh::move(VertexIndex v, Vec3 to, std::span<const HalfFace> star_faces, const ShapeBatch& shapes) {
  points_[v] = to;
  for (std::size_t k = 0; k < star_faces.size(); ++k) shapes_[star_faces[k] / 4] = shapes.shape(static_cast<int>(k));
  for (std::size_t k = 0; kValidate && k < star_faces.size(); ++k) validate(*this, std::array{star_faces[k] / 4});
}

std::vector<VertexIndex> EditMesh::numbers_here() const {
  std::vector<VertexIndex> here(original_.size());
  for (VertexIndex v = 0; v < original_.size(); ++v) here[original_[v]] = v;
  return here;
}

void EditMesh::reserve_tets(std::size_t more) {
  const std::size_t first = complex_.tets.size(), last = first + more;
  grow(complex_.tets, last, {kNone, kNone, kNone, kNone});
  grow(complex_.across, 4 * last, kNone);
  grow(shapes_, last, kNoShape);
  if (had_regions_) grow(region_, last, 0);
  if (taken_) grow(taken_->is_there, last, 0);
  for (std::size_t t = last; t-- > first;) complex_.free.push_back(static_cast<TetIndex>(t));
}

void EditMesh::reserve_points(std::size_t more) {
  const std::size_t first = points_.size(), last = first + more;
  points_.resize(last);
  complex_.tet_at.resize(last, kNone);
  on_boundary_.resize(last, 0);
  for (Cells& cells : cells_) cells.of.resize(last, 0);
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
    Floor f;
    for (std::size_t t = begin; t < end; ++t) f.add(shapes_[t]);
    return f;
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

void EditMesh::sort_by_name(std::span<TetIndex> tets) const {
  std::vector<std::pair<Tet, TetIndex>> named(tets.size());
  for (std::size_t k = 0; k < tets.size(); ++k) named[k] = {tet_key(tet(tets[k])), tets[k]};
  std::sort(named.begin(), named.end());
  for (std::size_t k = 0; k < tets.size(); ++k) tets[k] = named[k].second;
}

void EditMesh::sort_star(std::span<HalfFace> star) const {
  // Without the corner that all have in common names keep their order.
  struct Named {
    std::uint64_t low;
    VertexIndex high;
    HalfFace face;
    bool operator<(const Named& o) const { return low != o.low ? low < o.low : high < o.high; }
  };
  constexpr std::size_t kMost = ShapeBatch::kBatch;  // others are not worked on
  if (star.size() > kMost) return;
  std::array<Named, kMost> named;
  for (std::size_t k = 0; k < star.size(); ++k) {
    const Triangle key = face_key(complex_.face(star[k]));
    named[k] = {std::uint64_t{key[0]} << 32 | key[1], key[2], star[k]};
  }
  const auto end = named.begin() + static_cast<std::ptrdiff_t>(star.size());
  if (std::is_sorted(named.begin(), end)) return;
  std::sort(named.begin(), end);
  for (std::size_t k = 0; k < star.size(); ++k) star[k] = named[k].face;
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
