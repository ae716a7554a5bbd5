#include <octafront/cad.h>
#include <octafront/limits.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

namespace octafront {

namespace {

/// Enough for what a file of each kind begins with.
constexpr std::size_t kLooked = 200;

std::string extension_of(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool is_one_of(std::string_view text, std::initializer_list<std::string_view> all) {
  return std::find(all.begin(), all.end(), text) != all.end();
}

}  // namespace

bool is_cad(const std::string& file) {
  // A pipe has no beginning to look at: what is read there is gone.
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  require_in_folders(file);
  std::string head(kLooked, '\0');
  std::ifstream in(std::filesystem::path(file), std::ios::binary);
  in.read(head.data(), kLooked);
  head.resize(static_cast<std::size_t>(in.gcount()));
  const auto has = [&](std::string_view text) { return head.find(text) != std::string::npos; };
  if (has("ISO-10303-21;") || has("CASCADE Topology") || has("DBRep_DrawableShape")) return true;
  const std::string extension = extension_of(file);
  if (is_one_of(extension, {".step", ".stp", ".p21", ".stpz", ".iges", ".igs", ".brep", ".brp"})) return true;
  return extension == ".gz" && is_one_of(extension_of(std::filesystem::path(file).stem().string()), {".step", ".stp"});
}

}  // namespace octafront
