#include "base/mesh/feature_patches.h"

#include <octafront/surface_mesh.h>

#include "base/mesh/label_at.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Per triangle the part it lies in.
std::vector<std::uint32_t> parts_between_features(const SurfaceMesh& surface, const EdgeTable& table,
                                                  const Features& features, std::uint32_t& parts) {
  const RawVector<std::uint32_t> edge_of = table.edge_of_half_edge();
  std::vector<std::uint32_t> part(surface.triangles.size(), kNone), stack;
  parts = 0;
  for (std::uint32_t seed = 0; seed < part.size(); ++seed) {
    if (part[seed] != kNone) continue;
    part[seed] = parts;
    stack.push_back(seed);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t e = edge_of[3 * t + i];
        if (std::binary_search(features.edges.begin(), features.edges.end(), table.edges[e])) continue;
        for (const std::uint32_t use : table.uses(e)) {
          const std::uint32_t other = use / 3;
          if (part[other] != kNone || surface.patch_of(other) != surface.patch_of(t)) continue;
          part[other] = parts;
          stack.push_back(other);
        }
      }
    }
    ++parts;
  }
  return part;
}

std::vector<std::string> names_of(const SurfaceMesh& surface, const std::vector<std::uint32_t>& part,
                                  std::uint32_t parts) {
  std::vector<std::uint32_t> patch_of_part(parts, 0);
  for (std::size_t t = part.size(); t-- > 0;) patch_of_part[part[t]] = surface.patch_of(t);
  const std::uint32_t patches = 1 + *std::max_element(patch_of_part.begin(), patch_of_part.end());
  std::vector<std::uint32_t> pieces(patches, 0), seen(patches, 0);
  for (const std::uint32_t p : patch_of_part) ++pieces[p];
  std::vector<std::string> names;
  for (const std::uint32_t p : patch_of_part) {
    const std::string old = p < surface.patch_names.size() ? surface.patch_names[p] : std::string();
    const bool is_numbered = pieces[p] > 1 && !old.empty();
    names.push_back(is_numbered ? fmt::format("{}.{}", old, ++seen[p]) : old);
  }
  return names;
}

/// Each part keeps the number of its patch.
std::vector<std::int64_t> labels_of(const SurfaceMesh& surface, const std::vector<std::uint32_t>& part,
                                    std::uint32_t parts) {
  std::vector<std::int64_t> labels(parts);
  for (std::size_t t = 0; t < part.size(); ++t) labels[part[t]] = label_at(surface.patch_labels, surface.patch_of(t));
  return labels;
}

}  // namespace

std::uint32_t divide_into_patches(SurfaceMesh& surface, const EdgeTable& edges, const Features& features) {
  if (surface.triangles.empty()) return 0;
  std::uint32_t parts = 0;
  const std::vector<std::uint32_t> part = parts_between_features(surface, edges, features, parts);
  if (!surface.patch_names.empty()) surface.patch_names = names_of(surface, part, parts);
  if (!surface.patch_labels.empty()) surface.patch_labels = labels_of(surface, part, parts);
  surface.patch = part;
  return parts;
}

}  // namespace octafront
