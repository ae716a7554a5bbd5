#include "pipeline/stages/kept_pairs.h"

#include <octafront/tet_mesh.h>

#include "base/geometry/quadratic_tet.h"
#include "base/mesh/edge_nodes.h"
#include "base/mesh/periodic_cell.h"
#include "base/mesh/periodic_nodes.h"

#include <algorithm>
#include <map>
#include <set>

namespace octafront {

namespace {

class MidPairs {
 public:
  explicit MidPairs(TetMesh& mesh) : mesh_(mesh), node_of_(mesh) { find(); }

  void run() {
    follow();
    while (straighten_bad()) follow();
    for (const Pair& p : pairs_) mesh_.periodic_nodes.push_back({p.period, p.copy, p.original});
    std::sort(mesh_.periodic_nodes.begin(), mesh_.periodic_nodes.end());
  }

 private:
  struct Pair {
    std::uint32_t period;
    VertexIndex copy, original;
    Edge of_copy, of_original;
  };

  void find() {
    std::vector<std::map<VertexIndex, VertexIndex>> original(mesh_.periods.size());
    for (const auto& [period, copy, of] : mesh_.periodic_nodes) original[period][copy] = of;
    std::set<std::array<std::uint32_t, 2>> known;
    for (std::uint32_t k = 0; k < original.size(); ++k)
      for (const Triangle& t : mesh_.boundary) {
        // Edges beside a face may lie between its vertices, too, without being copies of any.
        Triangle of_t = t;
        bool are_copies = true;
        for (int i = 0; i < 3; ++i) {
          const auto at = original[k].find(t[i]);
          if (at != original[k].end())
            of_t[i] = at->second;
          else
            are_copies = are_copies && is_own_copy(mesh_, k, t[i]);
        }
        if (!are_copies || of_t == t) continue;
        for (int i = 0; i < 3; ++i) {
          const VertexIndex a = t[i], b = t[(i + 1) % 3], c = of_t[i], d = of_t[(i + 1) % 3];
          const VertexIndex copy = node_of_(a, b), of = node_of_(c, d);
          if (copy != kNone && of != kNone && copy != of && known.insert({k, copy}).second)
            pairs_.push_back({k, copy, of, {a, b}, {c, d}});
        }
      }
  }

  /// Copies of copies come there in as many rounds as there are periods.
  void follow() {
    for (std::size_t k = 0; k < mesh_.periods.size(); ++k)
      for (const Pair& p : pairs_) mesh_.points[p.copy] = led_by_period(mesh_, p.period, mesh_.points[p.original]);
  }

  bool straighten_bad() {
    std::vector<std::uint8_t> is_bad(mesh_.points.size(), 0);
    for (TetIndex t = 0; t < mesh_.tets.size(); ++t) {
      QuadraticTet nodes;
      for (int i = 0; i < 4; ++i) nodes[i] = mesh_.points[mesh_.tets[t][i]];
      for (int i = 0; i < 6; ++i) nodes[4 + i] = mesh_.points[mesh_.mid_nodes[t][i]];
      if (has_positive_jacobian(nodes)) continue;
      for (const VertexIndex v : mesh_.mid_nodes[t]) is_bad[v] = 1;
    }
    bool changed = false;
    for (const Pair& p : pairs_) {
      if (!is_bad[p.copy] && !is_bad[p.original]) continue;
      const Vec3 to = (mesh_.points[p.of_original[0]] + mesh_.points[p.of_original[1]]) * 0.5;
      // What is a copy itself is straight up to rounding once its own original is.
      if (is_straight_.insert(p.original).second) mesh_.points[p.original] = to, changed = true;
    }
    return changed;
  }

  TetMesh& mesh_;
  const EdgeNodes node_of_;
  std::vector<Pair> pairs_;
  std::set<VertexIndex> is_straight_;
};

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
    if (mesh.is_second_order()) MidPairs(mesh).run();
    stage.count("pairs of nodes", static_cast<double>(mesh.periodic_nodes.size()));
  });
}

}  // namespace octafront
