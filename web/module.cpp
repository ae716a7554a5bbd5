// Nothing of its own: the module is the library's C interface, which the linker is told to keep (CMakeLists.txt).
#include <octafront/octafront_c.h>

// As port.js has it: how much room an event takes, and where its parts are.
static_assert(sizeof(octafront_event) == 72 && offsetof(octafront_event, text) == 4 &&
              offsetof(octafront_event, values) == 8);
