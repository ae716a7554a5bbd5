#include <octafront/error.h>
#include <octafront/limits.h>
#include <octafront/no_context.h>
#include <octafront/run_context.h>

namespace octafront {

void RunContext::check() const {
  if (cancelled()) throw Cancelled();
  check_cpu_seconds();
}

const RunContext& no_context() {
  static const RunContext none;
  return none;
}

}  // namespace octafront
