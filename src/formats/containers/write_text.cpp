#include <octafront/io.h>

#include "formats/containers/atomic_file.h"

namespace octafront {

void write_text(const std::string& file, const std::string& text) {
  io::AtomicFile out(file);
  out.write(text);
  out.commit();
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  const auto place = [&](const std::filesystem::path& file) {
    return std::filesystem::weakly_canonical(io::links_followed(file), error);
  };
  const std::filesystem::path first = place(a);
  // Names that no file can have are no place, and not the same one.
  return !first.empty() && first == place(b);
}

void check_text_target(const std::string& file) {
  io::check_writable(file);
}

}  // namespace octafront
