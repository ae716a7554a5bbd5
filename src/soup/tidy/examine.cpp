#include "soup/tidy/examine.h"

#include "soup/tidy/defect_steps.h"
#include "soup/tidy/steps.h"

#include <utility>

namespace octafront {

Examined examine_surface(const SurfaceMesh& soup, bool is_clean, const RunContext& context) {
  tidy::Draft draft = tidy::make_draft(soup, context);
  Examined result{tidy::tidied(draft), {}, {}};
  const SurfaceMesh& surface = result.repaired.surface;
  result.edges = draft.known_edges ? std::move(*draft.known_edges)
                                   : make_edge_table(surface.points.size(), surface.triangles, context);
  if (!is_clean) result.defects = tidy::find_defects(result.repaired, result.edges, context);
  return result;
}

}  // namespace octafront
