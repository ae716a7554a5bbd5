#include <octafront/error.h>

#include "image/byte_source.h"
#include "image/readers.h"
#include "io/scanner.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <initializer_list>

#include <fmt/core.h>

namespace octafront::image {
namespace {

namespace fs = std::filesystem;

/// What files are told by.
constexpr std::size_t kHead = 4096;

struct Kind {
  bool (*matches)(std::string_view head);
  Image (*read)(const Reading& reading);
};

constexpr std::array kKinds{Kind{is_inr, read_inr}, Kind{is_nifti, read_nifti}};

/// The first bytes of a file, unpacked if they are compressed; what is damaged is left to the readers.
std::string head_of(const io::Input& input) {
  try {
    return std::string(ByteSource(input, 0, Packing::kDetect).take(kHead));
  } catch (const InputError&) {
    return {};
  }
}

const Kind* kind_of(std::string_view head) {
  for (const Kind& kind : kKinds)
    if (kind.matches(head)) return &kind;
  return nullptr;
}

KeptFile opened_beside(const fs::path& file, const std::string& name, const RunContext& context) {
  const auto loaded = std::make_shared<const io::LoadedFile>(file.parent_path() / name, context);
  return {loaded->input(), loaded};
}

}  // namespace

Image read_image_bytes(const Reading& reading) {
  const std::string head = head_of(reading.input);
  if (const Kind* kind = kind_of(head)) return kind->read(reading);
  reading.input.fail(fmt::format(
      "is no image of a kind that is known here (NIfTI, NRRD, MetaImage, INR, InVesalius, DICOM, or raw voxels with a "
      "JSON file beside them); it begins with {}",
      io::in_quotes(head.substr(0, 24))));
}

std::uint32_t chosen_series(const Reading& reading, std::uint64_t count, const std::string& what) {
  const std::uint32_t wanted = reading.choice.series;
  if (wanted == 0 && count > 1)
    reading.input.fail(fmt::format("holds {} {}; choose one by its number, from 1 (`series`)", count, what));
  if (wanted > count)
    reading.input.fail(fmt::format("has no {} of number {}: it holds {} (`series`)", what, wanted, count));
  return wanted == 0 ? 0 : wanted - 1;
}

}  // namespace octafront::image

namespace octafront {

Image read_image(const std::vector<std::string>& files, const ImageChoice& choice, const RunContext& context) {
  if (files.size() != 1) throw OptionError("several files make an image only if they are slices of DICOM");
  const io::LoadedFile loaded(files.front(), context);
  const auto beside = [&](const std::string& name) { return image::opened_beside(files.front(), name, context); };
  return image::read_image_bytes({loaded.input(), choice, beside});
}

Image read_image(const std::string& file, const ImageChoice& choice, const RunContext& context) {
  return read_image(std::vector<std::string>{file}, choice, context);
}

bool is_image(const std::string& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) return true;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(image::kHead, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return image::kind_of(image::head_of({file, bytes})) != nullptr;
}

}  // namespace octafront
