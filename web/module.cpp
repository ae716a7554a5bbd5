// Nothing of its own: the module is the library's C interface, which the linker is told to keep (CMakeLists.txt).
#include <octafront/octafront_c.h>
