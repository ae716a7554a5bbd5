#include "surface/repair_steps.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace octafront::repair {
namespace {

struct Group {
  std::vector<std::uint32_t> triangles;  // with the same three vertices, ascending
};

bool same_orientation(const Triangle& a, const Triangle& b) {
  const auto at = std::find(b.begin(), b.end(), a[0]) - b.begin();
  return b[(at + 1) % 3] == a[1];
}

VertexIndex apex(const Triangle& t, const Edge& edge) {
  for (const VertexIndex v : t)
    if (v != edge[0] && v != edge[1]) return v;
  return kNone;
}

bool is_first_edge(const Triangle& t, const Edge& edge) {
  Triangle sorted = t;
  std::sort(sorted.begin(), sorted.end());
  return edge == Edge{sorted[0], sorted[1]};
}

/// Triangles with the same three vertices share their first edge, and their apex seen from there.
std::vector<Group> find_groups(const std::vector<Triangle>& triangles, const EdgeTable& table) {
  std::vector<Group> groups;
  std::vector<std::pair<VertexIndex, std::uint32_t>> seen;  // apex, triangle
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.uses(e).size() < 2) continue;
    seen.clear();
    for (const std::uint32_t h : table.uses(e))
      if (is_first_edge(triangles[h / 3], table.edges[e]))
        seen.push_back({apex(triangles[h / 3], table.edges[e]), h / 3});
    std::sort(seen.begin(), seen.end());
    for (std::size_t i = 0; i + 1 < seen.size();) {
      std::size_t end = i + 1;
      while (end < seen.size() && seen[end].first == seen[i].first) ++end;
      if (end - i > 1) {
        groups.emplace_back();
        for (std::size_t k = i; k < end; ++k) groups.back().triangles.push_back(seen[k].second);
      }
      i = end;
    }
  }
  return groups;
}

/// Groups that hang together over edges without any other face form a sheet. It is needed where its border edges have
/// an odd number of other faces: without it they would be open.
class Sheets {
 public:
  Sheets(const std::vector<Triangle>& triangles, const EdgeTable& table, const std::vector<Group>& groups)
      : triangles_(triangles), groups_(groups), parent_(groups.size()), tally_(groups.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    std::vector<std::uint32_t> group_of(triangles.size(), kNone);
    for (std::uint32_t g = 0; g < groups.size(); ++g)
      for (const std::uint32_t t : groups[g].triangles) group_of[t] = g;

    std::vector<std::pair<std::uint32_t, std::size_t>> border;  // group, other faces
    std::vector<std::uint32_t> here;                            // groups at the edge
    for (std::size_t e = 0; e < table.size(); ++e) {
      here.clear();
      std::size_t single = 0;
      for (const std::uint32_t h : table.uses(e)) {
        if (group_of[h / 3] == kNone)
          ++single;
        else
          here.push_back(group_of[h / 3]);
      }
      if (here.empty()) continue;
      std::sort(here.begin(), here.end());
      here.erase(std::unique(here.begin(), here.end()), here.end());
      if (here.size() == 2 && single == 0)
        parent_[find(here[0])] = find(here[1]);
      else
        for (const std::uint32_t g : here) border.push_back({g, single + here.size() - 1});
    }
    for (const auto& [g, others] : border) ++(others % 2 == 1 ? tally_[find(g)].odd : tally_[find(g)].even);
    for (std::uint32_t g = 0; g < groups.size(); ++g) tally_[find(g)].balanced &= balance(g) == 0;
  }

  /// Nothing of the group's sheet is needed to keep the rest closed.
  bool is_superfluous(std::uint32_t g) {
    const Tally& tally = tally_[find(g)];
    return tally.balanced && tally.even > tally.odd;
  }

  /// The triangle of the group that stays if one does: the first of those that most agree with.
  std::uint32_t keeper(std::uint32_t g) const {
    const std::vector<std::uint32_t>& t = groups_[g].triangles;
    if (balance(g) >= 0) return t[0];
    return *std::find_if(t.begin(), t.end(),
                         [&](std::uint32_t k) { return !same_orientation(triangles_[t[0]], triangles_[k]); });
  }

 private:
  struct Tally {
    std::size_t odd = 0, even = 0;
    bool balanced = true;
  };

  /// Triangles that face like the group's first one, less those that face the other way.
  int balance(std::uint32_t g) const {
    int sum = 0;
    for (const std::uint32_t t : groups_[g].triangles)
      sum += same_orientation(triangles_[groups_[g].triangles[0]], triangles_[t]) ? 1 : -1;
    return sum;
  }

  std::uint32_t find(std::uint32_t g) {
    while (parent_[g] != g) g = parent_[g] = parent_[parent_[g]];
    return g;
  }

  const std::vector<Triangle>& triangles_;
  const std::vector<Group>& groups_;
  std::vector<std::uint32_t> parent_;
  std::vector<Tally> tally_;
};

}  // namespace

Duplicates drop_duplicates(Draft& draft) {
  const std::vector<Triangle>& triangles = draft.mesh.triangles;
  const EdgeTable table = make_edge_table(draft.mesh.points.size(), triangles);
  const std::vector<Group> groups = find_groups(triangles, table);
  Duplicates done;
  if (groups.empty()) return done;

  Sheets sheets(triangles, table, groups);
  std::size_t in_superfluous = 0;
  for (std::uint32_t g = 0; g < groups.size(); ++g)
    if (sheets.is_superfluous(g)) in_superfluous += groups[g].triangles.size();
  // A model that is nothing but a sheet stays as an open surface: that tells more than nothing at all.
  const bool only_sheets = in_superfluous == triangles.size();
  std::vector<char> marked(triangles.size(), 0);
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    const bool drop_all = sheets.is_superfluous(g) && !only_sheets;
    const std::uint32_t kept = drop_all ? kNone : sheets.keeper(g);
    for (const std::uint32_t t : groups[g].triangles) {
      if (t == kept) continue;
      marked[t] = 1;
      ++(drop_all ? done.sheets : done.copies);
      (drop_all ? done.sheet_faces : done.copy_faces).push_back(draft.face[t]);
    }
  }
  drop_marked(draft, marked);
  sort_unique(done.copy_faces);
  sort_unique(done.sheet_faces);
  return done;
}

}  // namespace octafront::repair
