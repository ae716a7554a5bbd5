#include "pipeline/stages/true_shape.h"

#include "base/core/parallel.h"
#include "base/geometry/measures.h"
#include "base/mesh/complex.h"
#include "improve/curved/curved.h"
#include "pipeline/stages/kept_shape.h"
#include "pipeline/stages/methods.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Degrees: within a face only such edges are features.
constexpr double kAngleWithinFace = 80;
/// What chords cut off falls with the bound: it is made smaller to come to this part of what may be lost, but to no
/// less than this part of itself at once.
constexpr double kAimOfBound = 0.4, kLeastOfBound = 0.05;

/// From one numbering of patches to another, by their names; those that have no name there come behind it.
std::vector<std::uint32_t> renumbering(const std::vector<std::string>& from, std::vector<std::string>& to) {
  std::vector<std::uint32_t> number;
  const std::size_t known = to.size();
  for (const std::string& name : from) {
    const auto last = to.begin() + static_cast<std::ptrdiff_t>(known), there = std::find(to.begin(), last, name);
    number.push_back(static_cast<std::uint32_t>(there != last ? there - to.begin() : std::ssize(to)));
    if (there == last) to.push_back(name);
  }
  return number;
}

void renumber(std::vector<std::uint32_t>& patch, std::size_t faces, const std::vector<std::uint32_t>& number) {
  patch.resize(faces);
  for (std::uint32_t& p : patch)
    if (p < number.size()) p = number[p];
}

void take_patches_of(const TrueGeometry& geometry, Filled& filled) {
  auto& [mesh, boundary] = filled;
  std::vector<std::string> names = geometry.patch_names();
  const std::vector<std::uint32_t> number = renumbering(mesh.patch_names, names);
  renumber(mesh.patch, mesh.boundary.size(), number);
  renumber(mesh.interface_patch, mesh.interfaces.size(), number);
  renumber(boundary.surface.patch, boundary.surface.triangles.size(), number);
  mesh.patch_names = boundary.surface.patch_names = std::move(names);
}

/// Patches of no geometry come behind the parts.
void name_parts_of(const TrueGeometry& geometry, const std::vector<Vec3>& points,
                   const std::vector<Triangle>& triangles, std::vector<std::uint32_t>& patch) {
  const auto known = static_cast<std::uint32_t>(geometry.patch_names().size());
  const auto parts = static_cast<std::uint32_t>(geometry.part_names().size());
  parallel_for(triangles.size(), [&](std::size_t t) {
    const auto& [a, b, c] = triangles[t];
    patch[t] = patch[t] < known ? geometry.part_at(patch[t], centroid(points[a], points[b], points[c]))
                                : parts + (patch[t] - known);
  });
}

}  // namespace

Options options_for_geometry(Options options) {
  if (!options.surface.feature_angle) options.surface.feature_angle = kAngleWithinFace;
  return options;
}

void place_on_geometry(const Prepared& input, Filled& filled, Run& run) {
  if (!input.geometry) return;
  take_patches_of(*input.geometry, filled);
  if (keeps_surface(run.options)) return;
  run.stage("true geometry", [&](const Stage& stage) {
    auto& [mesh, boundary] = filled;
    const SecondOrderSummary made = move_to_geometry(mesh, *input.geometry, stage.context());
    std::copy_n(mesh.points.begin(), boundary.surface.points.size(), boundary.surface.points.begin());
    stage.count("vertices moved", static_cast<double>(made.moved));
    stage.count("vertices held", static_cast<double>(made.held));
    if (made.held > 0)
      stage.note(fmt::format("{} vertices stay beside the true geometry: elements would turn inside out", made.held));
  });
}

void name_parts(const Prepared& input, Filled& filled) {
  if (!input.geometry) return;
  auto& [mesh, boundary] = filled;
  name_parts_of(*input.geometry, mesh.points, mesh.boundary, mesh.patch);
  name_parts_of(*input.geometry, mesh.points, mesh.interfaces, mesh.interface_patch);
  name_parts_of(*input.geometry, mesh.points, boundary.surface.triangles, boundary.surface.patch);
  std::vector<std::string> names = input.geometry->part_names();
  const auto known = static_cast<std::ptrdiff_t>(input.geometry->patch_names().size());
  names.insert(names.end(), mesh.patch_names.begin() + known, mesh.patch_names.end());
  mesh.patch_names = boundary.surface.patch_names = std::move(names);
}

void describe_true_volumes(const TetMesh& mesh, const Domain& domain, Report& report) {
  if (domain.true_volumes.empty()) return;
  const std::vector<double> made = curved_volumes(mesh);
  report.volume = report.true_volume = 0;
  for (std::size_t r = 0; r < domain.true_volumes.size() && r < made.size(); ++r) {
    report.volume += made[r];
    report.true_volume += domain.true_volumes[r];
    if (report.regions.empty()) continue;
    report.regions[r].volume = made[r];
    report.regions[r].true_volume = domain.true_volumes[r];
  }
}

std::vector<OffSolid> off_solids(const Domain& domain, const Report& report) {
  std::vector<OffSolid> off;
  for (std::uint32_t r = 0; r < domain.true_volumes.size(); ++r) {
    const double made = report.regions.empty() ? report.volume : report.regions[r].volume;
    const double change = change_of_volume(made, domain.true_volumes[r]);
    if (!(std::abs(change) <= kVolumeKept)) off.push_back({r, change});
  }
  return off;
}

std::vector<double> tightened(const Domain& domain, const std::vector<OffSolid>& off) {
  std::vector<double> bound = domain.bound;
  bound.resize(domain.surface.triangles.size(), HUGE_VAL);
  for (std::size_t t = 0; t < bound.size(); ++t)
    for (const OffSolid& solid : off) {
      const Sides sides = domain.surface.sides_of(t);
      if (sides[0] != solid.region && sides[1] != solid.region) continue;
      bound[t] *= std::clamp(kAimOfBound * kVolumeKept / std::abs(solid.change), kLeastOfBound, 1.0);
    }
  return bound;
}

std::string in_words(const Domain& domain, const std::vector<OffSolid>& off) {
  std::string all;
  for (const OffSolid& solid : off)
    all += fmt::format("{}\"{}\" by {:+.2f} %", all.empty() ? "" : ", ", region_name(domain.surface, solid.region),
                       100 * solid.change);
  return all;
}

}  // namespace octafront
