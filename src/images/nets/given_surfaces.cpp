#include "images/nets/given_surfaces.h"

#include <octafront/error.h>

#include "base/core/wording.h"
#include "base/geometry/same_place.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace octafront::nets {

namespace {

constexpr std::size_t kMostLabelsNamed = 10;

std::string known_labels(const LabelImage& image) {
  std::string words;
  for (std::size_t l = 0; l < image.labels.size() && l < kMostLabelsNamed; ++l)
    words += fmt::format("{}\"{}\" ({})", l == 0 ? "" : ", ", image.labels[l].name, image.labels[l].value);
  if (image.labels.size() > kMostLabelsNamed)
    words += fmt::format(" and {} more", image.labels.size() - kMostLabelsNamed);
  return words;
}

Label label_called(const LabelImage& image, const SurfaceOfLabel& given) {
  for (std::size_t l = 0; l < image.labels.size(); ++l)
    if (image.labels[l].name == given.label) return static_cast<Label>(l);
  for (std::size_t l = 0; l < image.labels.size(); ++l)
    if (fmt::format("{}", image.labels[l].value) == given.label) return static_cast<Label>(l);
  throw OptionError(fmt::format("`surface_of`: {} is for the label \"{}\", which the image does not have; it has {}",
                                given.name, given.label, known_labels(image)));
}

struct OpenEdges {
  std::size_t count = 0;
  Vec3 middle;  ///< of the first one
};

/// Edges along which triangles do not run as often one way as the other.
OpenEdges open_edges(const SurfaceMesh& surface) {
  struct Use {
    VertexIndex lo, hi;
    int way;
  };
  const std::vector<VertexIndex> first = first_at_place(surface.points);
  std::vector<Use> uses;
  for (const Triangle& t : surface.triangles)
    for (int i = 0; i < 3; ++i) {
      const VertexIndex a = first[t[i]], b = first[t[(i + 1) % 3]];
      if (a != b) uses.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  std::sort(uses.begin(), uses.end(),
            [](const Use& a, const Use& b) { return std::pair(a.lo, a.hi) < std::pair(b.lo, b.hi); });
  OpenEdges open;
  for (std::size_t i = 0, next = 0; i < uses.size(); i = next) {
    int sum = 0;
    for (; next < uses.size() && uses[next].lo == uses[i].lo && uses[next].hi == uses[i].hi; ++next)
      sum += uses[next].way;
    if (sum != 0 && open.count++ == 0) open.middle = (surface.points[uses[i].lo] + surface.points[uses[i].hi]) / 2;
  }
  return open;
}

void require_closed(const SurfaceOfLabel& given) {
  const OpenEdges open = open_edges(given.surface);
  if (open.count == 0 && !given.surface.triangles.empty()) return;
  throw InputError(
      fmt::format("the surface {} of label \"{}\" is not closed: {} on one side only, first at {}; octafront repair "
                  "closes holes and turns triangles",
                  given.name, given.label, counted(open.count, "edge has triangles", "edges have triangles"),
                  at_point(open.middle)));
}

void append(SurfaceMesh& all, const SurfaceMesh& more) {
  const auto before = static_cast<VertexIndex>(all.points.size());
  all.points.insert(all.points.end(), more.points.begin(), more.points.end());
  for (const Triangle& t : more.triangles) all.triangles.push_back({t[0] + before, t[1] + before, t[2] + before});
}

}  // namespace

double voxel_of(const ImageGrid& grid) {
  return std::max({length(grid.axes[0]), length(grid.axes[1]), length(grid.axes[2])});
}

std::vector<GivenSurface> given_surfaces(const LabelImage& image, const std::vector<SurfaceOfLabel>& given) {
  struct Parts {
    SurfaceMesh surface;
    std::string from;
  };
  std::vector<std::optional<Parts>> of_label(image.labels.size());
  for (const SurfaceOfLabel& one : given) {
    std::optional<Parts>& parts = of_label[label_called(image, one)];
    require_closed(one);
    if (!parts) parts.emplace();
    append(parts->surface, one.surface);
    parts->from += (parts->from.empty() ? "" : ", ") + one.name;
  }
  std::vector<GivenSurface> all;
  for (std::size_t l = 0; l < of_label.size(); ++l) {
    if (!of_label[l]) continue;
    const SurfaceMesh& surface = of_label[l]->surface;
    all.push_back({static_cast<Label>(l), image.labels[l].name, of_label[l]->from, std::abs(enclosed_volume(surface)),
                   TriangleTree(surface), WindingNumber(surface)});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const GivenSurface& a, const GivenSurface& b) { return a.volume < b.volume; });
  return all;
}

}  // namespace octafront::nets
