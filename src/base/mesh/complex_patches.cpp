#include "base/mesh/complex_patches.h"

#include <octafront/surface_mesh.h>

#include "base/mesh/complex.h"
#include "base/mesh/label_at.h"

#include <map>
#include <utility>
#include <vector>

#include <fmt/core.h>

namespace octafront {

namespace {

std::string name_of_sides(const SurfaceMesh& complex, const Sides& sides) {
  const auto [front, behind] = sides;
  if (front == kNone) return region_name(complex, behind);
  return region_name(complex, behind) + "|" + region_name(complex, front);
}

}  // namespace

void divide_by_sides(SurfaceMesh& complex) {
  using Key = std::pair<std::uint32_t, Sides>;
  std::map<Key, std::uint32_t> first;  // triangle
  std::map<std::uint32_t, int> pairs;
  for (std::uint32_t t = 0; t < complex.triangles.size(); ++t)
    if (first.try_emplace({complex.patch_of(t), complex.sides[t]}, t).second) ++pairs[complex.patch_of(t)];
  std::map<std::pair<std::uint32_t, std::uint32_t>, Key> in_order;  // by patch and first triangle
  for (const auto& [key, triangle] : first) in_order[{key.first, triangle}] = key;
  std::map<Key, std::uint32_t> number;
  std::vector<std::string> names;
  std::vector<std::int64_t> labels;
  for (const auto& [place, key] : in_order) {
    const auto& [patch, sides] = key;
    number[key] = static_cast<std::uint32_t>(names.size());
    const std::string given = patch < complex.patch_names.size() ? complex.patch_names[patch] : std::string();
    const std::string by_sides = name_of_sides(complex, sides);
    if (!complex.patch_labels.empty()) labels.push_back(label_at(complex.patch_labels, patch));
    names.push_back(given.empty() ? by_sides : pairs[patch] == 1 ? given : fmt::format("{} ({})", given, by_sides));
  }
  std::vector<std::uint32_t> patch;
  for (std::uint32_t t = 0; t < complex.triangles.size(); ++t)
    patch.push_back(number[{complex.patch_of(t), complex.sides[t]}]);
  complex.patch = std::move(patch);
  complex.patch_names = std::move(names);
  complex.patch_labels = std::move(labels);
}

std::vector<Sides> sides_of_patches(const SurfaceMesh& complex) {
  std::vector<Sides> sides;
  for (std::size_t t = 0; t < complex.sides.size(); ++t) {
    if (complex.patch[t] >= sides.size()) sides.resize(complex.patch[t] + 1);
    sides[complex.patch[t]] = complex.sides[t];
  }
  return sides;
}

}  // namespace octafront
