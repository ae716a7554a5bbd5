#include "fill/front/work_mesh.h"

#include "base/core/disjoint_sets.h"
#include "base/core/parallel.h"
#include "base/core/validate.h"
#include "base/geometry/predicates.h"
#include "base/mesh/face_table.h"
#include "fill/front/open_edge.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace octafront {

namespace {

constexpr std::size_t kTetsPerTask = 1 << 16;

/// The cells of a coarse grid that boxes reach into, however many these are: counted at the corners of each box, and
/// summed up along the axes.
class CoveredCells {
 public:
  CoveredCells(const std::vector<Vec3>& points, const std::vector<Box3>& boxes) : count_(kSide * kSide * kSide, 0) {
    for (const Vec3& p : points) domain_.add(p);
    for (const Box3& box : boxes) add(box);
    for (const std::size_t step : {std::size_t{1}, kSide, kSide * kSide})
      for (std::size_t i = step; i < count_.size(); ++i)
        if (i / step % kSide != 0) count_[i] += count_[i - step];
  }

  bool contain(Vec3 p) const { return count_[place(cell(p.x, 0), cell(p.y, 1), cell(p.z, 2))] != 0; }

 private:
  static constexpr std::size_t kSide = 64;

  static std::size_t place(std::size_t x, std::size_t y, std::size_t z) { return (z * kSide + y) * kSide + x; }

  std::size_t cell(double at, int axis) const {
    const double extent = domain_.extent()[axis];
    const double part = extent > 0 ? (at - domain_.lo[axis]) / extent : 0;
    return static_cast<std::size_t>(std::clamp(part * kSide, 0.0, kSide - 1.0));
  }

  void add(const Box3& box) {
    std::array<std::array<std::size_t, 2>, 3> range;  // from the first cell to behind the last one
    for (int axis = 0; axis < 3; ++axis) range[axis] = {cell(box.lo[axis], axis), cell(box.hi[axis], axis) + 1};
    for (int corner = 0; corner < 8; ++corner) {
      const std::size_t x = range[0][corner & 1], y = range[1][corner >> 1 & 1], z = range[2][corner >> 2];
      if (x == kSide || y == kSide || z == kSide) continue;
      count_[place(x, y, z)] += std::popcount(static_cast<unsigned>(corner)) % 2 == 0 ? 1 : -1;
    }
  }

  Box3 domain_;
  std::vector<std::int32_t> count_;
};

}  // namespace

std::vector<std::uint8_t> near_boxes(const std::vector<Vec3>& points, const std::vector<Box3>& boxes) {
  std::vector<std::uint8_t> is_near(points.size());
  const CoveredCells covered(points, boxes);
  parallel_for(points.size(), [&](std::size_t v) { is_near[v] = covered.contain(points[v]); });
  return is_near;
}

WorkMesh::WorkMesh(std::vector<Vec3> points, std::vector<Tet> tets, const std::vector<Box3>& focus,
                   const std::vector<Triangle>& two_sided, Holds holds)
    : points_(std::move(points)),
      tets_(std::move(tets)),
      original_tets_(tets_.size()),
      holds_(holds),
      alive_(tets_.size(), true),
      indexed_(points_.size(), 1) {
  if (!focus.empty()) indexed_ = near_boxes(points_, focus);
  for (const Triangle& t : two_sided) two_sided_.insert(face_key(t));
  index_tets();
}

void WorkMesh::index_tets() const {
  std::vector<std::vector<std::pair<VertexIndex, TetIndex>>> found((original_tets_ + kTetsPerTask - 1) / kTetsPerTask);
  parallel_for(found.size(), [&](std::size_t task) {
    const std::size_t end = std::min((task + 1) * kTetsPerTask, original_tets_);
    for (std::size_t t = task * kTetsPerTask; t < end; ++t)
      for (const VertexIndex v : tets_[t])
        if (indexed_[v]) found[task].emplace_back(v, static_cast<TetIndex>(t));
  });
  incident_ = {indexed_.size(), [&](const auto& add) {
                 for (const auto& part : found)
                   for (const auto& [v, t] : part) add(v, t);
               }};
}

VertexIndex WorkMesh::add_point(Vec3 p) {
  points_.push_back(p);
  return static_cast<VertexIndex>(points_.size() - 1);
}

TetIndex WorkMesh::add(const Tet& tet) {
  const auto id = static_cast<TetIndex>(tets_.size());
  tets_.push_back(tet);
  alive_.push_back(true);
  for (const VertexIndex v : tet) added_[v].push_back(id);
  validate(*this, id);
  return id;
}

std::vector<TetIndex> WorkMesh::around(VertexIndex v) const {
  std::vector<TetIndex> found;
  if (v < indexed_.size()) {
    if (!indexed_[v]) {
      if (holds_ == Holds::kFocus) throw BeyondPart{};
      std::fill(indexed_.begin(), indexed_.end(), std::uint8_t{1});
      index_tets();
    }
    for (const TetIndex t : incident_[v])
      if (alive_[t]) found.push_back(t);
  }
  if (const auto it = added_.find(v); it != added_.end())
    for (const TetIndex t : it->second)
      if (alive_[t]) found.push_back(t);
  return found;
}

TetIndex WorkMesh::tet_behind(const Triangle& outward) const {
  for (const TetIndex t : around(outward[0])) {
    const Tet& tet = tets_[t];
    for (const auto& f : kTetFaces)
      for (int k = 0; k < 3; ++k)
        if (tet[f[k]] == outward[0] && tet[f[(k + 1) % 3]] == outward[1] && tet[f[(k + 2) % 3]] == outward[2]) return t;
  }
  return kNone;
}

std::optional<std::string> WorkMesh::first_inconsistency(TetIndex t) const {
  if (!alive_[t]) return std::nullopt;
  const std::string name = "tetrahedron " + std::to_string(t);
  const auto& [a, b, c, d] = tets_[t];
  for (const VertexIndex v : tets_[t]) {
    if (v >= points_.size()) return name + " has a corner that is no vertex";
    const std::vector<TetIndex> here = around(v);
    if (std::find(here.begin(), here.end(), t) == here.end()) return name + " is not listed at its corners";
  }
  if (orient3d(at(a), at(b), at(c), at(d)) <= 0) return name + " is not positive";
  for (int i = 0; i < 4; ++i)
    if (tet_behind(face_of(tets_[t], i)) != t) return name + " shares a side of a face with another";
  return std::nullopt;
}

std::optional<std::string> WorkMesh::first_inconsistency() const {
  if (alive_.size() != tets_.size()) return "the work mesh does not know which tetrahedra live";
  for (TetIndex t = 0; t < tets_.size(); ++t)
    if (auto wrong = first_inconsistency(t)) return wrong;
  return std::nullopt;
}

std::vector<Tet> WorkMesh::take_tets() {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < tets_.size(); ++t)
    if (alive_[t]) tets_[kept++] = tets_[t];
  tets_.resize(kept);
  alive_.clear();
  incident_ = {};
  added_.clear();
  return std::move(tets_);
}

Cavities::Cavities(const std::vector<Wall>& walls) {
  DisjointSets sets(walls.size());
  FlatMap<Edge, std::uint32_t> wall_at_edge(2 * walls.size());
  for (std::uint32_t w = 0; w < walls.size(); ++w)
    for (int i = 0; i < 3; ++i) {
      const VertexIndex a = walls[w][i], b = walls[w][(i + 1) % 3];
      sets.join(w, wall_at_edge.find_or_add({std::min(a, b), std::max(a, b)}, w));
    }
  std::vector<std::uint32_t> number(walls.size(), kNone);
  for (std::uint32_t w = 0; w < walls.size(); ++w) {
    std::uint32_t& n = number[sets.find(w)];
    if (n == kNone) {
      n = static_cast<std::uint32_t>(walls_.size());
      walls_.emplace_back();
    }
    walls_[n].push_back(walls[w]);
    owner_[is_even(walls[w])].find_or_add(face_key(walls[w])) = n;
  }
  validate(*this);
}

std::uint32_t Cavities::owner(const Triangle& wall) const {
  for (const auto& owner : owner_)
    if (const std::uint32_t* cavity = owner.find(face_key(wall))) return *cavity;
  return kNone;
}

void Cavities::close(std::size_t cavity) {
  for (const Wall& w : walls_[cavity]) owner_[is_even(w)].erase(face_key(w));
  walls_[cavity].clear();
}

std::optional<std::string> Cavities::first_inconsistency() const {
  for (std::uint32_t c = 0; c < walls_.size(); ++c) {
    if (auto wrong = why_not_closed(walls_[c], "the walls of cavity " + std::to_string(c))) return wrong;
    for (const Wall& w : walls_[c])
      if (const std::uint32_t* own = owner_[is_even(w)].find(face_key(w)); own == nullptr || *own != c)
        return "cavity " + std::to_string(c) + " does not own its walls";
  }
  return std::nullopt;
}

}  // namespace octafront
