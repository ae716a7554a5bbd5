#include "base/core/disjoint_sets.h"
#include "base/geometry/measures.h"
#include "base/geometry/triangle_tree.h"
#include "soup/cells/cell_steps.h"

#include <map>
#include <set>
#include <utility>

namespace octafront::cells {
namespace {

/// Sums of directed edges, by the sorted edge.
using Chain = std::map<Edge, int>;

void add(Chain& chain, const Triangle& t, int times) {
  for (int i = 0; i < 3; ++i) {
    const VertexIndex a = t[i], b = t[(i + 1) % 3];
    chain[sorted_edge(a, b)] += a < b ? times : -times;
  }
}

class Sharing {
 public:
  Sharing(const std::vector<Vec3>& points, const std::vector<BodyFace>& earlier, std::vector<BodyFace>& later,
          const Misfits& misfits, const RunContext& context)
      : points_(points), later_(later), context_(context), floor_(misfits.floor()) {
    const std::uint32_t body = later.front().body;
    for (const BodyFace& f : earlier) {
      if (!known_.insert(face_key(f.corners)).second) continue;
      walls_.push_back(f.corners);
      reach_.push_back(misfits.reach(f.body, body));
      most_ = std::max(most_, reach_.back());
      normals_.push_back(normal_of(f.corners));
      vertices_.insert(f.corners.begin(), f.corners.end());
    }
  }

  void run() {
    find_contact();
    if (is_shared()) return;
    fill_enclaves();
    settle_rim();
    gone_.assign(later_.size(), 0);
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> piece = pieces(1, count);
    std::vector<std::uint32_t> all;
    std::vector<std::vector<std::uint32_t>> patches(count);
    for (std::uint32_t t = 0; t < later_.size(); ++t) {
      if (!contact_[t]) continue;
      all.push_back(t);
      patches[piece[t]].push_back(t);
    }
    if (!become_shared(all) && count <= kMostPatches)
      for (const std::vector<std::uint32_t>& patch : patches) become_shared(patch);
    std::vector<BodyFace> kept;
    for (std::uint32_t t = 0; t < later_.size(); ++t)
      if (!gone_[t]) kept.push_back(later_[t]);
    kept.insert(kept.end(), made_.begin(), made_.end());
    later_ = std::move(kept);
  }

 private:
  Vec3 normal_of(const Triangle& t) const { return unit_normal(points_[t[0]], points_[t[1]], points_[t[2]]); }
  double area_of(const Triangle& t) const { return triangle_area(points_, t); }
  Vec3 middle_of(const Triangle& t) const { return (points_[t[0]] + points_[t[1]] + points_[t[2]]) / 3; }
  bool is_corner_of_earlier(VertexIndex v) const { return vertices_.contains(v); }

  /// Triangles with corners of earlier walls, and in the middle not farther from them than vertices are.
  void find_contact() {
    const TriangleTree tree(points_, walls_);
    for (const BodyFace& f : later_) {
      const Triangle& t = f.corners;
      const bool has_corners = std::all_of(t.begin(), t.end(), [&](VertexIndex v) { return is_corner_of_earlier(v); });
      contact_.push_back(has_corners && (known_.contains(face_key(t)) || lies_on(tree, t)));
    }
  }
  bool lies_on(const TriangleTree& tree, const Triangle& t) const {
    const Vec3 p = middle_of(t), n = normal_of(t);
    return !tree.for_each_box_near(Box3{p, p}.grown(most_), [&](std::uint32_t w, const TriangleCorners& c) {
      const Vec3 q = closest_point_on_triangle(p, c[0], c[1], c[2]);
      return !(distance(p, q) <= reach_[w] && face_each_other(n, normals_[w], n));
    });
  }
  bool is_shared() const {
    for (std::size_t t = 0; t < later_.size(); ++t)
      if (contact_[t] && !known_.contains(face_key(later_[t].corners))) return false;
    return true;
  }

  /// What the contact surrounds, and is as near, belongs to it whatever its corners.
  void fill_enclaves() {
    const TriangleTree tree(points_, walls_);
    const auto is_near = [&](Vec3 p) { return tree.is_within(p, kBend * most_); };
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> piece = pieces(0, count);
    std::vector<double> area(count, 0);
    double of_contact = 0;
    std::vector<char> fills(count, 1);
    for (std::uint32_t t = 0; t < later_.size(); ++t) {
      const Triangle& c = later_[t].corners;
      (contact_[t] ? of_contact : area[piece[t]]) += area_of(c);
      if (contact_[t]) continue;
      fills[piece[t]] = fills[piece[t]] && is_near(middle_of(c)) &&
                        std::all_of(c.begin(), c.end(), [&](VertexIndex v) { return is_near(points_[v]); });
    }
    for (std::uint32_t t = 0; t < later_.size(); ++t)
      if (!contact_[t] && fills[piece[t]] && area[piece[t]] < kEnclave * of_contact) contact_[t] = 1;
  }

  /// The rim of the contact is made of edges of the earlier walls: at others it takes slivers beside it, too, or else
  /// gives up the triangle there.
  void settle_rim() {
    std::set<Edge> edges;
    for (const Triangle& t : walls_)
      for (int i = 0; i < 3; ++i) edges.insert(sorted_edge(t[i], t[(i + 1) % 3]));
    const TriangleTree tree(points_, walls_);
    std::vector<char> may_come;
    for (std::size_t t = 0; t < later_.size(); ++t) {
      const Triangle& c = later_[t].corners;
      may_come.push_back(!contact_[t] && std::all_of(c.begin(), c.end(), [&](VertexIndex v) {
        return is_corner_of_earlier(v);
      }) && tree.is_within(middle_of(c), most_));
    }
    while (change_at_rim(
               edges, [&](std::size_t t) { return may_come[t] && !contact_[t]; }, may_come) ||
           change_at_rim(
               edges, [&](std::size_t t) { return contact_[t] != 0; }, may_come)) {
    }
  }
  template <class May>
  bool change_at_rim(const std::set<Edge>& edges, May may, std::vector<char>& may_come) {
    Chain rim;
    for (std::size_t t = 0; t < later_.size(); ++t)
      if (contact_[t]) add(rim, later_[t].corners, 1);
    bool any = false;
    for (std::size_t t = 0; t < later_.size(); ++t) {
      const Triangle& c = later_[t].corners;
      for (int i = 0; i < 3 && may(t); ++i) {
        const auto found = rim.find(sorted_edge(c[i], c[(i + 1) % 3]));
        if (found == rim.end() || found->second == 0 || edges.contains(found->first)) continue;
        contact_[t] = !contact_[t];
        may_come[t] = 0;
        any = true;
        break;
      }
    }
    return any;
  }

  /// Of the contact, or beside it, by edges.
  std::vector<std::uint32_t> pieces(char of_contact, std::uint32_t& count) const {
    DisjointSets sets(later_.size());
    std::map<Edge, std::uint32_t> first;
    for (std::uint32_t t = 0; t < later_.size(); ++t)
      for (int i = 0; i < 3 && contact_[t] == of_contact; ++i)
        sets.join(
            t, first.try_emplace(sorted_edge(later_[t].corners[i], later_[t].corners[(i + 1) % 3]), t).first->second);
    std::vector<std::uint32_t> piece(later_.size(), kNone);
    for (std::uint32_t t = 0; t < later_.size(); ++t)
      if (contact_[t] == of_contact) piece[t] = sets.find(t) == t ? count++ : piece[sets.find(t)];
    return piece;
  }

  /// A part of the contact becomes the earlier walls there; false, and nothing is done, if that cannot be.
  bool become_shared(const std::vector<std::uint32_t>& of_patch) {
    context_.check();
    Chain rim;
    std::vector<Triangle> triangles;
    for (const std::uint32_t t : of_patch) {
      triangles.push_back(later_[t].corners);
      add(rim, triangles.back(), 1);
    }
    std::erase_if(rim, [](const auto& e) { return e.second == 0; });
    const std::vector<std::uint32_t> part = parts_of_earlier(rim);
    const Ballot ballot = votes_of(triangles, part);
    const std::map<std::uint32_t, int> times = times_of(rim, part, ballot);
    Chain change;
    std::vector<BodyFace> made;
    double area = 0, against = 0;
    for (std::uint32_t w = 0; w < walls_.size(); ++w) {
      const int k = times.at(part[w]);
      area += k == 0 ? 0 : area_of(walls_[w]);
      against += k == ballot.way[w] ? 0 : area_of(walls_[w]);
      if (k == 0) continue;
      if (std::abs(k) > 1) return false;
      Triangle t = walls_[w];
      if (k < 0) std::swap(t[1], t[2]);
      add(change, t, 1);
      const std::uint32_t from = of_patch[ballot.nearest[w] == kNone ? 0 : ballot.nearest[w]];
      made.push_back({t, later_[from].body, later_[from].source});
    }
    std::erase_if(change, [](const auto& e) { return e.second == 0; });
    if (change != rim || against > kAgainst * area) return false;
    for (const std::uint32_t t : of_patch) gone_[t] = 1;
    made_.insert(made_.end(), made.begin(), made.end());
    return true;
  }

  /// Which earlier triangles lie on a patch: turned the same way (1), the other (-1), or not at all; and on which
  /// triangle.
  struct Ballot {
    std::vector<int> way;
    std::vector<std::uint32_t> nearest;
    std::map<std::uint32_t, std::array<double, 3>> areas;  ///< of parts, by way + 1
  };
  Ballot votes_of(const std::vector<Triangle>& patch, const std::vector<std::uint32_t>& part) const {
    const TriangleTree tree(points_, patch);
    Ballot ballot;
    for (std::uint32_t w = 0; w < walls_.size(); ++w) {
      const double reach = kBend * reach_[w];
      const TriangleTree::Nearest near = tree.nearest(middle_of(walls_[w]), reach * reach);
      const int way = near.triangle == kNone ? 0 : way_of(w, near.point, normal_of(patch[near.triangle]));
      ballot.way.push_back(way);
      ballot.nearest.push_back(way == 0 ? kNone : near.triangle);
      ballot.areas[part[w]][static_cast<std::size_t>(way + 1)] += area_of(walls_[w]);
    }
    return ballot;
  }

  /// A wall beside the rim of the patch is not on it.
  int way_of(std::uint32_t w, Vec3 at, Vec3 normal) const {
    const Vec3 way = at - middle_of(walls_[w]);
    const double turn = dot(normals_[w], normal);
    if (std::abs(turn) < kParallel) return 0;
    if (length(way) > floor_ && std::abs(dot(normals_[w], way)) < kParallel * length(way)) return 0;
    return turn > 0 ? 1 : -1;
  }

  /// How often each part of the earlier walls is taken, so that the rim is theirs: from the part on that knows best.
  std::map<std::uint32_t, int> times_of(const Chain& rim, const std::vector<std::uint32_t>& part,
                                        const Ballot& ballot) const {
    /// Across an edge of the rim the one part is taken so much more often than the other.
    std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, int>>> beyond;
    std::map<Edge, std::vector<std::pair<std::uint32_t, int>>> uses;
    for (std::uint32_t w = 0; w < walls_.size(); ++w)
      for (int i = 0; i < 3; ++i) {
        const VertexIndex a = walls_[w][i], b = walls_[w][(i + 1) % 3];
        if (rim.contains(sorted_edge(a, b))) uses[sorted_edge(a, b)].emplace_back(part[w], a < b ? 1 : -1);
      }
    for (const auto& [e, of] : uses) {
      if (of.size() != 2 || of[0].second == of[1].second) continue;
      const int more = rim.at(e) * of[0].second;
      beyond[of[1].first].emplace_back(of[0].first, more);
      beyond[of[0].first].emplace_back(of[1].first, -more);
    }
    std::vector<std::pair<double, std::uint32_t>> order;
    for (const auto& [p, areas] : ballot.areas) order.emplace_back(-*std::max_element(areas.begin(), areas.end()), p);
    std::sort(order.begin(), order.end());
    std::map<std::uint32_t, int> times;
    for (const auto& [area, first] : order) {
      const auto& areas = ballot.areas.at(first);
      const auto most = std::max_element(areas.begin(), areas.end()) - areas.begin();
      if (!times.try_emplace(first, static_cast<int>(most) - 1).second) continue;
      for (std::vector<std::uint32_t> stack{first}; !stack.empty();) {
        const std::uint32_t here = stack.back();
        stack.pop_back();
        for (const auto& [there, more] : beyond[here])
          if (times.try_emplace(there, times[here] + more).second) stack.push_back(there);
      }
    }
    return times;
  }

  /// What the rim divides the earlier walls into.
  std::vector<std::uint32_t> parts_of_earlier(const Chain& rim) const {
    std::map<Edge, std::vector<std::uint32_t>> uses;
    for (std::uint32_t w = 0; w < walls_.size(); ++w)
      for (int i = 0; i < 3; ++i) uses[sorted_edge(walls_[w][i], walls_[w][(i + 1) % 3])].push_back(w);
    DisjointSets sets(walls_.size());
    for (const auto& [e, of] : uses)
      if (of.size() == 2 && !rim.contains(e)) sets.join(of[0], of[1]);
    std::vector<std::uint32_t> part;
    for (std::uint32_t w = 0; w < walls_.size(); ++w) part.push_back(sets.find(w));
    return part;
  }

  /// The cosine of what walls that became one may be turned by; and how many times their reach they may be apart.
  static constexpr double kParallel = 0.5, kBend = 1.5;
  /// Each looks at all of the earlier walls.
  static constexpr std::uint32_t kMostPatches = 64;
  /// What part of the walls taken may not lie on what they replace: slivers beside the rim.
  static constexpr double kAgainst = 0.1;
  /// Of the area of the contact: beside more than that it is no enclave, but the other side of a thin body.
  static constexpr double kEnclave = 0.1;

  const std::vector<Vec3>& points_;
  std::vector<BodyFace>& later_;
  const RunContext& context_;
  double floor_;
  std::vector<Triangle> walls_;  ///< of earlier bodies, each once
  std::vector<Vec3> normals_;
  std::vector<double> reach_;
  double most_ = 0;
  std::set<Triangle> known_;
  std::set<VertexIndex> vertices_;
  std::vector<char> contact_, gone_;  ///< per triangle of the later body
  std::vector<BodyFace> made_;
};

}  // namespace

void share_walls(const std::vector<Vec3>& points, const std::vector<BodyFace>& earlier, std::vector<BodyFace>& later,
                 const Misfits& misfits, const RunContext& context) {
  if (later.empty()) return;
  Sharing(points, earlier, later, misfits, context).run();
}

}  // namespace octafront::cells
