#include <octafront/io.h>

#include "io/atomic_file.h"

namespace octafront {

void write_text(const std::filesystem::path& file, const std::string& text) {
  io::AtomicFile out(file);
  out.write(text);
  out.commit();
}

}  // namespace octafront
