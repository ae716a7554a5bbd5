// Stacks of TIFF: the pages of a file, or files of a folder, one upon the other in order of their names.

#include "images/files/image_readers.h"
#include "images/files/tiff_pages.h"
#include "images/files/voxels.h"

#include <fmt/core.h>

namespace octafront::image {
namespace {

using namespace std::string_view_literals;

Image image_of(const io::Input& input, const TiffPages& pages) {
  Image image;
  image.format = "TIFF";
  image.unit = pages.unit == "mm" || pages.unit == "m" || pages.unit == "um" || pages.unit == "cm" ? pages.unit : "";
  if (pages.unit == "micron" || pages.unit == "\\u00B5m") image.unit = "um";
  image.grid.size = checked_sizes(input, pages.size);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = pages.spacing[axis] > 0 ? pages.spacing[axis] : 1;
    image.grid.axes[axis] = {};
    image.grid.axes[axis][static_cast<int>(axis)] = step;
    if (pages.spacing[axis] == 0)
      image.notes.push_back(fmt::format("the TIFF file has no spacing along axis {}; 1 is taken", axis));
  }
  check_grid(input, image.grid);
  image.values = values_of({pages.bytes.data(), pages.bytes.size()}, pages.stored, image.notes);
  return image;
}

}  // namespace

bool is_tiff(std::string_view head) {
  return head.starts_with("II*\0"sv) || head.starts_with("MM\0*"sv) || head.starts_with("II+\0"sv) ||
         head.starts_with("MM\0+"sv);
}

Image read_tiff(const Reading& reading) {
  return image_of(reading.input, tiff_pages(reading.input));
}

Image read_tiff_stack(const std::vector<std::string>& files, const std::function<KeptFile(const std::string&)>& open) {
  TiffPages all;
  KeptFile first;
  for (const std::string& file : files) {
    const KeptFile kept = open(file);
    TiffPages pages = tiff_pages(kept.input);
    if (all.size[2] == 0) {
      all = std::move(pages);
      first = kept;
      continue;
    }
    if (pages.size[0] != all.size[0] || pages.size[1] != all.size[1] || pages.stored.type != all.stored.type)
      kept.input.fail(fmt::format("has {} x {} pixels, and {} has {} x {}: a stack has slices that are alike",
                                  pages.size[0], pages.size[1], files.front(), all.size[0], all.size[1]));
    all.size[2] += pages.size[2];
    all.bytes.insert(all.bytes.end(), pages.bytes.begin(), pages.bytes.end());
  }
  return image_of(first.input, all);
}

}  // namespace octafront::image
