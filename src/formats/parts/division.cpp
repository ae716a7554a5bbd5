#include "formats/parts/division.h"

#include <octafront/error.h>

#include "base/core/hilbert.h"
#include "base/core/parallel.h"
#include "base/mesh/adjacency.h"

#include <algorithm>
#include <limits>

#include <fmt/core.h>

namespace octafront::io {
namespace {

/// The elements of a mesh: tetrahedra, of wedges and pyramids the first one.
class Elements {
 public:
  explicit Elements(const TetMesh& mesh) : mesh_(mesh) {
    if (mesh.wide_cells.empty()) return;
    std::vector<bool> follows(mesh.tets.size(), false);
    for (const WideCell& cell : mesh.wide_cells)
      std::fill_n(follows.begin() + cell.first + 1, cell.tet_count - 1, true);
    for (TetIndex t = 0; t < mesh.tets.size(); ++t) {
      if (!follows[t]) first_.push_back(t);
      of_.push_back(static_cast<std::uint32_t>(first_.size() - 1));
    }
  }

  std::size_t size() const { return first_.empty() ? mesh_.tets.size() : first_.size(); }
  std::uint32_t of(TetIndex t) const { return of_.empty() ? t : of_[t]; }
  TetIndex begin(std::size_t e) const { return first_.empty() ? static_cast<TetIndex>(e) : first_[e]; }
  TetIndex end(std::size_t e) const {
    return e + 1 == size() ? static_cast<TetIndex>(mesh_.tets.size()) : begin(e + 1);
  }

  Vec3 center(std::size_t e) const {
    Vec3 sum;
    for (TetIndex t = begin(e); t < end(e); ++t)
      for (const VertexIndex v : mesh_.tets[t]) sum += mesh_.points[v];
    return sum * (0.25 / static_cast<double>(end(e) - begin(e)));
  }

 private:
  const TetMesh& mesh_;
  std::vector<TetIndex> first_;    ///< empty: all are tetrahedra
  std::vector<std::uint32_t> of_;  ///< per tetrahedron
};

struct BoxSum {
  Box3 box;
  void operator+=(const BoxSum& other) { box.add(other.box); }
};

Box3 box_of(const std::vector<Vec3>& points) {
  return parallel_sum(points.size(),
                      [&](std::size_t begin, std::size_t end) {
                        BoxSum sum;
                        for (std::size_t v = begin; v < end; ++v) sum.box.add(points[v]);
                        return sum;
                      })
      .box;
}

std::vector<std::uint32_t> along_curve(const TetMesh& mesh, const Elements& elements, std::uint32_t parts) {
  const Box3 box = box_of(mesh.points);
  const Vec3 extent = box.extent();
  const double side = std::max({extent.x, extent.y, extent.z});
  const double scale = side > 0 ? 2097151 / side : 0;  // 21 bits
  struct Key {
    std::uint64_t code;
    std::uint32_t element;
    bool operator<(const Key& o) const { return code != o.code ? code < o.code : element < o.element; }
  };
  std::vector<Key> keys(elements.size());
  parallel_for(keys.size(), [&](std::size_t e) {
    const Vec3 p = (elements.center(e) - box.lo) * scale;
    keys[e] = {hilbert_code(
                   {static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y), static_cast<std::uint32_t>(p.z)}),
               static_cast<std::uint32_t>(e)};
  });
  parallel_sort(keys);
  std::vector<std::uint32_t> part(keys.size());
  parallel_for(keys.size(), [&](std::size_t k) {
    part[keys[k].element] = static_cast<std::uint32_t>(std::uint64_t{k} * parts / keys.size());
  });
  return part;
}

std::vector<std::uint32_t> by_graph(const TetMesh& mesh, const Elements& elements, std::uint32_t parts) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max() / 4;
  if (mesh.tets.size() > kMost)
    throw OptionError(
        fmt::format("METIS counts with 32 bits, too few for {} elements; divide along the curve", mesh.tets.size()));
  if (parts == 1 || parts >= elements.size()) return along_curve(mesh, elements, parts);
  const std::vector<HalfFace> across = half_face_neighbors(mesh.tets, mesh.points.size());
  std::vector<std::int32_t> first{0}, next;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (HalfFace h = 4 * elements.begin(e); h < 4 * elements.end(e); ++h)
      if (across[h] != kNone && elements.of(across[h] / 4) != e)
        next.push_back(static_cast<std::int32_t>(elements.of(across[h] / 4)));
    // A quadrilateral is two faces between the same two.
    std::sort(next.begin() + first.back(), next.end());
    next.erase(std::unique(next.begin() + first.back(), next.end()), next.end());
    first.push_back(static_cast<std::int32_t>(next.size()));
  }
  std::vector<std::uint32_t> part = divide_graph(std::move(first), std::move(next), parts);
  std::vector<bool> has_some(parts, false);
  for (const std::uint32_t p : part) has_some[p] = true;
  if (const auto empty = std::count(has_some.begin(), has_some.end(), false); empty > 0)
    throw OptionError(
        fmt::format("METIS leaves {} of {} parts empty, where parts have so few elements; ask for fewer, or "
                    "divide along the curve",
                    empty, parts));
  return part;
}

}  // namespace

Division divide(const TetMesh& mesh, std::uint32_t parts, Partitioner partitioner) {
  if (parts == 0) throw OptionError("a mesh is divided into 1 part or more, not 0");
  const Elements elements(mesh);
  if (parts > elements.size())
    throw OptionError(
        fmt::format("{} parts are more than the {} elements of the mesh: some would be empty; ask for "
                    "fewer, or a finer mesh",
                    parts, elements.size()));
  Division division{
      parts, partitioner == Partitioner::kMetis ? by_graph(mesh, elements, parts) : along_curve(mesh, elements, parts)};
  if (mesh.wide_cells.empty()) return division;
  std::vector<std::uint32_t> part(mesh.tets.size());
  for (TetIndex t = 0; t < part.size(); ++t) part[t] = division.part[elements.of(t)];
  division.part = std::move(part);
  return division;
}

DivisionCost cost_of(const TetMesh& mesh, const Division& division) {
  const Elements elements(mesh);
  std::vector<std::size_t> count(division.parts, 0);
  for (std::size_t e = 0; e < elements.size(); ++e) ++count[division.part[elements.begin(e)]];
  DivisionCost cost;
  cost.least = *std::min_element(count.begin(), count.end());
  cost.most = *std::max_element(count.begin(), count.end());
  const std::vector<HalfFace> across = half_face_neighbors(mesh.tets, mesh.points.size());
  for (HalfFace h = 0; h < across.size(); ++h)
    cost.cut += across[h] != kNone && across[h] > h && division.part[h / 4] != division.part[across[h] / 4];
  return cost;
}

}  // namespace octafront::io
