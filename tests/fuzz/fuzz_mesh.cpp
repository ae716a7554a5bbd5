// Any bytes: a mesh whose indices are in range, whose points are finite and all used, or an InputError.

#include <octafront/error.h>

#include "formats/files/formats.h"
#include "formats/parts/mesh_parts.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace octafront;
  try {
    const TetMesh m = io::read_mesh_bytes({"a.mesh", {reinterpret_cast<const char*>(data), size}}).mesh;
    if (m.tets.empty() || (!m.region.empty() && m.region.size() != m.tets.size())) std::abort();
    if (!m.patch.empty() && m.patch.size() != m.boundary.size()) std::abort();
    if (!m.source.empty() && m.source.size() != m.boundary.size()) std::abort();
    std::vector<bool> used(m.points.size(), false);
    for (const Tet& t : m.tets) {
      for (const VertexIndex v : t) {
        if (v >= m.points.size() || !is_finite(m.points[v])) std::abort();
        used[v] = true;
      }
    }
    if (m.is_second_order() && m.mid_nodes.size() != m.tets.size()) std::abort();
    for (const auto& mids : m.mid_nodes)
      for (const VertexIndex v : mids) {
        if (v >= m.points.size() || !is_finite(m.points[v])) std::abort();
        used[v] = true;
      }
    if (!m.interface_patch.empty() && m.interface_patch.size() != m.interfaces.size()) std::abort();
    if (!m.curve.empty() && m.curve.size() != m.curve_edges.size()) std::abort();
    for (const Triangle& t : m.interfaces)
      for (const VertexIndex v : t)
        if (v >= m.points.size()) std::abort();
    for (const Edge& e : m.curve_edges)
      for (const VertexIndex v : e)
        if (v >= m.points.size()) std::abort();
    for (const NamedSet& set : m.sets) {
      const std::size_t most = set.kind == NamedSet::Kind::kNodes   ? m.points.size()
                               : set.kind == NamedSet::Kind::kEdges ? m.curve_edges.size()
                               : set.kind == NamedSet::Kind::kFaces ? m.boundary.size() + m.interfaces.size()
                                                                    : m.tets.size();
      if (!set.members.empty() && set.members.back() >= most) std::abort();
      if (!std::is_sorted(set.members.begin(), set.members.end())) std::abort();
    }
    // What was read can be written: the parts of any mesh.
    const io::MeshParts parts(m);
    for (const auto kind :
         {NamedSet::Kind::kNodes, NamedSet::Kind::kEdges, NamedSet::Kind::kFaces, NamedSet::Kind::kElements})
      io::combinations(parts, kind);
    for (const io::Part& part : parts.parts()) parts.nodes_of(part);
    for (const Triangle& t : m.boundary)
      for (const VertexIndex v : t)
        if (v >= m.points.size()) std::abort();
    for (const bool is_used : used)
      if (!is_used) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
