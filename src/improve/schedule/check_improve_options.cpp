#include <octafront/error.h>

#include "improve/schedule/schedule.h"

#include <fmt/core.h>

namespace octafront {

void check_improve_options(const ImproveOptions& options) {
  if (!(options.relaxation > 0 && options.relaxation <= 1))
    throw OptionError(fmt::format("`relaxation` is {}, but must be above 0 and at most 1", options.relaxation));
  if (options.sweeps < 0) throw OptionError(fmt::format("`sweeps` is {}, but must not be negative", options.sweeps));
  if (options.seconds && !(*options.seconds >= 0))
    throw OptionError(fmt::format("`seconds` is {}, but must not be negative", *options.seconds));
}

}  // namespace octafront
