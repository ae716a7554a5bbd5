// What stands in for the readers that need HDF5, in a build without it.

#include "formats/read/readers.h"

namespace octafront::io {
namespace {

[[noreturn]] void refuse(const Input& input) {
  input.fail(
      "needs HDF5, which this octafront was built without: build it with libhdf5-dev installed, or convert the file");
}

}  // namespace

RawMesh read_xdmf(const Input& input) {
  refuse(input);
}

RawMesh read_med(const Input& input) {
  refuse(input);
}

}  // namespace octafront::io
