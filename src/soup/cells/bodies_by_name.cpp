#include <octafront/complex.h>

#include "base/core/disjoint_sets.h"
#include "base/geometry/same_place.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/core.h>

namespace octafront {
namespace {

class PartsByName {
 public:
  explicit PartsByName(const SurfaceMesh& surface) : surface_(surface), first_(first_at_place(surface.points)) {
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) faces_of_[named(surface.patch_of(t))].push_back(t);
    part_of_.assign(surface.triangles.size(), kNone);
  }

  std::vector<Body> bodies() {
    std::vector<std::size_t> open;
    for (const auto& [patch, faces] : faces_of_) {
      if (is_closed(faces)) {
        for (const std::size_t t : faces) part_of_[t] = patch;
      } else {
        open.insert(open.end(), faces.begin(), faces.end());
      }
    }
    name_open_parts(open);
    std::map<std::uint32_t, std::vector<std::size_t>> of_part;
    for (std::size_t t = 0; t < part_of_.size(); ++t) of_part[part_of_[t]].push_back(t);
    std::vector<Body> all;
    for (const auto& [patch, faces] : of_part) all.push_back({name_of(patch), surface_of(faces)});
    return all;
  }

 private:
  /// Each of its edges belongs to an even number of the faces.
  bool is_closed(const std::vector<std::size_t>& faces) const {
    std::vector<std::array<VertexIndex, 2>> edges;
    for (const std::size_t t : faces)
      for (int i = 0; i < 3; ++i) {
        const VertexIndex a = corner(t, i), b = corner(t, (i + 1) % 3);
        edges.push_back({std::min(a, b), std::max(a, b)});
      }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0, end; i < edges.size(); i = end) {
      for (end = i; end < edges.size() && edges[end] == edges[i];) ++end;
      if ((end - i) % 2 == 1) return false;
    }
    return true;
  }

  /// What hangs together is one part, by the patch that has most of its faces.
  void name_open_parts(const std::vector<std::size_t>& open) {
    DisjointSets hanging_together(surface_.points.size());
    for (const std::size_t t : open)
      for (int i = 1; i < 3; ++i) hanging_together.join(corner(t, 0), corner(t, i));
    const auto set_of = [&](std::size_t t) { return hanging_together.find(corner(t, 0)); };
    std::map<VertexIndex, std::map<std::uint32_t, std::size_t>> faces;
    for (const std::size_t t : open) ++faces[set_of(t)][named(surface_.patch_of(t))];
    for (const std::size_t t : open) {
      const auto& counts = faces[set_of(t)];
      part_of_[t] = std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
                      return a.second < b.second;
                    })->first;
    }
  }

  /// The first patch of the same name.
  std::uint32_t named(std::uint32_t patch) const {
    const auto& names = surface_.patch_names;
    if (patch >= names.size() || names[patch].empty()) return patch;
    return static_cast<std::uint32_t>(std::find(names.begin(), names.end(), names[patch]) - names.begin());
  }

  VertexIndex corner(std::size_t t, int i) const { return first_[surface_.triangles[t][i]]; }

  std::string name_of(std::uint32_t patch) const {
    const auto& names = surface_.patch_names;
    return patch < names.size() && !names[patch].empty() ? names[patch] : fmt::format("part_{}", patch + 1);
  }

  SurfaceMesh surface_of(const std::vector<std::size_t>& faces) const {
    SurfaceMesh part;
    std::map<VertexIndex, VertexIndex> number;
    bool has_patches = false;
    for (const std::size_t t : faces) {
      Triangle triangle;
      for (int i = 0; i < 3; ++i) {
        const VertexIndex v = surface_.triangles[t][i];
        const auto [at, is_new] = number.try_emplace(v, static_cast<VertexIndex>(part.points.size()));
        if (is_new) part.points.push_back(surface_.points[v]);
        triangle[i] = at->second;
      }
      part.triangles.push_back(triangle);
      part.patch.push_back(surface_.patch_of(t));
      has_patches |= part.patch.back() != part.patch.front();
    }
    if (has_patches) {
      part.patch_names = surface_.patch_names;
    } else {
      part.patch.clear();
    }
    return part;
  }

  const SurfaceMesh& surface_;
  std::vector<VertexIndex> first_;
  std::map<std::uint32_t, std::vector<std::size_t>> faces_of_;  ///< per patch
  std::vector<std::uint32_t> part_of_;                          ///< per face: a patch, the first of its body
};

}  // namespace

std::vector<Body> bodies_by_name(const SurfaceMesh& surface) {
  return PartsByName(surface).bodies();
}

}  // namespace octafront
