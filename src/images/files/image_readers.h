#pragma once

// The readers, one per format: from bytes in memory to an Image. All throw InputError.

#include <octafront/image.h>

#include "formats/containers/input.h"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::image {

/// A file that others name, and what keeps its bytes.
struct KeptFile {
  io::Input input;
  std::shared_ptr<const void> owner;
};

/// Opens a file by the name that another one has for it, relative to that one's folder. Throws InputError.
using Beside = std::function<KeptFile(const std::string& name)>;

/// What readers get beside the bytes.
struct Reading {
  const io::Input& input;
  ImageChoice choice;
  Beside beside;
};

Image read_nifti(const Reading& reading);
Image read_nrrd(const Reading& reading);
Image read_mgh(const Reading& reading);
Image read_npy(const Reading& reading);
Image read_tiff(const Reading& reading);
/// Slices, one upon the other.
Image read_tiff_stack(const std::vector<std::string>& files, const std::function<KeptFile(const std::string&)>& open);
Image read_meta(const Reading& reading);
/// `input` is the JSON that says what the bytes of `data` mean; empty: the file that it names.
Image read_raw(const Reading& reading, const std::string& data = {});

/// Whether the bytes, unpacked where need be, begin as the format does; readers say what is wrong behind that.
bool is_nifti(std::string_view head);
bool is_nrrd(std::string_view head);
bool is_mgh(std::string_view head);
bool is_npy(std::string_view head);
bool is_tiff(std::string_view head);
bool is_meta(std::string_view head);
bool is_raw_header(std::string_view head);

/// By content, or else by the ending of the name.
Image read_image_bytes(const Reading& reading);

/// The series that was chosen of `count` of `what`, from 0. Throws InputError for one that does not exist, or if none
/// was chosen among several.
std::uint32_t chosen_series(const Reading& reading, std::uint64_t count, const std::string& what);

}  // namespace octafront::image
