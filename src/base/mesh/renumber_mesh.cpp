#include "base/mesh/renumber_mesh.h"

#include <algorithm>

namespace octafront {

void renumber_named_nodes(TetMesh& mesh, const std::vector<VertexIndex>& number) {
  for (WideCell& cell : mesh.wide_cells)
    for (VertexIndex& v : cell.nodes)
      if (v != kNone) v = number[v];
  for (WideFace& face : mesh.wide_faces)
    for (VertexIndex& v : face.nodes) v = number[v];
  for (SplitFace& face : mesh.split_faces)
    for (VertexIndex& v : face.nodes) v = number[v];
  std::erase_if(mesh.split_faces,
                [](const SplitFace& face) { return std::ranges::find(face.nodes, kNone) != face.nodes.end(); });
  for (auto& [period, copy, original] : mesh.periodic_nodes) copy = number[copy], original = number[original];
  std::erase_if(mesh.periodic_nodes, [](const auto& pair) { return pair[1] == kNone || pair[2] == kNone; });
  std::sort(mesh.periodic_nodes.begin(), mesh.periodic_nodes.end());
}

void renumber_corners(TetMesh& mesh, const std::vector<VertexIndex>& number) {
  renumber(mesh.tets, number);
  renumber(mesh.mid_nodes, number);
  for (VertexIndex& v : mesh.high_nodes) v = number[v];
  renumber(mesh.boundary, number);
  renumber(mesh.interfaces, number);
  renumber(mesh.curve_edges, number);
}

void renumber_vertices(TetMesh& mesh, const std::vector<VertexIndex>& number) {
  renumber_corners(mesh, number);
  renumber_named_nodes(mesh, number);
  for (NamedSet& set : mesh.sets) {
    if (set.kind != NamedSet::Kind::kNodes) continue;
    for (std::uint32_t& v : set.members) v = number[v];
    std::sort(set.members.begin(), set.members.end());
    set.members.erase(std::lower_bound(set.members.begin(), set.members.end(), kNone), set.members.end());
  }
}

void drop_unused_points(TetMesh& mesh, std::size_t kept) {
  std::vector<VertexIndex> number(mesh.points.size(), kNone);
  std::fill_n(number.begin(), kept, 0);
  mark_used(mesh.tets, number);
  mark_used(mesh.mid_nodes, number);
  for (const VertexIndex v : mesh.high_nodes) number[v] = 0;
  keep_numbered(mesh.points, number);
  renumber_vertices(mesh, number);
}

}  // namespace octafront
