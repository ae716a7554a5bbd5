#include "fill/front/open_edge.h"

#include <algorithm>
#include <utility>

namespace octafront {

std::optional<Edge> first_open_edge(const std::vector<Triangle>& faces) {
  std::vector<std::pair<Edge, int>> runs;  // 1 from the lower to the higher vertex, -1 the other way
  runs.reserve(3 * faces.size());
  for (const Triangle& f : faces)
    for (int k = 0; k < 3; ++k) {
      const VertexIndex a = f[k], b = f[(k + 1) % 3];
      runs.emplace_back(Edge{std::min(a, b), std::max(a, b)}, a < b ? 1 : -1);
    }
  std::sort(runs.begin(), runs.end());
  int balance = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    balance += runs[i].second;
    const bool last = i + 1 == runs.size() || runs[i + 1].first != runs[i].first;
    if (last && balance != 0) return runs[i].first;
  }
  return std::nullopt;
}

std::optional<std::string> why_not_closed(const std::vector<Triangle>& faces, const std::string& what) {
  const std::optional<Edge> edge = first_open_edge(faces);
  if (!edge) return std::nullopt;
  return what + " are open at the edge (" + std::to_string((*edge)[0]) + ", " + std::to_string((*edge)[1]) + ")";
}

}  // namespace octafront
