// Any bytes as the four files of TetGen, divided by bytes 255: a mesh, or an InputError.

#include <octafront/error.h>

#include "formats/read/readers.h"

#include <array>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace octafront;
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  std::array<io::Input, 4> files;
  for (io::Input& file : files) {
    const std::size_t end = std::min(rest.find('\xff'), rest.size());
    file = {"a", rest.substr(0, end)};
    rest.remove_prefix(std::min(rest.size(), end + 1));
  }
  try {
    const auto present = [](const io::Input& file) { return file.bytes.empty() ? nullptr : &file; };
    const io::TetgenFiles all{files[0], files[1], present(files[2]), present(files[3])};
    if (io::ordered_mesh(io::read_tetgen(all), files[1]).mesh.tets.empty()) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
