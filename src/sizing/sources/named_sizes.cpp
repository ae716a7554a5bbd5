#include "sizing/sources/named_sizes.h"

#include <octafront/error.h>
#include <octafront/surface_mesh.h>

#include "base/core/utf8.h"
#include "base/geometry/triangle_tree.h"
#include "base/mesh/complex.h"
#include "base/mesh/curve_names.h"
#include "sizing/prediction/affordable.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include <fmt/core.h>

namespace octafront {

namespace {

/// Samples inside a region lie on a grid of this spacing, in sizes: between them sizes grow by a tenth.
constexpr double kInside = 1.5;
/// The same along a curve.
constexpr double kAlong = 0.5;
/// Names that a message lists at most.
constexpr std::size_t kMostListed = 12;

class Named {
 public:
  Named(const KnownSurface& known, const SizeOptions& options)
      : known_(known), surface_(known.mesh()), options_(options) {
    result_.face.assign(surface_.triangles.size(), std::numeric_limits<double>::infinity());
    for (std::uint32_t r = 0; r < region_count(surface_); ++r) names_.insert(region_name(surface_, r));
    for (const std::string& name : surface_.patch_names)
      if (!name.empty()) names_.insert(name);
  }

  NamedSizes run() {
    for (NamedSize named : options_.named) {
      // As those of the surface are.
      NameCleaning().clean(named.name);
      const double h = std::max(named.size, options_.min_size.value_or(0));
      const bool is_region = ask_region(named.name, h), is_patch = ask_patch(named.name, h);
      if (!ask_curve(named.name, h) && !is_region && !is_patch) throw_unknown(named.name);
    }
    return std::move(result_);
  }

 private:
  bool ask_region(const std::string& name, double h) {
    std::uint32_t region = 0;
    while (region < region_count(surface_) && region_name(surface_, region) != name) ++region;
    if (region == region_count(surface_)) return false;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t)
      for (const std::uint32_t side : surface_.sides_of(t))
        if (side == region) result_.face[t] = std::min(result_.face[t], h);
    add_inside(boundary_of_region(surface_, region), name, h);
    return true;
  }

  /// Points all over the inside of a region, so that its size holds in the middle too.
  void add_inside(const SurfaceMesh& boundary, const std::string& name, double h) {
    const double count = kTetsPerCube * std::abs(enclosed_volume(boundary)) / (h * h * h);
    require_affordable(fmt::format("size {:.4g} in \"{}\"", h, name), count);
    const TriangleTree tree(boundary);
    const Box3 box = tree.box();
    const double step = kInside * h;
    for (double z = box.lo.z + step / 2; z < box.hi.z; z += step)
      for (double y = box.lo.y + step / 2; y < box.hi.y; y += step)
        for (double x = box.lo.x + step / 2; x < box.hi.x; x += step)
          if (tree.contains({x, y, z})) result_.points.push_back({{x, y, z}, {}, h});
  }

  bool ask_patch(const std::string& name, double h) {
    bool found = false;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const std::uint32_t patch = surface_.patch_of(t);
      if (patch >= surface_.patch_names.size() || surface_.patch_names[patch] != name) continue;
      result_.face[t] = std::min(result_.face[t], h);
      found = true;
    }
    return found;
  }

  bool ask_curve(const std::string& name, double h) {
    const EdgeTable& table = known_.edges();
    bool found = false;
    std::vector<std::uint32_t> patches;
    for (std::size_t e = 0; e < table.size(); ++e) {
      patches.clear();
      for (const HalfEdge half : table.uses(e)) patches.push_back(surface_.patch_of(half / 3));
      std::sort(patches.begin(), patches.end());
      patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
      if (patches.size() < 2 && table.uses(e).size() == 2) continue;
      const std::string here = curve_name(patches, surface_.patch_names);
      if (!here.empty()) names_.insert(here);
      if (here != name) continue;
      found = true;
      const Vec3 a = surface_.points[table.edges[e][0]], b = surface_.points[table.edges[e][1]];
      const int parts = std::max(1, static_cast<int>(std::min(1e6, std::ceil(distance(a, b) / (kAlong * h)))));
      for (int i = 0; i <= parts; ++i) result_.points.push_back({a + (b - a) * (i / double(parts)), {}, h});
    }
    return found;
  }

  [[noreturn]] void throw_unknown(const std::string& name) const {
    std::string list;
    std::size_t listed = 0;
    for (const std::string& known : names_) {
      if (++listed > kMostListed) break;
      list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", known);
    }
    throw OptionError(fmt::format("no region, patch or curve is called \"{}\"; there are {}{}", name, list,
                                  names_.size() > kMostListed ? ", ..." : ""));
  }

  const KnownSurface& known_;
  const SurfaceMesh& surface_;
  const SizeOptions& options_;
  std::set<std::string> names_;
  NamedSizes result_;
};

}  // namespace

NamedSizes named_sizes(const KnownSurface& surface, const SizeOptions& options) {
  return options.named.empty() ? NamedSizes{} : Named(surface, options).run();
}

}  // namespace octafront
