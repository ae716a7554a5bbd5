#pragma once

#include <octafront/options.h>

#include "base/core/stage.h"
#include "base/shared/shared_tets.h"
#include "surface/remeshing/remesh.h"

namespace octafront {

/// What sets one method of filling the volume apart from the others.
struct MethodTraits {
  const char* stage;             ///< name of its stage in the report
  bool needs_clean = true;       ///< surfaces with defects are refused
  bool has_front = true;         ///< the surface is triangulated anew to the sizes, unless it is kept
  bool fills_complexes = false;  ///< several regions, sheets
  bool always_keeps = false;     ///< the input's triangles become the boundary, asked for or not
  bool shares_tets = false;      ///< several ranks may have shares of what it makes
  double tets_per_expected = 1;  ///< makes so many times the elements that the sizes promise
  /// Fills the surface and keeps its triangles; null for the method that makes a boundary of its own. `tets` are
  /// shares only where they may be.
  TetMesh (*fill)(const Remeshed& boundary, const VolumeOptions& options, const Stage& stage, Tets tets) = nullptr;

  bool makes_own_boundary() const { return fill == nullptr; }
};

/// Throws OptionError if there is no such method.
const MethodTraits& traits_of(Method method);

/// Whether the input's triangles become the boundary.
bool keeps_surface(const Options& options);

/// Whether the mesher chooses the sizes: nothing says what they are, whatever limits or refines them.
bool has_automatic_sizes(const Options& options);

}  // namespace octafront
