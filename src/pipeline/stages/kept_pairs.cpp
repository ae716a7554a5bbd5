#include "pipeline/stages/kept_pairs.h"

#include <octafront/tet_mesh.h>

#include "base/core/wording.h"
#include "base/geometry/quadratic_tet.h"
#include "base/mesh/edge_nodes.h"
#include "base/mesh/periodic_cell.h"
#include "base/mesh/periodic_nodes.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Numbers of the improved mesh by those of the one before; kNone: no vertex lies there any more.
std::vector<VertexIndex> numbers_now(const TetMesh& before, const TetMesh& mesh) {
  VerticesByPlace at;
  for (VertexIndex v = 0; v < mesh.points.size(); ++v) at.add(mesh.points[v], v);
  std::vector<VertexIndex> now(before.points.size(), kNone);
  for (const VertexIndex v : paired_vertices(before)) {
    const Vec3 p = before.points[v];
    now[v] = v < mesh.points.size() && mesh.points[v] == p ? v : at.find(p);
  }
  return now;
}

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

std::vector<VertexIndex> paired_now(const TetMesh& before, const TetMesh& mesh) {
  if (before.periodic_nodes.empty()) return {};
  std::vector<VertexIndex> paired;
  for (const VertexIndex v : numbers_now(before, mesh))
    if (v != kNone) paired.push_back(v);
  std::sort(paired.begin(), paired.end());
  return paired;
}

void keep_pairs(const TetMesh& before, TetMesh& mesh, Run& run) {
  if (before.periodic_nodes.empty()) return;
  run.stage("pairs", [&](const Stage& stage) {
    const std::vector<VertexIndex> now = numbers_now(before, mesh);
    std::uint64_t lost = 0;
    for (const auto& [period, copy, original] : before.periodic_nodes) {
      if (copy >= now.size() || original >= now.size()) continue;  // mid-side nodes, which went
      if (now[copy] == kNone || now[original] == kNone)
        ++lost;
      else
        mesh.periodic_nodes.push_back({period, now[copy], now[original]});
    }
    std::sort(mesh.periodic_nodes.begin(), mesh.periodic_nodes.end());
    if (lost > 0) stage.note(fmt::format("{} of the periodic mesh are there no more", counted(lost, "pair")));
    if (mesh.is_second_order()) MidPairs(mesh).run();
    stage.count("pairs of nodes", static_cast<double>(mesh.periodic_nodes.size()));
  });
}

}  // namespace octafront
