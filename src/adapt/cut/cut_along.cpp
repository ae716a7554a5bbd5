#include <octafront/error.h>
#include <octafront/level_set.h>
#include <octafront/second_order.h>
#include <octafront/validity.h>

#include "adapt/cut/cutter.h"
#include "base/core/thread_limit.h"
#include "base/core/wording.h"
#include "base/geometry/measures.h"
#include "base/mesh/adjacency.h"
#include "base/mesh/face_table.h"
#include "base/mesh/labels.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/core.h>

namespace octafront {
namespace {

using adapt::CutState;

void require_cuttable(const TetMesh& mesh, const RunContext& context) {
  if (const auto defect = first_defect(mesh, context))
    throw InputError(fmt::format("the mesh is not valid: {}", *defect));
  if (!mesh.wide_cells.empty() || !mesh.periods.empty() || !mesh.split_faces.empty())
    throw InputError("a mesh with wedges, pyramids, periodic or split faces cannot be cut along a level set");
}

void require_level_sets(std::span<const LevelSet> level_sets, const TetMesh& mesh) {
  if (level_sets.empty()) throw OptionError("there is no level set to cut along");
  for (const LevelSet& set : level_sets) {
    if (set.values.size() != mesh.points.size())
      throw InputError(fmt::format("the level set \"{}\" has {} values, and the mesh {} points", set.name,
                                   set.values.size(), mesh.points.size()));
    for (std::size_t v = 0; v < set.values.size(); ++v)
      if (!std::isfinite(set.values[v]))
        throw InputError(fmt::format("the level set \"{}\" has the value {} at point {}", set.name, set.values[v], v));
    const auto is_called_so = [&](const auto& name) { return name == set.name; };
    if (std::any_of(mesh.region_names.begin(), mesh.region_names.end(), is_called_so))
      throw OptionError(
          fmt::format("the mesh has a region \"{}\": the level set of this name needs another one", set.name));
    if (std::count_if(level_sets.begin(), level_sets.end(), [&](const LevelSet& s) { return s.name == set.name; }) > 1)
      throw OptionError(fmt::format("two level sets are called \"{}\"", set.name));
  }
}

template <class List>
std::vector<std::uint32_t> all_of_list(const List& list) {
  std::vector<std::uint32_t> numbers(list.size());
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

CutState state_of(const TetMesh& linear, std::span<const LevelSet> level_sets) {
  CutState state;
  state.mesh = linear;
  state.old_tet = all_of_list(linear.tets), state.old_edge = all_of_list(linear.curve_edges);
  state.old_node = all_of_list(linear.points);
  state.old_face.resize(linear.boundary.size() + linear.interfaces.size());
  std::iota(state.old_face.begin(), state.old_face.end(), 0u);
  state.inside.assign(linear.tets.size(), kNone);
  for (const LevelSet& set : level_sets) {
    state.values.emplace_back(set.values.begin(),
                              set.values.begin() + static_cast<std::ptrdiff_t>(linear.points.size()));
    for (double& value : state.values.back()) value -= set.level;
  }
  return state;
}

TetMesh linear_part(const TetMesh& mesh) {
  TetMesh linear = mesh;
  make_linear(linear);
  return linear;
}

/// The regions that there are now: old ones, and what of each lies in which level set.
class NewRegions {
 public:
  NewRegions(const CutState& state, const TetMesh& before, std::span<const LevelSet> level_sets)
      : before_(before), level_sets_(level_sets) {
    for (const std::uint32_t r : before.region) old_count_ = std::max(old_count_, r + 1);
    const std::size_t sets = level_sets.size();
    number_.assign(old_count_ * (sets + 1), kNone);
    std::vector<std::uint8_t> is_used(number_.size(), 0);
    for (std::size_t t = 0; t < state.inside.size(); ++t) is_used[key(state, t)] = 1;
    for (std::size_t k = 0; k < number_.size(); ++k)
      if (is_used[k]) number_[k] = static_cast<std::uint32_t>(names_.size()), names_.push_back(name_of(k));
  }

  void enter(const CutState& state, TetMesh& mesh) const {
    mesh.region.resize(mesh.tets.size());
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.region[t] = number_[key(state, t)];
    mesh.region_names = names_;
    // Numbers of a file stand for what the regions were.
    mesh.region_labels.clear();
  }

 private:
  /// Those outside of all level sets first, as they were.
  std::size_t key(const CutState& state, std::size_t t) const {
    const std::size_t set = state.inside[t] == kNone ? 0 : state.inside[t] + 1;
    const std::uint32_t region = before_.region.empty() ? 0 : before_.region[state.old_tet[t]];
    return set * old_count_ + region;
  }
  std::string name_of(std::size_t key) const {
    const std::size_t set = key / old_count_, region = key % old_count_;
    const std::string old = region < before_.region_names.size() ? before_.region_names[region] : "";
    if (set == 0) return old.empty() && old_count_ == 1 ? "outside" : old;
    const std::string& inside = level_sets_[set - 1].name;
    return old_count_ == 1 ? inside : fmt::format("{}_{}", region_label(old, region, old_count_), inside);
  }

  const TetMesh& before_;
  std::span<const LevelSet> level_sets_;
  std::uint32_t old_count_ = 1;
  std::vector<std::uint32_t> number_;
  std::vector<std::string> names_;
};

/// The faces between regions that no wall was at; each the patch of the level set that is on one side, the first one.
class NewWalls {
 public:
  NewWalls(const CutState& state, std::span<const LevelSet> level_sets) : state_(state), level_sets_(level_sets) {}

  void add(TetMesh& mesh, std::vector<LevelSetReport>& reports) const {
    const std::vector<HalfFace> across = half_face_neighbors(mesh.tets, mesh.points.size());
    const FaceTable known = face_table(mesh.points.size(), mesh.interfaces);
    const auto patches = first_free_patch(mesh);
    if (mesh.interface_patch.empty()) mesh.interface_patch.assign(mesh.interfaces.size(), 0);
    for (HalfFace h = 0; h < across.size(); ++h) {
      // Walls that the mesh had are its own business.
      if (across[h] == kNone || across[h] < h || state_.inside[h / 4] == state_.inside[across[h] / 4]) continue;
      const Triangle face = corners_of(mesh.tets, h);
      if (!known.group_of(face).empty()) continue;
      const std::uint32_t set = std::min(state_.inside[h / 4], state_.inside[across[h] / 4]);
      mesh.interfaces.push_back(face), mesh.interface_patch.push_back(patches + set);
      ++reports[set].triangles, reports[set].area += triangle_area(mesh.points, face);
    }
    name_patches(mesh, patches);
  }

 private:
  static std::uint32_t first_free_patch(const TetMesh& mesh) {
    auto next = static_cast<std::uint32_t>(mesh.patch_names.size());
    for (const auto* list : {&mesh.patch, &mesh.interface_patch})
      for (const std::uint32_t p : *list) next = std::max(next, p + 1);
    return std::max(next, 1u);
  }
  void name_patches(TetMesh& mesh, std::uint32_t first) const {
    mesh.patch_names.resize(first + level_sets_.size());
    for (std::size_t s = 0; s < level_sets_.size(); ++s) mesh.patch_names[first + s] = level_sets_[s].name + "_surface";
  }

  const CutState& state_;
  std::span<const LevelSet> level_sets_;
};

void count_insides(const CutState& state, std::vector<LevelSetReport>& reports) {
  const auto& p = state.mesh.points;
  for (std::size_t t = 0; t < state.inside.size(); ++t) {
    if (state.inside[t] == kNone) continue;
    const auto& [a, b, c, d] = state.mesh.tets[t];
    ++reports[state.inside[t]].elements, reports[state.inside[t]].volume += signed_volume(p[a], p[b], p[c], p[d]);
  }
}

/// All that hung on the mesh before, on what became of it.
TetMesh with_labels(const CutState& state, const TetMesh& before) {
  TetMesh mesh;
  mesh.points = state.mesh.points, mesh.tets = state.mesh.tets, mesh.boundary = state.mesh.boundary;
  mesh.interfaces = state.mesh.interfaces, mesh.curve_edges = state.mesh.curve_edges;
  inherit(mesh, before, {state.old_node, state.old_edge, state.old_face, state.old_tet});
  return mesh;
}

}  // namespace

CutMesh cut_along(const TetMesh& mesh, std::span<const LevelSet> level_sets, const LevelSetOptions& options,
                  const RunContext& context) {
  const ThreadLimit limit(context.threads);
  context.report("level sets", -1);
  require_cuttable(mesh, context), require_level_sets(level_sets, mesh);
  const TetMesh before = linear_part(mesh);
  CutState state = state_of(before, level_sets);
  CutMesh made;
  for (std::size_t s = 0; s < level_sets.size(); ++s) {
    context.check();
    LevelSetReport& report = made.level_sets.emplace_back();
    report.name = level_sets[s].name;
    move_to_surface(state, s, report);
    divide_along(state, s, report);
  }
  drop_pieces(state, options.least_piece, made.level_sets);
  count_insides(state, made.level_sets);
  made.mesh = with_labels(state, before);
  NewRegions(state, before, level_sets).enter(state, made.mesh);
  NewWalls(state, level_sets).add(made.mesh, made.level_sets);
  if (const auto defect = first_defect(made.mesh, context))
    throw MeshingError(fmt::format("the mesh that was cut is not valid: {}", *defect));
  return made;
}

}  // namespace octafront
