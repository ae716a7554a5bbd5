#include "base/dual/primal.h"

#include "base/core/flat_map.h"

#include <algorithm>

namespace octafront::dual {
namespace {

/// The two other corners of a tetrahedron, so that all four are in positive order.
constexpr std::array<std::array<std::array<std::uint8_t, 2>, 4>, 4> kOthers = [] {
  std::array<std::array<std::array<std::uint8_t, 2>, 4>, 4> others{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      if (i == j) continue;
      std::array<std::uint8_t, 2> two{};
      std::size_t n = 0;
      for (std::uint8_t k = 0; k < 4; ++k)
        if (k != i && k != j) two[n++] = k;
      const std::array<std::size_t, 4> order{i, j, two[0], two[1]};
      std::size_t inversions = 0;
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = a + 1; b < 4; ++b) inversions += order[a] > order[b];
      others[i][j] = inversions % 2 == 0 ? two : std::array<std::uint8_t, 2>{two[1], two[0]};
    }
  return others;
}();

}  // namespace

Primal::Primal(const TetMesh& of)
    : mesh(of),
      across(half_face_neighbors(of.tets, of.points.size())),
      layers(of),
      corners(group_by_owner(of.points.size(), static_cast<std::uint32_t>(4 * of.tets.size()),
                             [&](std::uint32_t c) { return of.tets[c / 4][c % 4]; })) {
  find_walls();
  for (const auto& [a, b] : of.curve_edges) curves_.push_back(sorted_edge(a, b));
  std::sort(curves_.begin(), curves_.end());
}

void Primal::find_walls() {
  FlatMap<Triangle, std::uint32_t> patch_at(mesh.boundary.size() + mesh.interfaces.size());
  std::vector<bool> is_at_interface(mesh.points.size(), false);
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f)
    patch_at.find_or_add(face_key(mesh.boundary[f])) = mesh.patch.empty() ? 0 : mesh.patch[f];
  for (std::size_t f = 0; f < mesh.interfaces.size(); ++f) {
    patch_at.find_or_add(face_key(mesh.interfaces[f])) = mesh.interface_patch.empty() ? 0 : mesh.interface_patch[f];
    for (const VertexIndex v : mesh.interfaces[f]) is_at_interface[v] = true;
  }
  is_wall_.assign(across.size(), false);
  for (HalfFace h = 0; h < across.size(); ++h) {
    const bool is_outside = across[h] == kNone;
    const Triangle face = corners_of(mesh.tets, h);
    const bool may_be_listed =
        is_outside || std::ranges::all_of(face, [&](VertexIndex v) { return is_at_interface[v]; });
    const std::uint32_t* patch = may_be_listed ? patch_at.find(face_key(face)) : nullptr;
    is_wall_[h] = is_outside || patch != nullptr || region_of(h / 4) != region_of(across[h] / 4);
    if (patch != nullptr) patches_.emplace_back(h, *patch);
  }
}

std::uint32_t Primal::patch_of(HalfFace h) const {
  const auto at = std::ranges::lower_bound(patches_, h, {}, &std::pair<HalfFace, std::uint32_t>::first);
  return at != patches_.end() && at->first == h ? at->second : kNone;
}

bool Primal::is_curve(VertexIndex a, VertexIndex b) const {
  return std::ranges::binary_search(curves_, sorted_edge(a, b));
}

Spoke Primal::spoke(Corner from, VertexIndex to) const {
  const Corner end = corner_at(from / 4, to), first = from - from % 4;
  const auto& [in, out] = kOthers[from % 4][end % 4];
  // One goes out by the face that the corner which one came in by is not on.
  return {from, end, first + out, first + in};
}

}  // namespace octafront::dual
