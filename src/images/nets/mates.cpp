
#include "images/nets/conflicts.h"

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

}  // namespace octafront::nets
