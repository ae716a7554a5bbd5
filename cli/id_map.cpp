#include "id_map.h"

#include <octafront/error.h>
#include <octafront/io.h>

#include <string>
#include <vector>

#include <fmt/format.h>

namespace octafront::cli {

namespace {

bool is_json(const std::filesystem::path& file) {
  return file.extension() == ".json";
}

/// Per old item the new one, from the old one of each new one.
std::vector<std::int64_t> new_of_old(std::size_t count, const std::vector<std::uint32_t>& old_of_new) {
  std::vector<std::int64_t> where(count, -1);
  for (std::size_t i = 0; i < old_of_new.size(); ++i)
    if (old_of_new[i] != kNone) where[old_of_new[i]] = static_cast<std::int64_t>(i);
  return where;
}

void put_lines(std::string& text, const char* kind, const std::vector<std::int64_t>& where) {
  for (std::size_t i = 0; i < where.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{},{},{}\n", kind, i, where[i]);
}

}  // namespace

void check_map_target(const std::filesystem::path& file) {
  if (file.empty()) return;
  if (!is_json(file) && file.extension() != ".csv")
    throw OptionError(fmt::format("--map {}: a map is a .json or .csv file", file.string()));
  check_text_target(file.string());
}

void write_map(const std::filesystem::path& file, const TetMesh& before, const AdaptedMesh& adapted) {
  // Mid-side nodes have no place in the new mesh, which is linear.
  const std::vector<std::int64_t> vertices = new_of_old(before.points.size(), adapted.old_of_new);
  const std::vector<std::int64_t> elements = new_of_old(before.tets.size(), adapted.old_tet_of_new);
  std::string text;
  if (is_json(file)) {
    text = fmt::format("{{\"vertices\": [{}],\n\"elements\": [{}]}}\n", fmt::join(vertices, ","),
                       fmt::join(elements, ","));
  } else {
    text = "kind,old,new\n";
    put_lines(text, "vertex", vertices);
    put_lines(text, "element", elements);
  }
  write_text(file.string(), text);
}

}  // namespace octafront::cli
