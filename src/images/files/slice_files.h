#pragma once

#include "images/files/image_readers.h"
#include "images/files/voxels.h"

#include <string>
#include <vector>

namespace octafront::image {

/// Files that hold the voxels of an image in equal shares, in order.
struct DataFiles {
  std::vector<std::string> names;
  std::uint64_t skipped_lines = 0, skipped_bytes = 0;  ///< before the voxels of each
  bool at_end = false;                                 ///< the voxels are the last bytes of each; no bytes are skipped
  Packing packing = Packing::kNone;
};

/// The bytes of the voxels `first` to `first + count` in steps of `stride` of all that the files hold.
struct Picked {
  std::uint64_t first = 0, count = 0, stride = 1;
};

/// Reads the `picked` voxels of `total`. Throws InputError, naming the file, for what they lack.
Image::Values read_data_files(const Reading& reading, const DataFiles& files, std::uint64_t total, const Picked& picked,
                              const StoredVoxels& stored, std::vector<std::string>& notes);

/// The same of the rest of the input itself, from byte `offset` on.
Image::Values read_attached(const Reading& reading, std::size_t offset, const DataFiles& how, std::uint64_t total,
                            const Picked& picked, const StoredVoxels& stored, std::vector<std::string>& notes);

/// "scan%03d.raw 1 20 1": the names of such a series. Throws InputError for other patterns than one %d.
std::vector<std::string> numbered_names(const io::Input& input, const std::string& pattern, std::int64_t first,
                                        std::int64_t last, std::int64_t step);

}  // namespace octafront::image
