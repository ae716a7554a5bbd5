#include "base/core/parallel.h"
#include "images/nets/conflicts.h"
#include "images/nets/net_steps.h"

#include <algorithm>
#include <map>

namespace octafront::nets {

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
