#include <octafront/error.h>
#include <octafront/limits.h>

#include "formats/containers/file_head.h"
#include "formats/containers/named_file.h"
#include "formats/containers/scanner.h"
#include "formats/files/formats.h"
#include "images/files/byte_source.h"
#include "images/files/dicom/series.h"
#include "images/files/image_readers.h"
#include "images/files/masks.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

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

Image read_raw_by_header(const Reading& reading) {
  return read_raw(reading);
}

constexpr std::array kKinds{Kind{is_nrrd, read_nrrd},   Kind{is_dicom, read_dicom},
                            Kind{is_nifti, read_nifti}, Kind{is_meta, read_meta},
                            Kind{is_mgh, read_mgh},     Kind{is_npy, read_npy},
                            Kind{is_tiff, read_tiff},   Kind{is_raw_header, read_raw_by_header}};

/// The first bytes of a file, unpacked if they are compressed: as many as come before what is damaged, which readers
/// will complain about.
std::string head_of(const io::Input& input) {
  // The last is what the largest magic word needs: that of NIfTI.
  for (const std::size_t count : {kHead, kHead / 8, std::size_t{348}}) {
    try {
      return std::string(ByteSource(input, 0, Packing::kDetect).take(count));
    } catch (const InputError&) {
    }
  }
  return {};
}

const Kind* kind_of(std::string_view head) {
  for (const Kind& kind : kKinds)
    if (kind.matches(head)) return &kind;
  return nullptr;
}

KeptFile opened_beside(const fs::path& file, const std::string& name, const RunContext& context) {
  const auto loaded = std::make_shared<const io::LoadedFile>(io::named_file({file.string(), {}}, name), context);
  return {loaded->input(), loaded};
}

/// The JSON file beside raw voxels: scan.json or scan.raw.json for scan.raw. Empty if there is none.
fs::path raw_header_of(const fs::path& file) {
  fs::path name = file;
  std::error_code error;
  for (const fs::path& header : {fs::path(file.string() + ".json"), name.replace_extension(".json")})
    if (header != file && fs::is_regular_file(header, error)) return header;
  return {};
}

std::string first_bytes(const fs::path& file) {
  require_in_folders(file.string());
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(kHead, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return head_of({file.string(), bytes});
}

/// Endings of files that say themselves what they hold; `.img` may be raw.
constexpr std::array kOwnEndings{".nii", ".hdr", ".nrrd", ".nhdr", ".mha",  ".mhd", ".dcm",  ".mgh",  ".mgz",
                                 ".npy", ".tif", ".tiff", ".stp",  ".step", ".igs", ".iges", ".brep", ".json"};

bool claims_a_kind(const fs::path& file) {
  const fs::path bare = file.extension() == ".gz" ? file.stem() : file;
  const std::string ending = bare.extension().string();
  return io::format_of(bare) != nullptr || std::any_of(kOwnEndings.begin(), kOwnEndings.end(), [&](const char* own) {
           return io::equal_ignoring_case(ending, own);
         });
}

/// Whether the first bytes are those of a surface, a mesh or another kind of file. Binary STL is told by its size.
bool is_of_other_kind(const fs::path& file, std::string_view head) {
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  if (!io::well_known_kind(head).empty() || io::is_binary_stl(head, size)) return true;
  try {
    // A raw label image may begin as binary MEDIT does.
    return io::recognize_surface({file.string(), head}).info.name != "meditb";
  } catch (const InputError&) {
    return false;
  }
}

/// Whether neither content nor name of a file say what it is, but a header beside it does.
bool is_raw(const fs::path& file) {
  const fs::path header = raw_header_of(file);
  if (header.empty() || claims_a_kind(file) || !is_raw_header(first_bytes(header))) return false;
  const std::string head = first_bytes(file);
  return kind_of(head) == nullptr && (file.extension() == ".raw" || !is_of_other_kind(file, head));
}

SliceFiles slice_files(const std::vector<std::string>& files, const RunContext& context) {
  const auto open = [&files, &context](std::size_t f) {
    const auto loaded = std::make_shared<const io::LoadedFile>(files[f], context);
    return KeptFile{loaded->input(), loaded};
  };
  return {files, open};
}

}  // namespace

/// One image of a file that is none of DICOM.
Image read_one(const std::string& file, const ImageChoice& choice, const RunContext& context) {
  const io::LoadedFile loaded(file, context);
  const auto beside = [&](const std::string& name) { return opened_beside(file, name, context); };
  return read_image_bytes({loaded.input(), choice, beside});
}

bool is_mask(const std::string& file) {
  const std::string head = first_bytes(file);
  const Kind* kind = kind_of(head);
  return kind != nullptr && kind->matches != is_dicom && kind->matches != is_raw_header;
}

/// Masks of one grid; of TIFF slices of one image.
Image read_masks(const std::vector<std::string>& files, const RunContext& context) {
  if (std::ranges::all_of(files, [](const std::string& file) { return is_tiff(first_bytes(file)); }))
    return read_tiff_stack(files, [&](const std::string& file) {
      const auto loaded = std::make_shared<const io::LoadedFile>(file, context);
      return KeptFile{loaded->input(), loaded};
    });
  return image_of_masks(files, [&](const std::string& file) { return read_one(file, {}, context); });
}

/// Of a list of files, all of which must be slices, or all masks.
Image read_slices(const std::vector<std::string>& files, const ImageChoice& choice, const RunContext& context) {
  if (std::ranges::all_of(files, is_mask)) return read_masks(files, context);
  for (const std::string& file : files)
    if (!is_dicom(first_bytes(file)))
      throw InputError(fmt::format(
          "{}: is no DICOM file; several files make an image if all are DICOM slices, or all others, masks of it",
          file));
  try {
    return read_series(slice_files(files, context), choice, context);
  } catch (const InputError& error) {
    const std::string what = error.what();
    throw InputError(what.starts_with("holds") ? fmt::format("the list of {} files {}", files.size(), what) : what);
  }
}

Image read_folder(const std::string& folder, const ImageChoice& choice, const RunContext& context) {
  const std::vector<std::string> names = dicom_files_in(folder, context);
  if (names.empty()) {
    const std::vector<std::string> masks = images_in(folder, is_mask);
    if (masks.empty()) throw InputError(fmt::format("{}: is a folder without DICOM files, and without masks", folder));
    return read_masks(masks, context);
  }
  SliceFiles files = slice_files(names, context);
  files.skip_others = true;
  try {
    return read_series(files, choice, context);
  } catch (const InputError& error) {
    const std::string what = error.what();
    throw InputError(what.starts_with("holds") ? fmt::format("{}: {}", folder, what) : what);
  }
}

Image read_image_bytes(const Reading& reading) {
  const std::string head = head_of(reading.input);
  if (const Kind* kind = kind_of(head)) return kind->read(reading);
  reading.input.fail(fmt::format(
      "is no image of a kind that is known here (NIfTI, NRRD, MetaImage, DICOM, FreeSurfer MGZ, npy, TIFF, or "
      "raw voxels with a "
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

namespace {

/// Without -0, which looks odd where it is printed.
Image tidied(Image image) {
  for (Vec3& axis : image.grid.axes) axis += Vec3{};
  image.grid.origin += Vec3{};
  return image;
}

}  // namespace

Image read_image(const std::vector<std::string>& files, const ImageChoice& choice, const RunContext& context) {
  if (files.empty()) throw OptionError("no file of an image is given");
  const std::filesystem::path file = files.front();
  if (files.size() > 1) return tidied(image::read_slices(files, choice, context));
  if (std::filesystem::is_directory(file)) return tidied(image::read_folder(files.front(), choice, context));
  const auto beside = [&](const std::string& name) { return image::opened_beside(file, name, context); };
  if (image::is_raw(file)) {
    const io::LoadedFile header(image::raw_header_of(file), context);
    Image image = image::read_raw({header.input(), choice, beside}, file.filename().string());
    image.notes.insert(image.notes.begin(), fmt::format("what the voxels mean is said by {}", header.input().name));
    return tidied(std::move(image));
  }
  const io::LoadedFile loaded(file, context);
  return tidied(image::read_image_bytes({loaded.input(), choice, beside}));
}

Image read_image(const std::string& file, const ImageChoice& choice, const RunContext& context) {
  return read_image(std::vector<std::string>{file}, choice, context);
}

bool is_image(const std::string& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) return true;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  return image::kind_of(image::first_bytes(file)) != nullptr || image::is_raw(file);
}

}  // namespace octafront
