#pragma once

// What was done, entered into the report.

#include <octafront/mend.h>

#include "soup/arrangement/arrange.h"
#include "soup/cells/find_cells.h"
#include "soup/tidy/steps.h"

#include <cstdint>
#include <vector>

namespace octafront::mend {

/// Input triangles that were divided or lie double, by places that hang together.
void note_cuts(MendReport& report, const Arrangement& arranged, const std::vector<std::uint32_t>& face);

/// Faces of the draft of which nothing is left, by what hangs together of them.
void note_dropped(MendReport& report, tidy::Draft& draft, const std::vector<char>& used);

/// Faces that were turned to agree with their neighbours, and pieces that faced the wrong way.
void note_turned(MendReport& report, const tidy::Draft& draft, const std::vector<std::uint32_t>& piece,
                 const std::vector<char>& turned, const tidy::InputFaces& faces);

void note_filled(MendReport& report, const Arrangement& arranged, const Cells& cells,
                 const std::vector<std::uint32_t>& filled);

/// Sums, and a sentence for each kind of change.
void finish_report(MendReport& report, const SurfaceMesh& result, const RunContext& context);

}  // namespace octafront::mend
