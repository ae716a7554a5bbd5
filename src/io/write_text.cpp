#include <octafront/io.h>

#include "io/atomic_file.h"

namespace octafront {

void write_text(const std::filesystem::path& file, const std::string& text) {
  io::AtomicFile out(file);
  out.write(text);
  out.commit();
}

void check_text_target(const std::filesystem::path& file) {
  io::check_writable(file);
}

}  // namespace octafront
