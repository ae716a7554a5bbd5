#include "report/page/bytes.h"

#include <octafront/picture.h>

#include <new>

#include <zlib.h>

namespace octafront {

std::string packed(const Bytes& bytes) {
  uLongf size = compressBound(bytes.all().size());
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, bytes.all().data(), bytes.all().size(), 6) != Z_OK)
    throw std::bad_alloc();
  out.resize(size);
  return to_base64(out);
}

}  // namespace octafront
