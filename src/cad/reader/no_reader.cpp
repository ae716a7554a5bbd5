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
  throw InputError(
      "CAD files (STEP, IGES, BREP) are not read on Windows yet: convert the file to a surface, such as STL or OBJ, or "
      "run "
      "Octafront for Linux, also in WSL");
}

}  // namespace octafront::cad
