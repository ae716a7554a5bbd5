#include "base/core/disjoint_sets.h"
#include "base/core/parallel.h"
#include "soup/tidy/steps.h"

#include <algorithm>
#include <utility>

namespace octafront::tidy {
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
  const Triangle sorted = face_key(t);
  return edge == Edge{sorted[0], sorted[1]};
}

void find_groups_at(const std::vector<Triangle>& triangles, const EdgeTable& table, std::size_t e,
                    std::vector<std::pair<VertexIndex, std::uint32_t>>& seen, std::vector<Group>& groups) {
  if (table.uses(e).size() < 2) return;
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

/// Triangles with the same three vertices share their first edge, and their apex seen from there.
std::vector<Group> find_groups(const std::vector<Triangle>& triangles, const EdgeTable& table) {
  constexpr std::size_t kEdges = 2048;
  return parallel_collect<Group>(table.size(), kEdges,
                                 [&](std::size_t begin, std::size_t end, std::vector<Group>& groups) {
                                   std::vector<std::pair<VertexIndex, std::uint32_t>> seen;  // apex, triangle
                                   for (std::size_t e = begin; e < end; ++e)
                                     find_groups_at(triangles, table, e, seen, groups);
                                 });
}

/// Groups that hang together over edges without any other face form a sheet. Whether a sheet stays, one triangle of
/// each group, or goes, is chosen such that as few edges as possible have an odd number of faces: those would be open.
class Sheets {
 public:
  Sheets(const std::vector<Triangle>& triangles, const EdgeTable& table, const std::vector<Group>& groups)
      : triangles_(triangles), groups_(groups), sheet_of_(groups.size()), sheets_(groups.size()) {
    read_edges(table);
    for (std::uint32_t g = 0; g < groups.size(); ++g) sheets_[sheet_of_.find(g)].balanced &= balance(g) == 0;
    link_borders();
    choose();
  }

  bool stays(std::uint32_t g) { return sheets_[sheet_of_.find(g)].stays; }

  /// The triangle of the group that stays if one does: the first of those that most agree with.
  std::uint32_t keeper(std::uint32_t g) const {
    const std::vector<std::uint32_t>& t = groups_[g].triangles;
    if (balance(g) >= 0) return t[0];
    return *std::find_if(t.begin(), t.end(),
                         [&](std::uint32_t k) { return !same_orientation(triangles_[t[0]], triangles_[k]); });
  }

 private:
  struct Sheet {
    std::vector<std::uint32_t> border;  // edges with an odd number of groups of this sheet
    bool balanced = true;               // as many triangles face one way as the other, in every group
    bool stays = false;
  };
  struct BorderEdge {
    std::size_t singles;                // faces that have no duplicate
    std::vector<std::uint32_t> groups;  // ascending
    bool odd;                           // number of faces, with the sheets as they are chosen now
  };

  void read_edges(const EdgeTable& table) {
    std::vector<std::uint32_t> group_of(triangles_.size(), kNone);
    for (std::uint32_t g = 0; g < groups_.size(); ++g)
      for (const std::uint32_t t : groups_[g].triangles) group_of[t] = g;
    std::vector<std::uint32_t> here;
    for (std::size_t e = 0; e < table.size(); ++e) {
      here.clear();
      for (const std::uint32_t h : table.uses(e))
        if (group_of[h / 3] != kNone) here.push_back(group_of[h / 3]);
      if (here.empty()) continue;
      const std::size_t singles = table.uses(e).size() - here.size();
      std::sort(here.begin(), here.end());
      here.erase(std::unique(here.begin(), here.end()), here.end());
      if (here.size() == 2 && singles == 0)
        sheet_of_.join(here[0], here[1]);
      else
        edges_.push_back({singles, here, singles % 2 == 1});
    }
  }

  void link_borders() {
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      for (const std::uint32_t g : edges_[e].groups) {
        std::vector<std::uint32_t>& border = sheets_[sheet_of_.find(g)].border;
        if (!border.empty() && border.back() == e)
          border.pop_back();
        else
          border.push_back(e);
      }
    }
  }

  void choose() {
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      Sheet& sheet = sheets_[g];
      if (sheet_of_.find(g) != g) continue;
      // Where the input has no open edges, an odd number of layers is one too many to cancel out.
      if (groups_[g].triangles.size() % 2 == 1 || sheet.border.empty()) change(sheet);
    }
    // Each change leaves fewer odd edges, so this ends.
    for (bool changed = true; changed;) {
      changed = false;
      for (Sheet& sheet : sheets_) {
        const auto odd =
            std::count_if(sheet.border.begin(), sheet.border.end(), [&](std::uint32_t e) { return edges_[e].odd; });
        if (2 * odd <= static_cast<std::ptrdiff_t>(sheet.border.size())) continue;
        change(sheet);
        changed = true;
      }
    }
    // A sheet that touches nothing else is a face written twice if its layers face the same way.
    for (Sheet& sheet : sheets_)
      if (!sheet.stays && !sheet.balanced && is_free(sheet)) change(sheet);
  }

  void change(Sheet& sheet) {
    sheet.stays = !sheet.stays;
    for (const std::uint32_t e : sheet.border) edges_[e].odd = !edges_[e].odd;
  }

  bool is_free(const Sheet& sheet) const {
    return std::all_of(sheet.border.begin(), sheet.border.end(),
                       [&](std::uint32_t e) { return edges_[e].singles == 0 && edges_[e].groups.size() == 1; });
  }

  /// Triangles that face like the group's first one, less those that face the other way.
  int balance(std::uint32_t g) const {
    int sum = 0;
    for (const std::uint32_t t : groups_[g].triangles)
      sum += same_orientation(triangles_[groups_[g].triangles[0]], triangles_[t]) ? 1 : -1;
    return sum;
  }

  const std::vector<Triangle>& triangles_;
  const std::vector<Group>& groups_;
  DisjointSets sheet_of_;      // groups by the first of their sheet
  std::vector<Sheet> sheets_;  // at the index of the group that stands for it
  std::vector<BorderEdge> edges_;
};

}  // namespace

Duplicates drop_duplicates(Draft& draft) {
  const std::vector<Triangle>& triangles = draft.mesh.triangles;
  const EdgeTable& table = draft.edges();
  const std::vector<Group> groups = find_groups(triangles, table);
  Duplicates done;
  if (groups.empty()) return done;

  Sheets sheets(triangles, table, groups);
  std::size_t in_superfluous = 0;
  for (std::uint32_t g = 0; g < groups.size(); ++g)
    if (!sheets.stays(g)) in_superfluous += groups[g].triangles.size();
  // A model that is nothing but a sheet stays as an open surface: that tells more than nothing at all.
  const bool only_sheets = in_superfluous == triangles.size();
  std::vector<char> marked(triangles.size(), 0);
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    const bool drop_all = !sheets.stays(g) && !only_sheets;
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

}  // namespace octafront::tidy
