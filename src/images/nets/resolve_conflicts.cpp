#include "base/core/parallel.h"
#include "images/nets/conflicts.h"
#include "images/nets/net_steps.h"

#include <algorithm>
#include <iterator>
#include <map>

namespace octafront::nets {
namespace {

bool is_on_cell(const Lattice& lattice, const Corner& c) {
  bool is_on_face = false;
  for (int a = 0; a < 3; ++a) {
    is_on_face = is_on_face || lattice.is_low(c, a) || lattice.is_high(c, a);
    // A corner touches the cell if one of the voxels before and behind it does.
    Corner before = c, behind = c;
    for (int b = 0; b < 3; ++b) {
      before[b] = b == a ? c[b] - 1 : lattice.size(b) / 2;
      behind[b] = b == a ? c[b] : lattice.size(b) / 2;
    }
    if (!lattice.is_in_cell(before) && !lattice.is_in_cell(behind)) return false;
  }
  return is_on_face;
}

/// The corner on low faces that this one is a copy of.
Corner low_corner(const Lattice& lattice, Corner c) {
  for (int a = 0; a < 3; ++a)
    if (lattice.is_high(c, a)) c[a] = lattice.size(a) - c[a];
  return c;
}

/// How far apart two vertices lie along the axes in which the corner is on no face of the cell.
double apart(const Lattice& lattice, const Corner& c, Vec3 p, Vec3 q) {
  double squared = 0;
  for (int a = 0; a < 3; ++a)
    if (!lattice.is_low(c, a)) squared += (p[a] - q[a]) * (p[a] - q[a]);
  return squared;
}

}  // namespace

Mates::Mates(const Lattice& lattice, Net& net) : set_of_(net.corner.size(), kNone) {
  if (!lattice.is_periodic()) return;
  std::map<Corner, std::map<Corner, std::vector<VertexIndex>>> copies;
  for (VertexIndex v = 0; v < net.corner.size(); ++v)
    if (is_on_cell(lattice, net.corner[v])) copies[low_corner(lattice, net.corner[v])][net.corner[v]].push_back(v);
  for (const auto& entry : copies) {
    const Corner& low = entry.first;  // clang 14 catches no part of a structured binding
    const auto& by_corner = entry.second;
    const auto first = static_cast<std::uint32_t>(sets_.size());
    for (const VertexIndex v : by_corner.begin()->second) {
      set_of_[v] = static_cast<std::uint32_t>(sets_.size());
      sets_.push_back({v});
    }
    for (auto at = std::next(by_corner.begin()); at != by_corner.end(); ++at) {
      std::vector<VertexIndex> left = at->second;
      for (std::size_t s = first; s < sets_.size() && !left.empty(); ++s) {
        const Vec3 start = net.start[sets_[s][0]];
        const auto nearest = std::min_element(left.begin(), left.end(), [&](VertexIndex u, VertexIndex v) {
          return apart(lattice, low, net.start[u], start) < apart(lattice, low, net.start[v], start);
        });
        set_of_[*nearest] = static_cast<std::uint32_t>(s);
        sets_[s].push_back(*nearest);
        left.erase(nearest);
      }
    }
  }
  bring_together(lattice, net, net.start);
}

void Mates::bring_together(const Lattice& lattice, const Net& net, std::vector<Vec3>& x) const {
  for (const std::vector<VertexIndex>& set : sets_)
    for (const VertexIndex v : set)
      for (int a = 0; a < 3; ++a) {
        const Corner& c = net.corner[v];
        const bool is_on_face = lattice.is_low(c, a) || lattice.is_high(c, a);
        x[v][a] = is_on_face ? lattice.wall(a, c[a]) : x[set[0]][a];
      }
}

void Mates::add_to(std::vector<VertexIndex>& vertices) const {
  const std::size_t count = vertices.size();
  for (std::size_t i = 0; i < count && !sets_.empty(); ++i)
    if (const std::uint32_t set = set_of_[vertices[i]]; set != kNone)
      vertices.insert(vertices.end(), sets_[set].begin(), sets_[set].end());
}

namespace {

constexpr int kHalvings = 3;  // then back to the start
constexpr int kJoin = 5;      // then one vertex for the corner

class Settling {
 public:
  Settling(Net& net, const Groups<>& quads_at, const Lattice& lattice, std::vector<Vec3>& x, const RunContext& context,
           const Mates& mates)
      : net_(net),
        quads_at_(quads_at),
        lattice_(lattice),
        x_(x),
        context_(context),
        mates_(mates),
        level_(x.size(), 0),
        may_yield_(x.size(), 1) {
    for (VertexIndex v = 0; v < x.size(); ++v)
      if (net.shares_corner[v]) copies_[net.corner[v]].push_back(v);
  }

  ResolvedNet run() && {
    choose_diagonals(net_, lattice_, x_);
    resolved_.world.resize(x_.size());
    parallel_for(x_.size(), [&](std::size_t v) { resolved_.world[v] = lattice_.to_world(x_[v]); });
    Conflicts found = search().all(context_);
    resolved_.conflicts = found.invalid.size();
    resolved_.sharp = found.sharp.size();
    while (!found.empty()) {
      context_.check();
      const std::vector<VertexIndex> moved = retreat(found);
      found = search().near(moved, context_);
    }
    resolved_.moved_back =
        static_cast<std::uint64_t>(std::count_if(level_.begin(), level_.end(), [](auto l) { return l > 0; }));
    return std::move(resolved_);
  }

 private:
  ConflictSearch search() const { return {net_, lattice_, x_, resolved_.world, may_yield_}; }

  std::vector<VertexIndex> vertices_of(const std::vector<std::uint32_t>& quads) const {
    std::vector<VertexIndex> vertices;
    for (const std::uint32_t q : quads) vertices.insert(vertices.end(), net_.quads[q].v.begin(), net_.quads[q].v.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  std::vector<VertexIndex> retreat(const Conflicts& found) {
    std::vector<VertexIndex> vertices = vertices_of(found.sharp), moved;
    std::erase_if(vertices, [&](VertexIndex v) { return !may_yield_[v]; });
    const std::vector<VertexIndex> must = vertices_of(found.invalid);
    vertices.insert(vertices.end(), must.begin(), must.end());
    mates_.add_to(vertices);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const VertexIndex v : vertices) step_back(v, moved);
    for (const VertexIndex v : moved) {
      resolved_.world[v] = lattice_.to_world(x_[v]);
      for (const std::uint32_t q : quads_at_[v]) choose_diagonal(net_, lattice_, x_, q);
    }
    return moved;
  }

  void step_back(VertexIndex v, std::vector<VertexIndex>& moved) {
    const std::uint8_t level = level_[v] = static_cast<std::uint8_t>(std::min<int>(level_[v] + 1, kJoin));
    if (level > kHalvings) may_yield_[v] = 0;
    const bool joins = level == kJoin && net_.shares_corner[v];
    if (joins) return join_corner(v, moved);
    x_[v] = level <= kHalvings ? (x_[v] + net_.start[v]) / 2 : net_.start[v];
    moved.push_back(v);
  }

  void join_corner(VertexIndex v, std::vector<VertexIndex>& moved) {
    const std::vector<VertexIndex>& copies = copies_.at(net_.corner[v]);
    const VertexIndex one = copies.front();
    for (const VertexIndex copy : copies) {
      x_[copy] = net_.start[copy] = lattice_.at(net_.corner[v]);
      net_.shares_corner[copy] = 0;
      level_[copy] = kJoin;
      resolved_.joined += copy != one;
      moved.push_back(copy);
      for (const std::uint32_t q : quads_at_[copy]) {
        for (VertexIndex& corner : net_.quads[q].v)
          if (corner == copy) corner = one;
      }
    }
  }

  Net& net_;
  const Groups<>& quads_at_;  // as it was before corners were joined
  const Lattice& lattice_;
  std::vector<Vec3>& x_;
  const RunContext& context_;
  const Mates& mates_;
  std::vector<std::uint8_t> level_, may_yield_;
  std::map<Corner, std::vector<VertexIndex>> copies_;
  ResolvedNet resolved_;
};

}  // namespace

ResolvedNet resolve_conflicts(Net& net, const Groups<>& quads_at, const Lattice& lattice, std::vector<Vec3>& x,
                              const RunContext& context, const Mates& mates) {
  return Settling(net, quads_at, lattice, x, context, mates).run();
}

}  // namespace octafront::nets
