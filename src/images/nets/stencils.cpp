#include "images/nets/stencils.h"

#include "base/core/parallel.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace octafront::nets {

namespace {

/// An edge of the net at a vertex as one of its quads has it.
struct Use {
  VertexIndex to;
  std::uint8_t box;
};

/// Two for each quad at a vertex, of which there are twelve at most.
struct Uses {
  std::array<Use, 24> of;
  int count = 0;

  Uses(const Net& net, std::span<const std::uint32_t> quads, VertexIndex v) {
    for (const std::uint32_t q : quads) {
      const Quad& quad = net.quads[q];
      const auto i = static_cast<int>(std::find(quad.v.begin(), quad.v.end(), v) - quad.v.begin());
      of[count++] = {quad.v[(i + 1) % 4], quad.box};
      of[count++] = {quad.v[(i + 3) % 4], quad.box};
    }
    std::sort(of.begin(), of.begin() + count, [](const Use& a, const Use& b) { return a.to < b.to; });
  }
};

/// A neighbour, and whether the edge to it is one of a curve.
struct Link {
  VertexIndex to : 31;
  VertexIndex is_curve : 1;
};

void collect(const Net& net, const Groups<>& quads_at, VertexIndex v, std::vector<Link>& links) {
  links.clear();
  const Uses uses(net, quads_at[v], v);
  for (int i = 0; i < uses.count;) {
    int end = i;
    bool bends = false;
    for (; end < uses.count && uses.of[end].to == uses.of[i].to; ++end) bends |= uses.of[end].box != uses.of[i].box;
    links.push_back({uses.of[i].to & 0x7fffffffu, end - i > 2 || bends ? 1u : 0u});
    i = end;
  }
}

/// What collect(v, items) leaves for each vertex. It is called twice.
template <class Item, class Collect>
Groups<Item> per_vertex(std::size_t n, const Collect& collect_at) {
  RawVector<std::uint32_t> first(n + 1, 0);
  PerThread<std::vector<Item>> scratch;
  parallel_for(n, [&](std::size_t v) {
    std::vector<Item>& items = scratch.local();
    collect_at(static_cast<VertexIndex>(v), items);
    first[v + 1] = static_cast<std::uint32_t>(items.size());
  });
  for (std::size_t v = 0; v < n; ++v) first[v + 1] += first[v];
  RawVector<Item> all(first[n]);
  parallel_for(n, [&](std::size_t v) {
    std::vector<Item>& items = scratch.local();
    collect_at(static_cast<VertexIndex>(v), items);
    std::copy(items.begin(), items.end(), all.begin() + first[v]);
  });
  return {std::move(first), std::move(all)};
}

}  // namespace

Stencils::Stencils(const Net& net, const Groups<>& quads_at) {
  const std::size_t n = net.corner.size();
  const auto links =
      per_vertex<Link>(n, [&](VertexIndex v, std::vector<Link>& found) { collect(net, quads_at, v, found); });
  // A lone edge of a curve at a vertex is one in which a surface touches itself.
  std::vector<std::uint8_t> is_on_curve(n);
  parallel_for(n, [&](std::size_t v) {
    is_on_curve[v] = std::ranges::count_if(links[v], [](const Link& l) { return l.is_curve != 0; }) > 1;
  });
  const auto counts = [&](VertexIndex of, const Link& l) { return !is_on_curve[of] || l.is_curve != 0; };
  own_ = per_vertex<VertexIndex>(n, [&](VertexIndex v, std::vector<VertexIndex>& found) {
    found.clear();
    for (const Link& l : links[v])
      if (counts(v, l)) found.push_back(l.to);
  });
  users_ = per_vertex<VertexIndex>(n, [&](VertexIndex v, std::vector<VertexIndex>& found) {
    found.clear();
    for (const Link& l : links[v])
      if (counts(l.to, l)) found.push_back(l.to);
  });
}

}  // namespace octafront::nets
