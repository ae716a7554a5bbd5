#include <octafront/error.h>

#include "workbench.h"

namespace octafront::cli {

void serve_workbench(const CLI::App&, const WorkbenchSetting&) {
  throw OptionError(
      "this program was built without the workbench, which needs cpp-httplib (Debian: libcpp-httplib-dev) and a system "
      "other than Windows");
}

}  // namespace octafront::cli
