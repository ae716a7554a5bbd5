#pragma once

#include <octafront/generate.h>

#include "pipeline/stages/stages.h"

#include <functional>
#include <string>
#include <vector>

namespace octafront {

// The volumes of regions: kept where that is asked for, compared with those of the input on the mesh that is handed
// out, and what was lost said by region.

/// What the regions shall have, by number: of CAD solids the true volumes, else those of the input; 0: not known.
std::vector<double> wanted_volumes(const Prepared& input, const Domain& domain);

/// If the run keeps volumes: vertices inside the patches of the new surface leave the input by what chords cut off.
void keep_surface_volumes(const Prepared& input, Remeshed& made, const Run& run, const Stage& stage);

/// The same of a finished linear mesh, since improvement has moved its boundary: as far as its elements stay good.
void keep_mesh_volumes(const Prepared& input, const std::vector<double>& wanted, Filled& filled, Run& run);

/// Enters how many elements of a size that was given each region needs, and of several their walls.
void describe_needed(const SurfaceMesh& walls, double size, Report& report);

/// Enters the volumes of the input's regions into the report, beside those of the mesh.
void describe_input_volumes(const Prepared& input, const Filled& filled, Report& report);

/// The same of a mesh that was changed, by what it was.
void describe_volumes_of(const TetMesh& before, Report& report);

/// How the volume of a region has changed.
struct VolumeChange {
  std::string region;  ///< its name; empty: of all, which are one
  std::uint32_t number = 0;
  double before = 0, made = 0;
  bool is_cad = false;  ///< `before` is a true volume
  double part() const { return made / before - 1; }
};
/// Of all regions whose volume in the input is known, by a report that is described.
std::vector<VolumeChange> volume_changes(const Report& report);

/// Says by region what is off by more than kVolumeKept, and what helps.
void note_volumes(const Prepared& input, const Filled& filled, const Options& options, const Report& report,
                  const Stage& stage);
/// The same of a surface alone.
void note_volumes(const Prepared& input, const SurfaceMesh& made, const Options& options, const Stage& stage);
/// The same of a mesh that was changed.
void note_volumes_of_mesh(const Report& report, const Stage& stage);

// What chords of elements cut off the regions: made less where the user asks for that, and refused where the mesh has
// lost more than they do.

/// The volumes that regions have in the input, and how deep chords may lie to keep them within a percent.
struct KnownVolumes {
  std::vector<double> volumes, depths;
};
/// By CAD where that is known, else by the surface.
KnownVolumes known_volumes(const Domain& domain);

/// Of CAD: throws MeshingError where regions of a linear mesh are off by more than what its chords cut off explains.
void refuse_lost_volumes(const Domain& domain, const Filled& filled, Run& run);

/// make(domain), again with smaller elements where regions are off by more than `percent`. Throws MeshingError where
/// that does not help.
Result with_volumes_within(double percent, const Domain& domain, const std::function<Result(const Domain&)>& make);

}  // namespace octafront
