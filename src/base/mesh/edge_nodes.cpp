#include "base/mesh/edge_nodes.h"

#include <algorithm>
#include <span>
#include <vector>

namespace octafront {
namespace {

template <class Rows>
void mark(const Rows& rows, std::vector<bool>& marked) {
  for (const auto& row : rows)
    for (const VertexIndex v : row) marked[v] = true;
}

}  // namespace

EdgeNodes::EdgeNodes(const TetMesh& mesh) {
  if (!mesh.is_second_order()) return;
  std::vector<bool> marked(mesh.points.size(), false);
  mark(mesh.boundary, marked);
  mark(mesh.interfaces, marked);
  mark(mesh.curve_edges, marked);
  at_low_ = {mesh.points.size(), [&](const auto& add) {
               for (std::size_t t = 0; t < mesh.tets.size(); ++t)
                 for (std::size_t e = 0; e < 6; ++e) {
                   const auto [i, j] = kTetEdges[e];
                   const VertexIndex a = mesh.tets[t][static_cast<std::size_t>(i)],
                                     b = mesh.tets[t][static_cast<std::size_t>(j)];
                   if (marked[a] && marked[b]) add(std::min(a, b), Entry{std::max(a, b), mesh.mid_nodes[t][e]});
                 }
             }};
  for (std::size_t v = 0; v < at_low_.size(); ++v)
    std::sort(at_low_[v].begin(), at_low_[v].end(), [](const Entry& a, const Entry& b) { return a.high < b.high; });
}

VertexIndex EdgeNodes::operator()(VertexIndex a, VertexIndex b) const {
  const VertexIndex low = std::min(a, b), high = std::max(a, b);
  if (low >= at_low_.size()) return kNone;
  const std::span<const Entry> entries = at_low_[low];
  const auto at =
      std::lower_bound(entries.begin(), entries.end(), high, [](const Entry& e, VertexIndex h) { return e.high < h; });
  return at != entries.end() && at->high == high ? at->node : kNone;
}

}  // namespace octafront
