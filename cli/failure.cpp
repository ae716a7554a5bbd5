#include "failure.h"

#include <octafront/error.h>

#include <exception>
#include <new>

namespace octafront::cli {

Failure current_failure() {
  try {
    throw;
  } catch (const OptionError& e) {
    return {kUsage, "usage", e.what()};
  } catch (const InputError& e) {
    return {kInputRefused, "input", e.what()};
  } catch (const MeshingError& e) {
    return {kNoMesh, "meshing", e.what()};
  } catch (const OutputError& e) {
    return {kNotWritten, "output", e.what()};
  } catch (const Cancelled&) {
    return {kInterrupted, "interrupted", "interrupted; no result was written"};
  } catch (const std::bad_alloc&) {
    return {kOutOfMemory, "memory", "out of memory; ask for fewer elements (`elements`, `size`)"};
  } catch (const std::exception& e) {
    return {kInternal, "internal", std::string("unexpected error, which is a bug of ours: ") + e.what()};
  }
}

}  // namespace octafront::cli
