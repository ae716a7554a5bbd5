#include "base/core/wording.h"

#include <algorithm>

#include <fmt/core.h>

namespace octafront {
namespace {

constexpr std::size_t kMostFaces = 5;  // more are no help in a sentence

}  // namespace

std::string noun(std::uint64_t n, const std::string& one, const std::string& many) {
  return n == 1 ? one : many.empty() ? one + "s" : many;
}

std::string counted(std::uint64_t n, const std::string& one, const std::string& many) {
  return fmt::format("{} {}", n, noun(n, one, many));
}

std::string in_faces(std::span<const std::uint32_t> faces) {
  if (faces.empty()) return "";
  const std::size_t shown = std::min(faces.size(), kMostFaces);
  std::string list;
  for (std::size_t i = 0; i < shown; ++i)
    list += fmt::format("{}{}", i == 0 ? "" : i + 1 < shown ? ", " : " and ", faces[i]);
  return fmt::format(" ({}face{} {})", shown < faces.size() ? "first: " : "", shown == 1 ? "" : "s", list);
}

std::vector<std::string> names_listed(const std::string& list, std::span<const std::string> known) {
  std::vector<std::string> names;
  if (list.empty()) return names;  // patches without a name are called "" as well
  if (std::find(known.begin(), known.end(), list) != known.end()) return {list};
  for (std::size_t from = 0; from < list.size();) {
    const std::size_t comma = std::min(list.find(',', from), list.size());
    if (comma > from) names.push_back(list.substr(from, comma - from));
    from = comma + 1;
  }
  return names;
}

std::string region_label(const std::string& name, std::size_t region, std::size_t regions) {
  return !name.empty() ? name : regions == 1 ? "body" : fmt::format("body_{}", region + 1);
}

std::string at_point(Vec3 p) {
  // Adding 0 keeps "-0" out of messages.
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x + 0.0, p.y + 0.0, p.z + 0.0);
}

}  // namespace octafront
