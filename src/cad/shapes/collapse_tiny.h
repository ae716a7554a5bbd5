#pragma once

#include "cad/model/cad_model.h"

#include <cstdint>
#include <span>
#include <vector>

namespace octafront::cad {

/// What became of tiny faces and edges.
struct Collapsed {
  std::vector<std::uint32_t> faces;     ///< that have no triangles any more, ascending
  std::vector<std::uint32_t> narrowed;  ///< that lost parts, ascending
  std::size_t edges = 0;                ///< the rest: edges that are a point now
};

/// Takes faces whose mean width is below `tiny`, and edges shorter than it, out of the triangles: their narrow side
/// closes onto the larger of the faces beside them, by edges of triangles that are collapsed and, where both sides have
/// other samples, turned. No vertex moves by more than `tiny`. What would close a solid or a gap of that thickness,
/// turn a triangle over or change how the surface hangs together stays, and so does a face that would not vanish as a
/// whole. Edges of the model follow: of two that became one, the edge of the larger face stays, between the faces that
/// meet in it now; it is smooth where these were parallel before. `spared` faces and their edges stay. Whether the
/// surface crosses itself afterwards is for the caller to see.
Collapsed collapse_tiny(CadModel& model, double tiny, std::span<const std::uint32_t> spared = {});

/// Lets faces end where they grow narrower than `tiny`: between lines that part at less than 15 degrees, as those of
/// wedges, cusps and slits do. The lines become one there, by the same edits and under the same conditions; but a solid
/// that is a wedge of more than 14 degrees itself may end a little earlier. Faces of which
/// nothing would be left stay as they are, but for narrow ones.
Collapsed end_narrow_parts(CadModel& model, double tiny, std::span<const std::uint32_t> spared = {});

}  // namespace octafront::cad
