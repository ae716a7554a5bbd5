// What stands in for reading images and making surfaces of voxels, in a build without (OCTAFRONT_IMAGES).

#include <octafront/error.h>
#include <octafront/image.h>
#include <octafront/image_samples.h>
#include <octafront/image_surface.h>

#include "images/labels/label_steps.h"
#include "images/nets/function_surface.h"

#include <filesystem>

namespace octafront {

namespace {

[[noreturn]] void refuse(const std::string& file = "this input") {
  throw InputError(file +
                   ": this octafront was built without images and formulas. Build it with OCTAFRONT_IMAGES=ON, as "
                   "`scripts/quickstart.sh IMAGE` does");
}

bool ends_like_an_image(const std::string& file) {
  for (const char* ending : {".nii", ".nii.gz", ".hdr", ".nrrd", ".nhdr", ".mha", ".mhd", ".dcm"})
    if (file.ends_with(ending)) return true;
  return false;
}

}  // namespace

bool is_image(const std::string& file) {
  std::error_code error;
  return std::filesystem::is_directory(file, error) || ends_like_an_image(file);
}

Image read_image(const std::vector<std::string>& files, const ImageChoice&, const RunContext&) {
  refuse(files.empty() ? "no file" : files.front());
}
Image read_image(const std::string& file, const ImageChoice&, const RunContext&) {
  refuse(file);
}
std::vector<LabelName> read_label_names(const std::string& file, const RunContext&) {
  refuse(file);
}
Complex complex_of_function(const Image&, const formulas::SpaceFunction&, const RunContext&, const Box3&) {
  refuse("a formula");
}
Complex complex_of_image(const Image&, const ImageRegions&, const RunContext&) {
  refuse();
}
Image cropped(const Image&, const VoxelBox&) {
  refuse();
}
Image resampled(const Image&, Vec3, bool, const RunContext&) {
  refuse();
}
LabelImage cleaned(const LabelImage&, const CleanOptions&, const RunContext&) {
  refuse();
}
LabelImage labels_of(const Image&, const LabelOptions&) {
  refuse();
}
LabelImage labels_of_bands(const Image&, const std::vector<GreyBand>&) {
  refuse();
}
ImageRegions::Kind kind_of(const Image&, const ImageRegions&) {
  refuse();
}
std::optional<std::vector<ValueCount>> count_values(const Image&) {
  refuse();
}
std::vector<std::uint8_t> faces_reached(const LabelImage&) {
  refuse();
}
bool looks_like_labels(const Image&) {
  refuse();
}
std::string in_words(const ImageGrid&) {
  refuse();
}
double smallest_spacing(const ImageGrid&) {
  refuse();
}
Image in_frame(Image, const std::string&) {
  refuse();
}
ImageSamples sample_image(const TetMesh&, const Image&, const std::string&, const RunContext&) {
  refuse();
}
image::Thinness image::thinness_of(const LabelImage&) {
  refuse();
}

}  // namespace octafront
