#pragma once

#include "formats/containers/input.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace octafront::io {

enum class PlyType { kInt8, kUInt8, kInt16, kUInt16, kInt32, kUInt32, kInt64, kFloat, kDouble };

/// In bytes.
std::uint64_t ply_size(PlyType type);

struct PlyProperty {
  std::string_view name;
  PlyType type = PlyType::kInt32;        ///< of the value, or of the values of a list
  PlyType count_type = PlyType::kUInt8;  ///< of the length of a list
  bool is_list = false;
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  const char* declared_at = nullptr;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Format { kText, kLittleEndian, kBigEndian };
  Format format = Format::kText;
  std::vector<PlyElement> elements;
  std::vector<std::string> patch_names;   ///< from comments "patch 3 inlet", as write_ply makes them
  std::vector<std::string> region_names;  ///< the same of comments "region 3 steel"
  const char* end = nullptr;              ///< where the values begin

  std::string_view format_name() const;
};

/// Views point into the input. `of_lines`: for who wants points and edges, and no faces. Throws InputError.
PlyHeader read_ply_header(const Input& input, bool of_lines);

}  // namespace octafront::io
