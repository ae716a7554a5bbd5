// Any bytes as an image, those behind a byte 255 twice as the file beside it: a grid that maps to the world and back,
// with a finite value for each voxel, or an InputError. Labels of it are cleaned.

#include <octafront/error.h>
#include <octafront/image.h>

#include "image/label_names.h"
#include "image/readers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace {

using namespace octafront;

void check(const Image& image, std::size_t size) {
  const std::size_t voxels = image.grid.voxels();
  // What compression can make of the bytes, and one of two files may be read.
  if (voxels == 0 || voxels > 1100 * (size + 64)) std::abort();
  std::visit(
      [&](const auto& values) {
        if (values.size() != voxels) std::abort();
        for (const auto v : values)
          if (!std::isfinite(static_cast<double>(v))) std::abort();
      },
      image.values);
  const auto& [a, b, c] = image.grid.axes;
  if (!is_finite(image.grid.origin) || !(std::abs(dot(cross(a, b), c)) > 0)) std::abort();
  if (!image.grid.slices.empty() && image.grid.slices.size() != image.grid.size[2]) std::abort();
  if (!std::is_sorted(image.grid.slices.begin(), image.grid.slices.end())) std::abort();
}

void check_labels(const Image& image) {
  if (image.grid.voxels() > 4096 || !looks_like_labels(image)) return;
  const LabelImage labels = labels_of(image);
  CleanOptions options;
  options.islands = options.holes = 1e50;
  options.closing = 1;
  const LabelImage clean = cleaned(labels, options);
  for (std::size_t r = 0; r < labels.labels.size(); ++r)
    if (std::find(clean.regions.begin(), clean.regions.end(), r) == clean.regions.end()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view all(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(all.find("\xff\xff\xff\xff"), all.size());
  const io::Input first{"a.hdr", all.substr(0, end)}, second{"b", all.substr(std::min(all.size(), end + 4))};
  const auto beside = [&](const std::string&) { return image::KeptFile{second, nullptr}; };
  for (const std::uint32_t series : {0u, 2u}) {
    try {
      const Image image = image::read_image_bytes({first, {series}, beside});
      check(image, size);
      check_labels(image);
    } catch (const InputError&) {
    }
  }
  try {
    if (image::read_label_names_bytes(first).empty()) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
