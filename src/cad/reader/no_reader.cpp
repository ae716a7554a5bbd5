#include <octafront/error.h>

#include "cad/reader/cad_reader.h"

namespace octafront::cad {

class CadReader::Process {};

CadReader::CadReader(const std::string&, const ReaderOptions&, Tell, const RunContext&) {
  static_cast<void>(reader_program());
}

CadReader::~CadReader() = default;

CadModel CadReader::triangulate(const Fineness&) {
  return {};
}

std::string reader_program() {
#ifdef __EMSCRIPTEN__
  throw InputError(
      "CAD files (STEP, IGES, BREP) are not read in a web page: install Octafront and run `octafront ui` with the "
      "file, or convert it to a surface, such as STL or OBJ");
#else
  throw InputError(
      "CAD files (STEP, IGES, BREP) are not read on Windows yet: convert the file to a surface, such as STL or OBJ, or "
      "run "
      "Octafront for Linux, also in WSL");
#endif
}

}  // namespace octafront::cad
