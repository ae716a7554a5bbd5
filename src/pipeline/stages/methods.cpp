#include "pipeline/stages/methods.h"

#include <octafront/error.h>

#include "fill/classic/fill_classic.h"
#include "fill/front/bind_to_surface.h"
#include "fill/front/fill.h"
#include "fill/recovery/recover.h"

namespace octafront {

namespace {

TetMesh fill_by_front(const Remeshed& boundary, const VolumeOptions& options, const Stage& stage, Tets tets) {
  return fill_volume(boundary.surface, boundary.sizes, options, stage, tets);
}

TetMesh fill_by_classic_front(const Remeshed& boundary, const VolumeOptions& options, const Stage& stage, Tets) {
  return fill_volume_classic(boundary.surface, options, stage);
}

TetMesh fill_by_recovery(const Remeshed& boundary, const VolumeOptions&, const Stage& stage, Tets) {
  TetMesh mesh = recover_volume(boundary.surface, stage);
  bind_to_surface(mesh, boundary.surface);
  return mesh;
}

/// The classical front makes 1.1 to 1.4 times the elements that the sizes promise.
constexpr double kClassicTets = 1.225;

constexpr MethodTraits kOctreeAft{
    .stage = "volume front", .fills_complexes = true, .shares_tets = true, .fill = fill_by_front};
constexpr MethodTraits kAft{.stage = "volume front", .tets_per_expected = kClassicTets, .fill = fill_by_classic_front};
constexpr MethodTraits kOctree{.stage = "stuffing", .needs_clean = false, .has_front = false};
constexpr MethodTraits kRecover{
    .stage = "recovery", .has_front = false, .fills_complexes = true, .always_keeps = true, .fill = fill_by_recovery};

}  // namespace

const MethodTraits& traits_of(Method method) {
  switch (method) {
    case Method::kOctreeAft:
      return kOctreeAft;
    case Method::kAft:
      return kAft;
    case Method::kOctree:
      return kOctree;
    case Method::kRecover:
      return kRecover;
  }
  throw OptionError("there is no such method");
}

bool keeps_surface(const Options& options) {
  return options.surface.keep || traits_of(options.method).always_keeps;
}

bool has_automatic_sizes(const Options& options) {
  const SizeOptions& size = options.size;
  return !size.size && !size.elements && !size.callback && !size.field && !size.mesh && size.point_sizes.empty();
}

}  // namespace octafront
