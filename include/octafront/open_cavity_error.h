#pragma once

#include <octafront/error.h>
#include <octafront/surface_mesh.h>

#include <string>
#include <utility>

namespace octafront {

/// A cavity of the volume front that nothing could close. Carries the evidence: a small closed surface, facing outward.
class OpenCavityError : public MeshingError {
 public:
  OpenCavityError(const std::string& what, SurfaceMesh open_cavity)
      : MeshingError(what), cavity(std::move(open_cavity)) {}
  SurfaceMesh cavity;
};

}  // namespace octafront
