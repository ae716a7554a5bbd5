#include <octafront/error.h>
#include <octafront/run_context.h>

namespace octafront {

void RunContext::check() const {
  if (cancelled()) throw Cancelled();
}

}  // namespace octafront
