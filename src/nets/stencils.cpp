#include "nets/stencils.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>

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

}  // namespace

void Stencils::collect(const Net& net, const Groups<>& quads_at, VertexIndex v, std::vector<Link>& links) {
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

Stencils::Stencils(const Net& net, const Groups<>& quads_at)
    : curve_edges_(net.corner.size()), weight_(net.corner.size()) {
  const std::size_t n = net.corner.size();
  first_.assign(n + 1, 0);
  PerThread<std::vector<Link>> scratch;
  parallel_for(n, [&](std::size_t v) {
    std::vector<Link>& links = scratch.local();
    collect(net, quads_at, static_cast<VertexIndex>(v), links);
    first_[v + 1] = static_cast<std::uint32_t>(links.size());
    const auto curves = static_cast<std::uint32_t>(
        std::count_if(links.begin(), links.end(), [](const Link& l) { return l.is_curve != 0; }));
    curve_edges_[v] = static_cast<std::uint8_t>(curves);
    weight_[v] = 1.0 / (curves > 1 ? curves : static_cast<std::uint32_t>(links.size()));
  });
  for (std::size_t v = 0; v < n; ++v) first_[v + 1] += first_[v];
  links_.resize(first_[n]);
  parallel_for(n, [&](std::size_t v) {
    std::vector<Link>& links = scratch.local();
    collect(net, quads_at, static_cast<VertexIndex>(v), links);
    std::copy(links.begin(), links.end(), links_.begin() + first_[v]);
  });
}

}  // namespace octafront::nets
