#include "base/shared/shared_tets.h"

#include "base/mesh/mesh_share.h"
#include "base/mesh/renumber_mesh.h"
#include "base/shared/in_parts.h"
#include "base/shared/marks.h"
#include "base/shared/shares.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

namespace octafront {

namespace {

/// Of each rank the number of items, and where they begin among all.
std::vector<std::size_t> begins(std::size_t mine, const Comm& comm) {
  std::vector<std::int64_t> size(static_cast<std::size_t>(comm.size()), 0);
  size[static_cast<std::size_t>(comm.rank())] = static_cast<std::int64_t>(mine);
  comm.sum(size, "sizes of shares");
  std::vector<std::size_t> begin{0};
  for (const std::int64_t n : size) begin.push_back(begin.back() + static_cast<std::size_t>(n));
  return begin;
}

/// Puts parts of lists in the order of ranks into one that has room for all.
template <class Item>
auto into(std::vector<Item>& all, std::vector<std::size_t>& begin) {
  return [&](int rank, std::span<const Item> part) {
    std::size_t& at = begin[static_cast<std::size_t>(rank)];
    std::copy(part.begin(), part.end(), all.begin() + static_cast<std::ptrdiff_t>(at));
    at += part.size();
  };
}

/// All in one list, that of rank 0 first.
template <class Item>
std::vector<Item> gathered(const std::vector<Item>& share, const Comm& comm) {
  std::vector<std::size_t> begin = begins(share.size(), comm);
  std::vector<Item> all;
  comm.attempt("shares", Comm::Telling::kNamesRank, [&] { all.resize(begin.back()); });
  gather_in_parts(comm, share, "shares", into(all, begin));
  return all;
}

template <class Item>
void gather_at_first(std::vector<Item>& share, const Comm& comm) {
  std::vector<std::size_t> begin = begins(share.size(), comm);
  std::vector<std::vector<Item>> out(static_cast<std::size_t>(comm.size()));
  if (comm.rank() == 0)
    comm.attempt("shares", Comm::Telling::kNamesRank, [&] { share.resize(begin.back()); });
  else
    out[0] = std::exchange(share, {});
  exchange_in_parts(comm, std::move(out), "shares", into(share, begin));
}

template <class Item>
void keep_stretch(std::vector<Item>& items, const Comm& comm) {
  const auto ranks = static_cast<std::size_t>(comm.size());
  const auto begin = [&](std::size_t rank) {
    return items.begin() + static_cast<std::ptrdiff_t>(begin_of_stretch(rank, ranks, items.size()));
  };
  const auto rank = static_cast<std::size_t>(comm.rank());
  items = std::vector<Item>(begin(rank), begin(rank + 1));
}

}  // namespace

TetCounts count_tets(const TetMesh& mesh, const Comm& comm) {
  const auto mine = static_cast<std::int64_t>(mesh.tets.size());
  std::array<std::int64_t, 1> all{mine};
  comm.sum(all, "numbers of elements");
  return {static_cast<std::uint64_t>(all[0]), static_cast<std::uint64_t>(comm.before(mine, "numbers of elements"))};
}

void keep_share(TetMesh& mesh, const Comm& comm) {
  if (comm.alone()) return;
  keep_stretch(mesh.tets, comm), keep_stretch(mesh.region, comm);
}

void gather_tets(TetMesh& mesh, const Comm& comm) {
  if (comm.alone()) return;
  mesh.tets = gathered(mesh.tets, comm);
  mesh.region = gathered(mesh.region, comm);
}

void gather_tets_at_first(TetMesh& mesh, const Comm& comm) {
  if (comm.alone()) return;
  gather_at_first(mesh.tets, comm), gather_at_first(mesh.region, comm);
}

void drop_unused_points(TetMesh& mesh, std::size_t kept, const Comm& comm) {
  if (comm.alone()) return drop_unused_points(mesh, kept);
  std::vector<std::uint8_t> is_used = vertices_in_use(mesh);
  std::fill_n(is_used.begin(), kept, std::uint8_t{1});
  join_marks(comm, is_used, "vertices in use");
  std::vector<VertexIndex> number(mesh.points.size(), kNone);
  for (std::size_t v = 0; v < number.size(); ++v)
    if (is_used[v] != 0) number[v] = 0;
  keep_numbered(mesh.points, number);
  renumber_vertices(mesh, number);
}

void join_sets(DisjointSets& sets, std::size_t count, const Comm& comm) {
  if (comm.alone()) return;
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (std::uint32_t i = 0; i < count; ++i)
    if (const std::uint32_t first = sets.find(i); first != i) pairs.push_back({i, first});
  gather_in_parts(comm, pairs, "sets", [&](int, std::span<const std::array<std::uint32_t, 2>> part) {
    for (const auto& [i, j] : part) sets.join(i, j);
  });
}

}  // namespace octafront
