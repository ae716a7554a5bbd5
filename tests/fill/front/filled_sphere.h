#pragma once

#include "base/core/stage.h"
#include "fill/front/fill.h"
#include "fill/front/front_task.h"
#include "support/named_surfaces.h"

#include <algorithm>
#include <vector>

namespace octafront::testing {

/// A sphere filled by the front alone, with all that its tasks need, and holes punched into it.
struct FilledSphere {
  SurfaceMesh surface;
  SizeField sizes;
  VolumeOptions options;
  RunContext context;
  StageReport report;
  Stage stage{context, report};
  FrontTask task{sizes, options, stage};
  TetMesh mesh;
  std::vector<Wall> walls;  ///< of the holes, seen from inside them

  FilledSphere(int level, double size) : surface(icosphere(level)), sizes(SizeField::uniform(size)) {
    options.core = VolumeOptions::Core::kOff;
    mesh = fill_volume(surface, sizes, options, stage);
  }
  FilledSphere(const FilledSphere&) = delete;
  FilledSphere& operator=(const FilledSphere&) = delete;

  /// Takes the tetrahedra around an inner vertex out.
  void punch(VertexIndex v) {
    std::erase_if(mesh.tets, [&](const Tet& t) {
      const auto at = std::ranges::find(t, v);
      if (at == t.end()) return false;
      // The face opposite the vertex, seen from it.
      const auto& f = kTetFaces[static_cast<std::size_t>(at - t.begin())];
      walls.push_back({t[f[0]], t[f[2]], t[f[1]]});
      return true;
    });
  }
};

}  // namespace octafront::testing
