#include "base/core/disjoint_sets.h"
#include "formats/jobs/job_plan.h"

#include <algorithm>
#include <set>
#include <span>

#include <fmt/core.h>

namespace octafront::io {

namespace {

/// The nodes of a mesh, joined by all that carries forces.
class JoinedNodes {
 public:
  JoinedNodes(const MeshParts& mesh, const JobPlan& plan) : mesh_(mesh), sets_(mesh.mesh().points.size()) {
    for (const Tet& tet : mesh.mesh().tets) join_all(tet);
    for (const JobPlan::Contact& c : plan.contacts)
      for (const std::size_t side : {c.slave, c.master}) {
        join_all(nodes_of(side));
        sets_.join(nodes_of(c.slave)[0], nodes_of(side)[0]);
      }
    for (const JobPlan::Coupling& c : plan.couplings) join_all(nodes_of(c.part));
    for (const JobPlan::Pretension& bolt : plan.pretensions)
      for (const auto& [front, behind] : bolt.nodes) sets_.join(front, behind);
  }

  std::uint32_t of(VertexIndex node) { return sets_.find(node); }
  std::set<std::uint32_t> held(const JobPlan& plan) {
    std::set<std::uint32_t> held;
    for (const JobPlan::Fix& fix : plan.fixes)
      for (const VertexIndex v : nodes_of(fix.part)) held.insert(of(v));
    for (const JobPlan::Coupling& c : plan.couplings)
      if (std::ranges::find(c.holds, true) != c.holds.end()) held.insert(of(nodes_of(c.part)[0]));
    return held;
  }

 private:
  std::vector<VertexIndex> nodes_of(std::size_t part) const { return mesh_.nodes_of(mesh_.parts()[part]); }
  void join_all(std::span<const VertexIndex> nodes) {
    for (const VertexIndex v : nodes) sets_.join(nodes[0], v);
  }

  const MeshParts& mesh_;
  DisjointSets sets_;
};

}  // namespace

std::string loose_parts(const MeshParts& mesh, const JobPlan& plan) {
  JoinedNodes joined(mesh, plan);
  const std::set<std::uint32_t> held = joined.held(plan);
  std::string loose;
  if (held.empty()) return loose;
  for (const Part& region : mesh.parts(Part::Origin::kRegion))
    if (!held.contains(joined.of(mesh.mesh().tets[region.members[0]][0])))
      loose += fmt::format("{}\"{}\"", loose.empty() ? "" : ", ", region.name);
  return loose;
}

}  // namespace octafront::io
