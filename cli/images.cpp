#include "images.h"

#include <octafront/error.h>
#include <octafront/image_surface.h>

#include "domain.h"
#include "text.h"

#include <utility>

#include <fmt/core.h>

namespace octafront::cli {

namespace {

std::string grid_in_words(const ImageGrid& grid) {
  return fmt::format("{} x {} x {} voxels of {:.6g} x {:.6g} x {:.6g}", grid.size[0], grid.size[1], grid.size[2],
                     length(grid.axes[0]), length(grid.axes[1]), length(grid.axes[2]));
}

VoxelBox box_of(const std::array<VoxelRange, 3>& crop, const ImageGrid& grid) {
  VoxelBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lo[axis] = crop[axis].first.value_or(0);
    box.hi[axis] = crop[axis].second ? *crop[axis].second + 1 : grid.size[axis];
  }
  return box;
}

ImageRegions regions_of(Session& session) {
  const ImageArguments& a = session.arguments().image;
  ImageRegions regions = a.regions;
  if (!a.names.empty()) regions.labels.names = read_label_names(a.names, session.context());
  return regions;
}

}  // namespace

bool is_image_input(const Arguments& a) {
  if (!a.input.empty() && is_image(a.input)) return true;
  if (!a.image.given.empty())
    throw OptionError(
        fmt::format("{} is for images, and {} is none that is known here", a.image.given.front(), a.input.string()));
  return false;
}

Image read_image_input(Session& session) {
  const Arguments& a = session.arguments();
  const std::vector<std::string> files(a.bodies.begin(), a.bodies.end());
  Image image = read_image(files, a.image.choice, session.context());
  session.say(fmt::format("{}: {}, {}\n", a.input.string(), image.format, grid_in_words(image.grid)));
  session.say_notes("reading", image.notes);
  image.notes.clear();
  if (a.image.crops) image = cropped(image, box_of(a.image.crop, image.grid));
  if (!a.image.spacing.empty()) {
    const std::vector<double>& s = a.image.spacing;
    const Vec3 spacing = s.size() == 1 ? Vec3{s[0], s[0], s[0]} : Vec3{s[0], s[1], s[2]};
    image = resampled(image, spacing, kind_of(image, regions_of(session)) == ImageRegions::Kind::kLabels,
                      session.context());
    session.say_notes("resampling", image.notes);
  }
  if (a.image.crops || !a.image.spacing.empty()) session.say(fmt::format("  taken: {}\n", grid_in_words(image.grid)));
  session.read_voxels(smallest_spacing(image.grid));
  return image;
}

SurfaceFile read_image_domain(Session& session) {
  const Arguments& a = session.arguments();
  const Image image = read_image_input(session);
  try {
    Complex complex = complex_of_image(image, regions_of(session), session.context());
    tell_regions(session, complex);
    return {std::move(complex.surface), image.format, {}};
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", a.input.string(), error.what()));
  }
}

}  // namespace octafront::cli
