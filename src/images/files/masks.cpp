#include "images/files/masks.h"

#include <octafront/error.h>
#include <octafront/limits.h>

#include "base/core/wording.h"
#include "images/files/voxels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <fmt/core.h>

namespace octafront::image {
namespace {

namespace fs = std::filesystem;

/// Labels that grow by one mask after the other.
class Union {
 public:
  explicit Union(std::size_t voxels) : labels_(voxels, 0) {}

  template <class IsIn>
  void add(std::int32_t label, const std::string& name, const IsIn& is_in) {
    std::size_t voxels = 0;
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      if (!is_in(i)) continue;
      overlaps_ += labels_[i] != 0;
      labels_[i] = label;
      ++voxels;
    }
    names_.push_back({label, name});
    if (voxels == 0) empty_ += (empty_.empty() ? "" : ", ") + name;
  }

  void into(Image& image) {
    if (overlaps_ > 0)
      image.notes.push_back(
          fmt::format("{} in several masks: the last one has them", counted(overlaps_, "voxel is", "voxels are")));
    if (!empty_.empty()) image.notes.push_back("masks without a voxel: " + empty_);
    image.values = narrowed(labels_, image.notes);
    image.names = std::move(names_);
  }

 private:
  std::vector<std::int32_t> labels_;
  std::vector<LabelName> names_;
  std::uint64_t overlaps_ = 0;
  std::string empty_;
};

std::string stem_of(const std::string& file) {
  const fs::path name = fs::path(file).filename();
  return (name.extension() == ".gz" ? name.stem() : name).stem().string();
}

/// Whether voxels are those of the other grid, up to what headers round.
bool same_grid(const ImageGrid& a, const ImageGrid& b) {
  if (a.size != b.size) return false;
  constexpr double kSame = 0.01;  // of a voxel
  for (unsigned corner = 0; corner < 8; ++corner) {
    const auto at = [&](unsigned axis) { return (corner >> axis & 1) != 0 ? a.size[axis] - 1 : 0; };
    const auto place = [&](const ImageGrid& g) {
      return g.to_world({static_cast<double>(at(0)), static_cast<double>(at(1)), g.slice(at(2))});
    };
    if (distance(place(a), place(b)) > kSame * std::min({length(a.axes[0]), length(a.axes[1]), length(a.axes[2])}))
      return false;
  }
  return true;
}

/// Of whole numbers only one is not 0; parts of voxels may be any.
void require_mask(const Image& image, const std::string& file) {
  std::visit(
      [&](const auto& values) {
        std::array<double, 2> labels{};
        for (const auto stored : values) {
          const auto v = static_cast<double>(stored);
          if (v == 0 || v == labels[0]) continue;
          if (v != std::floor(v)) return;
          labels[labels[0] == 0 ? 0 : 1] = v;
        }
        if (labels[1] == 0) return;
        throw InputError(
            fmt::format("{}: is no mask, for it has several labels ({}, {}): give such an image alone; "
                        "several files that are no DICOM are masks of one image",
                        file, labels[0], labels[1]));
      },
      image.values);
}

}  // namespace

Image image_of_masks(const std::vector<std::string>& files, const std::function<Image(const std::string&)>& read) {
  constexpr double kHalf = 0.5;
  Image all = read(files.front());
  Union labels(all.grid.voxels());
  for (std::size_t f = 0; f < files.size(); ++f) {
    const Image further = f == 0 ? Image{} : read(files[f]);
    const Image& mask = f == 0 ? all : further;
    require_mask(mask, files[f]);
    if (!same_grid(all.grid, mask.grid) || all.frame != mask.frame)
      throw InputError(fmt::format("{}: has other voxels than {}; masks lie on one grid", files[f], files.front()));
    std::visit(
        [&](const auto& values) {
          labels.add(static_cast<std::int32_t>(f + 1), stem_of(files[f]),
                     [&](std::size_t i) { return static_cast<double>(values[i]) >= kHalf; });
        },
        mask.values);
  }
  labels.into(all);
  all.format = fmt::format("{}, {}", counted(files.size(), "mask"), all.format);
  return all;
}

std::vector<std::string> images_in(const std::string& folder, const std::function<bool(const std::string&)>& is_one) {
  require_in_folders(folder);
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    if (it->is_regular_file(ignored) && is_one(it->path().string())) files.push_back(it->path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void put_together(const Layers& layers, Image& image) {
  Union labels(image.grid.voxels());
  std::int32_t number = 0;
  for (const Layers::Segment& segment : layers.segments) {
    const auto add = [&](const auto& values) {
      labels.add(++number, segment.name,
                 [&](std::size_t i) { return static_cast<std::int64_t>(values[i]) == segment.value; });
    };
    std::visit(add, layers.values[segment.layer]);
  }
  labels.into(image);
}

}  // namespace octafront::image
