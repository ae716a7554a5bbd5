#include "pipeline/stages/finish.h"

#include <octafront/inside.h>
#include <octafront/limits.h>
#include <octafront/named_groups.h>
#include <octafront/split.h>

#include "base/core/wording.h"
#include "pipeline/inside/fins.h"
#include "pipeline/stages/adapting.h"
#include "pipeline/stages/agreement.h"
#include "pipeline/stages/contact_choice.h"
#include "pipeline/stages/kept_shape.h"
#include "pipeline/stages/kept_volumes.h"
#include "pipeline/stages/measure.h"
#include "pipeline/stages/methods.h"
#include "pipeline/stages/periodic.h"
#include "pipeline/stages/requirements.h"
#include "pipeline/stages/shell.h"
#include "pipeline/stages/true_shape.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace octafront {

namespace {

const Options& options_of(const Finishing& f) {
  return f.run.options;
}

/// Curves where patches meet, and what stands on fins in their place.
void put_fins_in_place(const Finishing& f) {
  f.run.stage("lines and points", [&](const Stage& stage) {
    f.fins->leave(f.filled.mesh);
    add_patch_curves(f.filled.mesh);
    for (std::string& note : f.fins->enter(f.filled.mesh)) stage.note(std::move(note));
  });
}

void place_sets(const Finishing& f) {
  f.run.stage("sets", [&](const Stage& stage) {
    if (const std::string missing = add_placed_sets(f.filled.mesh, f.domain.sets); !missing.empty())
      stage.note(missing + "; with `keep_surface` those of the surface stay");
  });
}

void split(const Finishing& f) {
  TetMesh& mesh = f.filled.mesh;
  f.run.stage("split", [&](const Stage& stage) {
    for (std::string& note : split_patches(mesh, names_listed(options_of(f).split, mesh.patch_names)))
      stage.note(std::move(note));
  });
  check_result(mesh, nullptr, f.run);
}

void open_contacts(const Finishing& f) {
  f.run.stage("contacts", [&](const Stage& stage) { open_contacts(f.domain, f.filled.mesh, stage); });
  check_result(f.filled.mesh, nullptr, f.run);
}

/// One thing that may be done to an improved mesh.
struct Feature {
  bool (*is_asked)(const Finishing&);
  bool wants_all;  ///< it looks at elements of all ranks together
  void (*run)(const Finishing&);
};

bool has_layers(const Finishing& f, bool outside) {
  return options_of(f).layers.count > 0 && options_of(f).layers.outside == outside;
}
void put_in_layers(const Finishing& f) {
  add_layers(f.input, f.filled, f.run);
}

using Of = const Finishing&;

constexpr bool kWantsAll = true, kGoesInShares = false;
constexpr auto kAlways = [](Of) { return true; };

// In the order in which they may follow each other. Layers inside lie on the true geometry, those outside grow from it;
// elements are curved when no vertex moves any more, named when no face changes.
constexpr std::array kFeatures{
    Feature{[](Of f) { return has_layers(f, false); }, kWantsAll, put_in_layers},
    Feature{kAlways, kGoesInShares, [](Of f) { note_missed_elements(f.filled, f.run); }},
    Feature{[](Of f) { return options_of(f).volume.shell != 0; }, kWantsAll,
            [](Of f) { layer_walls(f.filled, f.run); }},
    Feature{[](Of f) { return f.domain.geometry != nullptr; }, kWantsAll,
            [](Of f) { place_on_geometry(f.input, f.filled, f.run); }},
    Feature{[](Of f) { return options_of(f).surface.keep_volumes || owes_volume(f.input, f.filled.boundary, f.run); },
            kWantsAll, [](Of f) { keep_mesh_volumes(f.input, wanted_volumes(f.input, f.domain), f.filled, f.run); }},
    Feature{kAlways, kGoesInShares, [](Of f) { check_shape(f.input, f.filled, f.run); }},
    Feature{[](Of f) { return has_layers(f, true); }, kWantsAll, put_in_layers},
    Feature{[](Of f) { return !f.domain.true_volumes.empty(); }, kWantsAll,
            [](Of f) { refuse_lost_volumes(f.domain, f.filled, f.run); }},
    Feature{[](Of f) { return options_of(f).improve.no_bridging; }, kWantsAll,
            [](Of f) { divide_bridges(f.filled.mesh, f.run); }},
    Feature{[](Of f) { return options_of(f).order > 1; }, kWantsAll,
            [](Of f) { raise_order(f.input, f.filled, f.run); }},
    Feature{kAlways, kGoesInShares, [](Of f) { agree_on(f.filled, "mesh", f.run.context()); }},
    Feature{[](Of f) { return f.input.geometry == nullptr; }, kGoesInShares,
            [](Of f) { name_patches(f.input, f.filled); }},
    Feature{[](Of f) { return f.input.geometry != nullptr; }, kWantsAll,
            [](Of f) { name_parts(f.input, f.filled, f.run); }},
    Feature{[](Of f) { return f.input.cell.is_periodic(); }, kWantsAll,
            [](Of f) { pair_nodes(f.input, f.filled.mesh, f.run); }},
    Feature{kAlways, kGoesInShares, [](Of f) { check_result(f.filled, f.run); }},
    Feature{[](Of f) { return f.fins == nullptr; }, kGoesInShares, [](Of f) { add_patch_curves(f.filled.mesh); }},
    Feature{[](Of f) { return f.fins != nullptr; }, kWantsAll, put_fins_in_place},
    Feature{[](Of f) { return !f.domain.sets.empty(); }, kWantsAll, place_sets},
    Feature{[](Of f) { return !options_of(f).split.empty(); }, kWantsAll, split},
    Feature{[](Of f) { return !f.domain.contacts.is_shared(); }, kWantsAll, open_contacts},
    Feature{[](Of f) { return !options_of(f).groups.empty(); }, kWantsAll,
            [](Of f) { add_groups(f.input.geometry, f.filled.mesh, f.run); }},
    // Looked at when all runs that it takes are done.
    Feature{[](Of f) { return requires_something(options_of(f).require); }, kWantsAll, [](Of) {}},
};

/// What of the input is narrow at an element; nullopt also where other ranks have it.
std::optional<NarrowPlace> narrow_place_of(const Finishing& f, std::uint64_t tet) {
  const TetMesh& mesh = f.filled.mesh;
  if (f.filled.tets != Tets::kAll || tet >= mesh.tets.size()) return std::nullopt;
  std::array<Vec3, 4> element;
  for (std::size_t i = 0; i < 4; ++i) element[i] = mesh.points[mesh.tets[tet][i]];
  return narrow_place_at(f.input.surface.mesh(), element, keeps_surface(options_of(f)));
}

}  // namespace

void add_groups(const TrueGeometry* geometry, TetMesh& mesh, Run& run) {
  run.stage("groups", [&](const Stage& stage) {
    const std::vector<std::string>& groups = run.options.groups;
    std::vector<std::string> found;
    if (geometry != nullptr) found = places_without_names(*geometry, groups, mesh);
    const auto before = std::ssize(mesh.sets);
    for (const std::string& group : groups)
      if (std::string note = add_group(mesh, group_rule(group)); !note.empty()) stage.note(std::move(note));
    const auto is_found = [&](const NamedSet& set) { return std::ranges::find(found, set.name) != found.end(); };
    const auto first_new = mesh.sets.begin() + before;
    mesh.sets.erase(std::remove_if(mesh.sets.begin(), first_new, is_found), first_new);
  });
}

void finish(const Finishing& made) {
  if (std::ranges::any_of(kFeatures, [&](const Feature& f) { return f.wants_all && f.is_asked(made); }))
    make_whole(made.filled, made.run);
  for (const Feature& feature : kFeatures)
    if (feature.is_asked(made)) feature.run(made);
}

void describe(const Finishing& made) {
  Filled& filled = made.filled;
  Run& run = made.run;
  Report& report = run.report;
  run.stage("summary", [&](const Stage& stage) {
    const Comm comm = comm_of(filled, run);
    describe(filled.mesh, report, comm);
    require_elements(static_cast<double>(report.tets), "the mesh");
    run.comm().agree(report.hash, "mesh at the end");
    describe_true_volumes(filled, made.domain, report);
    describe_input_volumes(made.input, filled, report);
    const SizeOptions& asked = run.options.size;
    const bool is_one_size = asked.size && asked.named.empty() && asked.near.empty() && asked.regions.empty();
    if (is_one_size) describe_needed(filled.boundary.surface, *asked.size, report);
    if (!filled.layers) describe_sizes(filled.mesh, filled.boundary.sizes, report, comm);
    note_volumes(made.input, filled, run.options, report, stage);
    note_least(report, stage, [&](std::uint64_t tet) { return narrow_place_of(made, tet); });
  });
}

}  // namespace octafront
