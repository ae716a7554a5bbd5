#pragma once

// What must hold of any bytes read as an image: for libFuzzer and for the campaign of mutated files.

#include <octafront/error.h>
#include <octafront/image.h>

#include "images/files/image_readers.h"
#include "images/files/label_names.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace octafront::testing {

/// A law that was broken; empty: none.
using Broken = std::string;

/// A grid that maps to the world and back, with a finite value for each voxel. `size`: bytes of all that was read.
inline Broken broken_law(const Image& image, std::size_t size) {
  const std::size_t voxels = image.grid.voxels();
  // What compression can make of the bytes, and one of two files may be read.
  if (voxels == 0 || voxels > 1100 * (size + 64)) return "more voxels than the bytes can hold, or none";
  const Broken values = std::visit(
      [&](const auto& all) -> Broken {
        if (all.size() != voxels) return "not one value per voxel";
        for (const auto v : all)
          if (!std::isfinite(static_cast<double>(v))) return "a value is not finite";
        return {};
      },
      image.values);
  if (!values.empty()) return values;
  const auto& [a, b, c] = image.grid.axes;
  if (!is_finite(image.grid.origin) || !(std::abs(dot(cross(a, b), c)) > 0)) return "the grid does not span space";
  if (!image.grid.slices.empty() && image.grid.slices.size() != image.grid.size[2]) return "not one place per slice";
  if (!std::is_sorted(image.grid.slices.begin(), image.grid.slices.end())) return "slices do not ascend";
  return {};
}

/// Cleaning keeps every label.
inline Broken broken_by_cleaning(const Image& image) {
  if (image.grid.voxels() > 4096 || !looks_like_labels(image)) return {};
  const LabelImage labels = labels_of(image);
  CleanOptions options;
  options.islands = options.holes = 1e50;
  options.closing = 1;
  const LabelImage clean = cleaned(labels, options);
  for (std::size_t r = 0; r < labels.labels.size(); ++r)
    if (std::find(clean.regions.begin(), clean.regions.end(), r) == clean.regions.end()) return "cleaning lost a label";
  return {};
}

/// Reads bytes as an image, those behind four bytes 255 as the file beside it, and calls look(image, size) with what
/// comes of it, which leaves a Broken. InputErrors are answers like others. `read`: how many images came.
template <class Look>
Broken read_any(std::string_view all, const Look& look, int& read) {
  const std::size_t end = std::min(all.find("\xff\xff\xff\xff"), all.size());
  const io::Input first{"a.hdr", all.substr(0, end)}, second{"b", all.substr(std::min(all.size(), end + 4))};
  const auto beside = [&](const std::string&) { return image::KeptFile{second, nullptr}; };
  for (const std::uint32_t series : {0u, 2u}) {
    try {
      const Image image = image::read_image_bytes({first, {series}, beside});
      ++read;
      if (Broken broken = broken_law(image, all.size()); !broken.empty()) return broken;
      if (Broken broken = look(image); !broken.empty()) return broken;
    } catch (const InputError&) {
    }
  }
  try {
    if (image::read_label_names_bytes(first).empty()) return "a table of names without names";
  } catch (const InputError&) {
  }
  return {};
}

}  // namespace octafront::testing
