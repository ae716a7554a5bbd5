#include <octafront/quality.h>
#include <octafront/run_context.h>

#include "base/core/wording.h"
#include "base/geometry/same_place.h"
#include "base/mesh/edge_table.h"
#include "base/places/places.h"
#include "report/picture/scales.h"
#include "report/picture/scene.h"

#include <algorithm>
#include <optional>

#include <fmt/core.h>

namespace octafront {

namespace {

using Color = PictureOptions::Color;

/// The scene of a surface, triangle by triangle.
class SurfaceScene {
 public:
  SurfaceScene(const SurfaceMesh& surface, const PictureOptions& options) : surface_(surface), options_(options) {
    color_ = chosen_color();
    if (color_ == Color::kSize) sizes_ = size_range(surface);
    if (options.cut && !surface.points.empty()) plane_.emplace(*options.cut, surface.points);
    mark_places();
  }

  Scene made() {
    vertex_ = first_at_place(surface_.points);
    scene_.marks = options_.highlight.size();
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t)
      if (is_shown(t)) add(t);
    using Edges = PictureOptions::Edges;
    if (options_.edges != Edges::kOff) find_features(scene_, corners_, parts_, std::vector<char>(corners_.size(), 1));
    if (options_.edges == Edges::kFeatures) smooth_normals(scene_, corners_);
    name_all();
    make_legend();
    scene_.caption.push_back(fmt::format("{} triangles", in_groups(surface_.triangles.size())));
    return std::move(scene_);
  }

 private:
  std::uint32_t region_behind(std::size_t t) const { return surface_.sides_of(t)[1]; }
  std::uint32_t region_before(std::size_t t) const { return surface_.sides_of(t)[0]; }
  bool has_regions() const {
    return std::ranges::any_of(
        surface_.sides, [](const Sides& s) { return (s[0] != kNone && s[0] > 0) || (s[1] != kNone && s[1] > 0); });
  }
  Color chosen_color() const {
    if (options_.color != Color::kAuto) return options_.color;
    if (!options_.highlight.empty()) return Color::kPlain;
    if (has_regions()) return Color::kRegion;
    return std::ranges::any_of(surface_.patch, [&](std::uint32_t p) { return p != surface_.patch[0]; }) ? Color::kPatch
                                                                                                        : Color::kPlain;
  }
  bool is_shown(std::size_t t) const {
    return !plane_ || std::ranges::any_of(surface_.triangles[t],
                                          [&](VertexIndex v) { return !plane_->beyond(surface_.points[v]); });
  }

  void mark_places() {
    if (options_.highlight.empty()) return;
    marks_.assign(surface_.triangles.size(), kNone);
    const EdgeTable edges = make_edge_table(surface_.points.size(), surface_.triangles);
    const SurfacePlaces places(surface_, &edges);
    for (std::uint32_t k = 0; k < options_.highlight.size(); ++k)
      mark(places.at("--highlight", place_of("--highlight", options_.highlight[k])), k);
  }
  void mark(const SurfaceItems& items, std::uint32_t place) {
    for (const std::uint32_t t : items.triangles) marks_[t] = place;
    for (const Edge& e : items.edges)
      scene_.marked_lines.push_back({place, {surface_.points[e[0]], surface_.points[e[1]]}});
    if (items.regions.empty()) return;
    const auto is_of = [&](std::uint32_t region) {
      return std::ranges::find(items.regions, region) != items.regions.end();
    };
    for (std::size_t t = 0; t < marks_.size(); ++t)
      if (is_of(region_before(t)) || is_of(region_behind(t))) marks_[t] = place;
  }

  Rgb colour_of_region(std::uint32_t region) const { return region == kNone ? kInside : colour_of_part(region); }
  /// As seen from in front, and from behind.
  std::array<Rgb, 2> colours(std::size_t t) const {
    const bool has_both = region_before(t) != kNone;
    const auto one = [&](Rgb colour) { return std::array{colour, has_both ? colour : kInside}; };
    if (!marks_.empty() && marks_[t] != kNone) return {colour_of_mark(marks_[t]), colour_of_mark(marks_[t])};
    switch (color_) {
      case Color::kQuality: {
        const Triangle& v = surface_.triangles[t];
        return one(
            on_scale(kPoorToGood, radius_ratio(surface_.points[v[0]], surface_.points[v[1]], surface_.points[v[2]])));
      }
      case Color::kSize:
        return one(on_scale(kSmallToLarge, sizes_.share(mean_edge(surface_, t))));
      case Color::kRegion:
        return {colour_of_region(region_behind(t)), colour_of_region(region_before(t))};
      case Color::kPatch:
        return one(colour_of_part(surface_.patch_of(t)));
      default:
        return one(kGrey);
    }
  }
  void add(std::size_t t) {
    const Triangle& v = surface_.triangles[t];
    const auto [front, back] = colours(t);
    const std::uint32_t part = color_ == Color::kRegion ? region_behind(t) : surface_.patch_of(t);
    scene_.faces.push_back({front, back, part, marks_.empty() ? kNone : marks_[t]});
    using Edges = PictureOptions::Edges;
    const bool is_thin = options_.edges == Edges::kAuto || options_.edges == Edges::kElements;
    const EdgeLine line = is_thin ? EdgeLine::kThin : EdgeLine::kAbsent;
    scene_.triangles.push_back({{surface_.points[v[0]], surface_.points[v[1]], surface_.points[v[2]]},
                                static_cast<std::uint32_t>(scene_.faces.size() - 1),
                                {line, line, line}});
    corners_.push_back({vertex_[v[0]], vertex_[v[1]], vertex_[v[2]]});
    parts_.push_back(surface_.patch_of(t));
  }

  void name_all() {
    const bool is_of_regions = color_ == Color::kRegion;
    std::uint32_t count = 0;
    for (const SceneFace& face : scene_.faces)
      if (face.part != kNone) count = std::max(count, face.part + 1);
    const auto& regions = surface_.region_names;
    for (std::uint32_t p = 0; p < count; ++p)
      scene_.part_names.push_back(is_of_regions ? region_label(p < regions.size() ? regions[p] : "", p, count)
                                                : patch_label(surface_.patch_names, p));
  }
  void make_legend() {
    Legend& legend = scene_.legend;
    list_marks(legend, options_.highlight);
    if (color_ == Color::kQuality) {
      std::vector<double> ratio;
      for (const Triangle& v : surface_.triangles)
        ratio.push_back(radius_ratio(surface_.points[v[0]], surface_.points[v[1]], surface_.points[v[2]]));
      quality_legend(legend, counts_in_parts(ratio));
    }
    if (color_ == Color::kSize) size_legend(legend, sizes_, options_.unit);
    if (color_ == Color::kRegion || color_ == Color::kPatch) list_parts(scene_, color_);
  }

  const SurfaceMesh& surface_;
  const PictureOptions& options_;
  Color color_ = Color::kPlain;
  SizeRange sizes_;
  std::optional<CutPlane> plane_;
  std::vector<std::uint32_t> marks_;  ///< per triangle its place, or kNone; empty: none has any
  Scene scene_;
  std::vector<VertexIndex> vertex_;  ///< per point the first at its place
  std::vector<Triangle> corners_;
  std::vector<std::uint32_t> parts_;
};

}  // namespace

Scene scene_of(const SurfaceMesh& surface, const PictureOptions& options, const RunContext& context) {
  context.check();
  return SurfaceScene(surface, options).made();
}

}  // namespace octafront
