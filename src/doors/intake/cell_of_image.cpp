#include <octafront/error.h>
#include <octafront/image.h>
#include <octafront/image_surface.h>

#include "base/mesh/complex.h"
#include "doors/intake/cell.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace octafront::intake {

namespace {

/// Layers of voxels around the cell of an image: what becomes of its faces is told by no more.
constexpr std::uint32_t kAround = 2;
/// Vertices of faces that reach into the cell lie within so many voxels of it.
constexpr double kNearCell = 3;
/// Vertices on the faces of the cell are there up to rounding, in voxels; then exactly.
constexpr double kOnFaceOfCell = 1e-6;
/// The name of what the cell has beside labels, which is left empty.
constexpr const char* kEmptyName = "outside of all labels";

/// The axis of the world that each axis of the image runs along.
std::array<int, 3> world_axes(const ImageGrid& grid) {
  std::array<int, 3> world{};
  for (int i = 0; i < 3; ++i) {
    const Vec3 step = grid.axes[i];
    int along = -1;
    for (int axis = 0; axis < 3; ++axis)
      if (step[axis] != 0) along = along < 0 ? axis : 3;
    if (along < 0 || along == 3)
      throw InputError(
          "the axes of the image are turned against x, y and z, so that it is no cell that is periodic along these: "
          "resample it along them first");
    world[i] = along;
  }
  return world;
}

/// Of each layer of voxels of a new image, along each axis, the one that it is a copy of.
using Layers = std::array<std::vector<std::size_t>, 3>;

Image with_layers(const Image& image, const Layers& layers) {
  const ImageGrid& grid = image.grid;
  Image out = image;
  for (std::size_t a = 0; a < 3; ++a) out.grid.size[a] = static_cast<std::uint32_t>(layers[a].size());
  out.values = std::visit(
      [&](const auto& values) -> Image::Values {
        std::decay_t<decltype(values)> all;
        all.reserve(out.grid.voxels());
        for (const std::size_t k : layers[2])
          for (const std::size_t j : layers[1])
            for (const std::size_t i : layers[0]) all.push_back(values[i + grid.size[0] * (j + grid.size[1] * k)]);
        return all;
      },
      image.values);
  return out;
}

void require_even_slices(const ImageGrid& grid, bool are_wrapped) {
  if (are_wrapped && !grid.slices.empty())
    throw InputError(
        "the slices of the image do not lie evenly, so that it is not periodic along them: resample it first");
}

/// The image with voxels from its other end added at both ends of these axes of its own.
Image with_wrapped_ends(const Image& image, const std::array<bool, 3>& wraps, std::uint32_t added_each) {
  const ImageGrid& grid = image.grid;
  require_even_slices(grid, wraps[2]);
  Layers layers;
  std::array<std::int64_t, 3> added{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t n = grid.size[a];
    added[a] = wraps[a] ? added_each : 0;
    for (std::int64_t i = -added[a]; i < n + added[a]; ++i)
      layers[a].push_back(static_cast<std::size_t>((i % n + n) % n));
  }
  Image out = with_layers(image, layers);
  out.grid.origin = grid.to_world({-double(added[0]), -double(added[1]), wraps[2] ? -double(added[2]) : grid.slice(0)});
  return out;
}

/// From the middles of the first voxels to those of their next copies along the wrapped axes; all of the image else.
PeriodicCell cell_of_grid(const ImageGrid& grid, const std::array<int, 3>& world, const std::array<bool, 3>& wraps) {
  Box3 box{grid.origin, grid.origin};
  std::array<bool, 3> along{};
  for (int i = 0; i < 3; ++i) {
    const int axis = world[i];
    const double step = grid.axes[i][axis];
    const double first = i == 2 ? grid.slice(0) : 0, last = i == 2 ? grid.slice(grid.size[2] - 1) : grid.size[i] - 1;
    const double from = grid.origin[axis] + (wraps[i] ? 0 : first - 1) * step;
    const double to = grid.origin[axis] + (wraps[i] ? grid.size[i] : last + 1) * step;
    box.lo[axis] = std::min(from, to), box.hi[axis] = std::max(from, to);
    along[axis] = wraps[i];
  }
  return cell_of(box, along);
}

/// Vertices of a net in copies of one dual cell get the same place in it.
class SamePlaces {
 public:
  SamePlaces(const ImageGrid& grid, const std::array<int, 3>& world, const std::array<bool, 3>& wraps,
             const PeriodicCell& cell)
      : grid_(grid), world_(world), wraps_(wraps), cell_(cell) {}

  void run(std::vector<Vec3>& points) const {
    std::map<std::array<std::int64_t, 3>, std::vector<VertexIndex>> first;  // vertices of cells that are no copies
    for (VertexIndex v = 0; v < points.size(); ++v)
      if (const auto [cell, moves] = canonical(points[v]); moves == std::array<std::int64_t, 3>{})
        first[cell].push_back(v);
    for (Vec3& p : points) {
      if (!is_near(p)) continue;
      const auto [cell, moves] = canonical(p);
      const auto at = first.find(cell);
      if (moves == std::array<std::int64_t, 3>{} || at == first.end()) continue;
      Vec3 shift;
      for (int i = 0; i < 3; ++i) {
        const int axis = world_[i];
        shift[axis] = static_cast<double>(moves[i]) * (grid_.axes[i][axis] > 0 ? 1 : -1) * cell_.period(axis);
      }
      const Vec3 here = p - shift;
      const VertexIndex nearest = *std::min_element(at->second.begin(), at->second.end(), [&](auto a, auto b) {
        return distance(points[a], here) < distance(points[b], here);
      });
      p = points[nearest] + shift;
    }
  }

 private:
  struct Canonical {
    std::array<std::int64_t, 3> cell, moves;  ///< moved by so many periods
  };

  /// Whether the cell may cut a face at p: farther out copies need not be alike, for the image ends there.
  bool is_near(Vec3 p) const {
    for (int i = 0; i < 3; ++i) {
      const double index = (p[world_[i]] - grid_.origin[world_[i]]) / grid_.axes[i][world_[i]];
      if (wraps_[i] && (index < -kNearCell || index > grid_.size[i] + kNearCell)) return false;
    }
    return true;
  }

  /// The dual cell, between the middles of voxels, that p lies in, as one of those of the image itself.
  Canonical canonical(Vec3 p) const {
    Canonical c{};
    for (int i = 0; i < 3; ++i) {
      const int axis = world_[i];
      const double index = (p[axis] - grid_.origin[axis]) / grid_.axes[i][axis];
      c.cell[i] = static_cast<std::int64_t>(std::floor(index));
      if (!wraps_[i]) continue;
      const auto n = static_cast<std::int64_t>(grid_.size[i]);
      c.moves[i] = c.cell[i] >= 0 ? c.cell[i] / n : -((n - 1 - c.cell[i]) / n);
      c.cell[i] -= c.moves[i] * n;
    }
    return c;
  }

  const ImageGrid& grid_;
  const std::array<int, 3>& world_;
  const std::array<bool, 3>& wraps_;
  const PeriodicCell& cell_;
};

/// The image as one of a cell and its margin, as PeriodicMargin says.
Image with_halves(const Image& image, const PeriodicMargin& margin) {
  require_even_slices(image.grid, margin[2] > 0);
  Layers layers;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto n = static_cast<std::int64_t>(image.grid.size[a]), m = static_cast<std::int64_t>(margin[a]);
    for (std::int64_t i = -m; i < (m > 0 ? n + 1 + m : n); ++i) {
      const std::int64_t from = i < 0 ? i + 1 : i > n ? i - 1 : i;
      layers[a].push_back(static_cast<std::size_t>((from % n + n) % n));
    }
  }
  return with_layers(image, layers);
}

/// The regions of the complex as bodies, by their numbers.
std::vector<Body> bodies_of_regions(const SurfaceMesh& complex) {
  std::vector<Body> bodies;
  for (std::uint32_t r = 0; r < region_count(complex); ++r)
    bodies.push_back({fmt::format("{}", r), boundary_of_region(complex, r)});
  return bodies;
}

/// Region 0 becomes empty, and the others get back what the image knows of them.
void name_regions(const SurfaceMesh& image, Complex& cut) {
  SurfaceMesh& s = cut.surface;
  std::vector<std::uint32_t> number;
  std::vector<std::string> names;
  std::vector<std::int64_t> labels;
  std::vector<double> volumes;
  for (std::size_t r = 0; r < s.region_names.size(); ++r) {
    const bool is_empty = s.region_names[r] == kEmptyName;
    number.push_back(is_empty ? kNone : static_cast<std::uint32_t>(names.size()));
    if (is_empty) continue;
    const auto of = static_cast<std::size_t>(std::stoul(s.region_names[r]));
    names.push_back(of < image.region_names.size() ? image.region_names[of] : std::string());
    if (of < image.region_labels.size()) labels.push_back(image.region_labels[of]);
    volumes.push_back(cut.volumes[r]);
  }
  SurfaceMesh kept{std::move(s.points), {}, {}, {}, {}};
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    Sides sides = s.sides[t];
    for (std::uint32_t& side : sides) side = side == kNone ? kNone : number[side];
    if (sides == Sides{kNone, kNone}) continue;
    Triangle corners = s.triangles[t];
    if (sides[1] == kNone) std::swap(sides[0], sides[1]), std::swap(corners[1], corners[2]);
    kept.triangles.push_back(corners), kept.sides.push_back(sides);
  }
  kept.region_names = std::move(names);
  if (labels.size() == volumes.size()) kept.region_labels = std::move(labels);
  s = std::move(kept);
  cut.volumes = std::move(volumes);
}

}  // namespace

Complex complex_of_periodic_values(const Image& image, const PeriodicSurfaces& surfaces,
                                   const std::array<bool, 3>& along, const RunContext& context) {
  const std::array<int, 3> world = world_axes(image.grid);
  std::array<bool, 3> wraps{};
  for (int i = 0; i < 3; ++i) wraps[i] = along[world[i]];
  Complex whole = surfaces.of(with_wrapped_ends(image, wraps, surfaces.margin));
  const PeriodicCell cell = cell_of(surfaces.cell, along);
  SamePlaces(image.grid, world, wraps, cell).run(whole.surface.points);
  std::vector<Body> bodies = bodies_of_regions(whole.surface);
  bodies.insert(bodies.begin(), box_body(kEmptyName, cell.box));
  ComplexOptions options;
  options.within_first = true;
  options.tolerance = 0;  // what came of one image fits as it is
  Complex cut = join_bodies(bodies, options, context);
  name_regions(whole.surface, cut);
  cut.notes = std::move(whole.notes);
  return cut;
}

Complex complex_of_periodic_image(const Image& image, const ImageRegions& regions, const std::array<bool, 3>& along,
                                  const RunContext& context) {
  const std::array<int, 3> world = world_axes(image.grid);
  std::array<bool, 3> wraps{};
  ImageRegions in_cell = regions;
  for (int i = 0; i < 3; ++i) {
    wraps[i] = along[world[i]];
    in_cell.margin[i] = wraps[i] ? kAround : 0;
  }
  Complex complex = complex_of_image(with_halves(image, in_cell.margin), in_cell, context);
  const PeriodicCell cell = cell_of_grid(image.grid, world, wraps);
  const double within = kOnFaceOfCell * smallest_spacing(image.grid);
  for (Vec3& p : complex.surface.points) p = put_on_faces(p, cell.box, cell.along, {within, within, within});
  complex.notes.push_back(
      "the image is taken as periodic: its cell goes from the middle of the first voxels to that of their "
      "next copies");
  return complex;
}

}  // namespace octafront::intake
