#include "pipeline/stages/kept_pairs.h"

#include <octafront/tet_mesh.h>

#include "base/mesh/face_nodes.h"
#include "base/mesh/periodic_nodes.h"
#include "pipeline/stages/paired_nodes.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>

namespace octafront {

namespace {

/// Links between the nodes behind corners of faces whose corners are copies.
class LinksOfPairs {
 public:
  explicit LinksOfPairs(const TetMesh& mesh) : mesh_(mesh), nodes_(mesh), original_(mesh.periods.size()) {
    for (const auto& [period, copy, original] : mesh.periodic_nodes) original_[period][copy] = original;
  }

  std::vector<NodeLink> run() const {
    std::vector<NodeLink> links;
    std::set<std::array<std::uint32_t, 2>> known;
    for (std::uint32_t k = 0; k < original_.size(); ++k)
      for (const Triangle& copy : mesh_.boundary) {
        const Triangle original = original_of(k, copy);
        if (original == copy) continue;
        visit_nodes_behind_corners(mesh_.order(), [&](const FaceNodes::Weights& weights) {
          const NodeLink link{k, nodes_.node(copy, weights), nodes_.node(original, weights)};
          if (link.copy != link.original && known.insert({k, link.copy}).second) links.push_back(link);
        });
      }
    return links;
  }

 private:
  /// The face that this one is a copy of; itself if of none.
  Triangle original_of(std::uint32_t period, const Triangle& copy) const {
    Triangle original = copy;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = original_[period].find(copy[i]);
      if (at != original_[period].end())
        original[i] = at->second;
      else if (!is_own_copy(mesh_, period, copy[i]))
        return copy;
    }
    return nodes_.has(original) ? original : copy;
  }

  const TetMesh& mesh_;
  const FaceNodes nodes_;
  std::vector<std::map<VertexIndex, VertexIndex>> original_;  ///< per period: of copies
};

void pair_behind_corners(TetMesh& mesh) {
  const std::vector<NodeLink> links = LinksOfPairs(mesh).run();
  const Repeats repeats{static_cast<std::uint32_t>(mesh.periods.size()),
                        [&](std::uint32_t period, Vec3 p) { return led_by_period(mesh, period, p); },
                        [](Vec3 p, std::span<const VertexIndex>) { return p; }};
  pair_nodes_behind_corners(mesh, links, repeats);
  for (const NodeLink& link : links) mesh.periodic_nodes.push_back({link.period, link.copy, link.original});
  std::sort(mesh.periodic_nodes.begin(), mesh.periodic_nodes.end());
}

}  // namespace

std::vector<VertexIndex> paired_vertices(const TetMesh& mesh) {
  std::vector<VertexIndex> paired;
  for (const auto& [period, copy, original] : mesh.periodic_nodes)
    for (const VertexIndex v : {copy, original})
      if (v < mesh.points.size()) paired.push_back(v);
  std::sort(paired.begin(), paired.end());
  paired.erase(std::unique(paired.begin(), paired.end()), paired.end());
  return paired;
}

void pair_mid_nodes(TetMesh& mesh, Run& run) {
  if (mesh.periodic_nodes.empty()) return;
  run.stage("pairs", [&](const Stage& stage) {
    if (mesh.order() > 1) pair_behind_corners(mesh);
    stage.count("pairs of nodes", static_cast<double>(mesh.periodic_nodes.size()));
  });
}

}  // namespace octafront
