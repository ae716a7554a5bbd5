#include "cells/close_gaps.h"

#include <numeric>

namespace octafront::cells {

ClosedGaps close_gaps(const BodySoup& soup, double /*tolerance*/, const RunContext& /*context*/) {
  ClosedGaps closed{soup.points, soup.triangles, {}, 0, 0};
  closed.source.resize(soup.triangles.size());
  std::iota(closed.source.begin(), closed.source.end(), 0);
  return closed;
}

}  // namespace octafront::cells
