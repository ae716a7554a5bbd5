#include "fill/front/fill.h"

#include <octafront/error.h>

#include "base/core/disjoint_sets.h"
#include "base/core/morton.h"
#include "base/core/parallel.h"
#include "base/core/stage_timer.h"
#include "base/geometry/sight_line.h"
#include "base/mesh/complex.h"
#include "base/mesh/renumber_mesh.h"
#include "base/shared/packing.h"
#include "fill/front/advance.h"
#include "fill/front/bind_to_surface.h"
#include "fill/front/ladder.h"
#include "fill/lattice/core.h"
#include "fill/recovery/recover.h"
#include "fill/recovery/refine.h"

#include <algorithm>
#include <array>
#include <exception>
#include <span>
#include <utility>

namespace octafront {

namespace {

/// The triangles in an order that follows space and not the input's numbering: along a Morton curve through their
/// centroids, so that the front's first layer, and with it the memory, is local.
std::vector<std::uint32_t> spatial_order(const SurfaceMesh& surface, const Box3& box) {
  const Vec3 e = box.extent();
  const double scale = 1048575.0 / std::max({e.x, e.y, e.z, 1e-300});
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(surface.triangles.size());
  parallel_for(keyed.size(), [&](std::size_t t) {
    const auto& [a, b, c] = surface.triangles[t];
    const Vec3 m = ((surface.points[a] + surface.points[b] + surface.points[c]) / 3 - box.lo) * scale;
    keyed[t] = {
        morton_code(static_cast<std::uint64_t>(m.x), static_cast<std::uint64_t>(m.y), static_cast<std::uint64_t>(m.z)),
        static_cast<std::uint32_t>(t)};
  });
  parallel_sort(keyed);
  std::vector<std::uint32_t> order;
  order.reserve(keyed.size());
  for (const auto& [key, t] : keyed) order.push_back(t);
  return order;
}

FrontState start_front(const SurfaceMesh& surface, const SizeField& sizes) {
  FrontState front;
  front.domain = bounding_box(surface.points);
  front.finest_size = sizes.min_size();
  front.regions = region_count(surface);
  front.points = surface.points;
  front.queue.reserve(surface.triangles.size());
  for (const std::uint32_t t : spatial_order(surface, front.domain)) {
    const auto& [a, b, c] = surface.triangles[t];
    const auto [ahead, behind] = surface.sides_of(t);
    if (behind != kNone) front.queue.push_back({{{a, c, b}, behind}});
    if (ahead != kNone) front.queue.push_back({{{a, b, c}, ahead}});
  }
  return front;
}

/// The region around each point of the core of a complex. The core touches no wall, so each part of it that hangs
/// together lies in one, which a line of sight finds.
std::vector<std::uint32_t> regions_of_core(const LatticeCore& core, const SurfaceMesh& surface, const Comm& comm) {
  DisjointSets parts(core.points.size());
  for (const Tet& t : core.tets)
    for (int i = 1; i < 4; ++i) parts.join(t[0], t[i]);
  join_sets(parts, core.points.size(), comm);
  const SightLines lines(surface.points, surface.triangles);
  std::vector<std::uint32_t> region(core.points.size(), kNone);
  for (VertexIndex v = 0; v < region.size(); ++v) {
    std::uint32_t& of_part = region[parts.find(v)];
    if (of_part == kNone) {
      const std::optional<Side> side = lines.first_side(core.points[v], 0);
      if (side) of_part = surface.sides_of(triangle_of(*side))[*side % 2];
    }
    region[v] = of_part;
  }
  return region;
}

/// Puts the core's tetrahedra in place, and its skin, which the front has to meet.
void add_core(FrontState& front, LatticeCore core, const SurfaceMesh& surface, const Comm& comm) {
  const std::vector<std::uint32_t> region =
      front.regions > 1 ? regions_of_core(core, surface, comm) : std::vector<std::uint32_t>(core.points.size(), 0);
  const auto first = static_cast<VertexIndex>(front.points.size());
  front.points.insert(front.points.end(), core.points.begin(), core.points.end());
  parallel_for(core.tets.size(), [&](std::size_t t) {
    for (VertexIndex& v : core.tets[t]) v += first;
  });
  front.passive.resize(core.skin.size());
  parallel_for(core.skin.size(), [&](std::size_t s) {
    const auto& [a, b, c] = core.skin[s];
    front.passive[s] = {{a + first, c + first, b + first}, region[a]};
  });
  std::array<std::int64_t, 1> tets{static_cast<std::int64_t>(core.tets.size())};
  comm.sum(tets, "core");
  front.work.tets = static_cast<std::size_t>(tets[0]);
  if (comm.alone()) return front.filled.push_back({std::move(core.tets)});
  for (int rank = 0; rank < comm.size(); ++rank) front.filled.push_back({{}, rank});
  front.filled[static_cast<std::size_t>(comm.rank())].tets = std::move(core.tets);
}

void set_sizes(FrontState& front, const SizeField& sizes) {
  front.sizes.resize(front.points.size());
  parallel_for(front.points.size(),
               [&](std::size_t v) { front.sizes[v] = static_cast<float>(sizes.at(front.points[v])); });
}

constexpr std::size_t kPiecesAtOnce = 256;

/// One array: that of the first piece, the core, if it has room. Some pieces at a time, which are freed then: not all
/// are there twice.
std::vector<Tet> put_together(std::vector<FilledPiece>& pieces) {
  if (pieces.empty()) return {};
  std::size_t all = 0;
  for (const FilledPiece& piece : pieces) all += piece.tets.size();
  std::vector<Tet> tets = std::move(pieces[0].tets);
  tets.reserve(all);
  for (std::size_t first = 1; first < pieces.size(); first += kPiecesAtOnce) {
    const std::span<FilledPiece> some(pieces.data() + first, std::min(kPiecesAtOnce, pieces.size() - first));
    std::vector<std::size_t> to;
    std::size_t end = tets.size();
    for (const FilledPiece& piece : some) to.push_back(std::exchange(end, end + piece.tets.size()));
    parallel_resize(tets, end);
    parallel_for(some.size(), [&](std::size_t i) {
      const std::vector<Tet> piece = std::move(some[i].tets);
      std::copy(piece.begin(), piece.end(), tets.begin() + static_cast<std::ptrdiff_t>(to[i]));
    });
  }
  return tets;
}

/// The pieces one after the other, in one array: those of this rank. What every rank made is the first one's.
FrontTets joined(std::vector<FilledPiece>& pieces, const Comm& comm) {
  std::vector<std::int64_t> size;
  for (FilledPiece& piece : pieces) {
    if (comm.rank() != 0 && piece.rank == FilledPiece::kEveryRank) piece.tets = {};
    size.push_back(static_cast<std::int64_t>(piece.tets.size()));
  }
  FrontTets share;
  std::vector<std::size_t> first(pieces.size() + 1, 0);
  for (std::size_t i = 0; i < pieces.size(); ++i) first[i + 1] = first[i] + pieces[i].tets.size();
  comm.sum(size, "tetrahedra of the front");
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < pieces.size(); number += static_cast<std::uint64_t>(size[i++]))
    if (!pieces[i].tets.empty()) share.stretches.push_back({first[i], number});
  share.tets = put_together(pieces);
  return share;
}

/// All tetrahedra of all ranks, in the order in which a process alone leaves them.
std::vector<Tet> gathered(FrontTets share, const Comm& comm) {
  if (comm.alone()) return std::move(share.tets);
  std::vector<NumberedTet> all;
  for (std::size_t t = 0; t < share.tets.size(); ++t) all.push_back({share.number(t), share.tets[t]});
  share = {};
  all = gathered_lists(comm, all, "tetrahedra of the front");
  std::vector<Tet> tets(all.size());
  parallel_for(all.size(), [&](std::size_t i) { tets[all[i].number] = all[i].tet; });
  return tets;
}

/// The front fills no more than the surface encloses, up to rounding.
constexpr double kVolumeSlack = 1.0001;

/// Far more than any honest run makes: a guard against fronts that leak.
std::size_t tet_budget(const SurfaceMesh& surface, const SizeField& sizes) {
  const Box3 box = bounding_box(surface.points);
  const Vec3 e = box.extent() / sizes.min_size();
  const double finest = 100 * e.x * e.y * e.z;
  return static_cast<std::size_t>(std::min(4e9, 1e5 + 1000.0 * static_cast<double>(surface.triangles.size()) + finest));
}

void report_front(const Stage& stage, const FrontState& front, const FrontCounters& counters) {
  stage.count("front tetrahedra", static_cast<double>(front.work.tets));
  stage.count("phases", static_cast<double>(front.phases));
  stage.count("attempts", static_cast<double>(counters.attempts));
  stage.count("faces gathered", static_cast<double>(counters.faces_found));
  stage.count("candidates tried", static_cast<double>(counters.candidates));
  stage.count("face tests", static_cast<double>(front.work.face_tests));
  stage.count("exact tests", static_cast<double>(counters.exact_tests));
  stage.count("ideal points", static_cast<double>(counters.ideal_points));
  stage.count("faces deferred", static_cast<double>(counters.deferred));
  stage.count("retries", static_cast<double>(counters.retries));
  stage.count("faces left", static_cast<double>(front.held.size()));
}

TetMesh fill_by_front(const SurfaceMesh& surface, const SizeField& sizes, const VolumeOptions& options,
                      const Stage& stage, Tets tets) {
  const FrontTask task{sizes, options, stage, stage.context().ranks};
  const Comm comm(task.ranks);
  TetMesh mesh;
  FrontTets share;
  std::vector<Wall> walls;
  {
    FrontState front = start_front(surface, sizes);
    if (options.core == VolumeOptions::Core::kLattice) {
      const double start = process_cpu_seconds();
      LatticeCore core = build_lattice_core(surface, sizes, stage.context());
      add_core(front, std::move(core), surface, comm);
      stage.count("core tetrahedra", static_cast<double>(front.work.tets));
      stage.count("core CPU seconds", process_cpu_seconds() - start);
    }
    set_sizes(front, sizes);
    const AdvanceBudget budget{.tets = front.work.tets + tet_budget(surface, sizes),
                               .volume = volume_part(kVolumeSlack * enclosed_volume(surface), front.domain)};
    FrontCounters counters;
    const double start = process_cpu_seconds();
    const bool within_budget = advance_front(front, task, budget, counters);
    stage.count("advance CPU seconds", process_cpu_seconds() - start);
    report_front(stage, front, counters);
    if (!within_budget)
      throw MeshingError("the front made " + std::to_string(front.work.tets) +
                         " tetrahedra without closing; check the surface for self-intersections, or choose a larger "
                         "element size");
    for (const FrontFace& f : front.held) walls.push_back(f.corners);
    mesh.points = std::move(front.points);
    share = joined(front.filled, comm);
  }
  if (comm.alone() || tets == Tets::kAll) {
    mesh.tets = gathered(std::move(share), comm);
    close_cavities(mesh, std::move(walls), surface, task);
    return mesh;
  }
  const bool is_closed = walls.empty();
  close_cavities_of_shares(mesh.points, share, std::move(walls), surface, task);
  mesh.tets = std::move(share.tets);
  if (!is_closed) drop_unused_points(mesh, surface.points.size(), comm);
  return mesh;
}

/// The last rung: no front at all. Throws what stopped the front if recovery fails too.
TetMesh fill_without_front(const SurfaceMesh& surface, const SizeField& sizes, const std::exception_ptr& front_error,
                           const Stage& stage) {
  try {
    StageReport recovery;
    const double start = process_cpu_seconds();
    TetMesh mesh = recover_volume(surface, {stage.context(), recovery});
    const double recovered = process_cpu_seconds();
    refine_interior(mesh, sizes, stage);
    stage.count("whole surface recovery CPU seconds", recovered - start);
    stage.count("points inside CPU seconds", process_cpu_seconds() - recovered);
    return mesh;
  } catch (const MeshingError&) {
    std::rethrow_exception(front_error);
  }
}

}  // namespace

TetMesh fill_volume(const SurfaceMesh& surface, const SizeField& sizes, const VolumeOptions& options,
                    const Stage& stage, Tets tets) {
  if (surface.triangles.empty()) throw InputError("the surface has no triangles: nothing to fill");
  TetMesh mesh;
  std::exception_ptr front_error;
  try {
    mesh = fill_by_front(surface, sizes, options, stage, tets);
  } catch (const MeshingError& error) {
    front_error = std::current_exception();
    stage.note(std::string("the whole volume was filled by recovery, for ") + error.what());
  }
  stage.count("filled by recovery of the whole surface", front_error != nullptr);
  const Comm comm(stage.context().ranks);
  if (front_error) {
    mesh = fill_without_front(surface, sizes, front_error, stage);
    if (tets == Tets::kShare) keep_share(mesh, comm);
  }
  const std::uint64_t made = tets == Tets::kShare ? count_tets(mesh, comm).all : mesh.tets.size();
  stage.count("tetrahedra", static_cast<double>(made));
  bind_to_surface(mesh, surface, tets == Tets::kShare ? comm : Comm(nullptr));
  return mesh;
}

}  // namespace octafront
