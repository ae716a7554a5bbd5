#include "base/shared/shares.h"

#include <chrono>

namespace octafront {

namespace {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Shares::Shares(std::span<const std::uint64_t> work, int ranks)
    : first_(static_cast<std::size_t>(ranks) + 1, work.size()) {
  std::uint64_t all = 0;
  for (const std::uint64_t w : work) all += w;
  // Job i is done by the rank in whose part of the work its middle lies.
  std::uint64_t before = 0;
  std::size_t rank = 0;
  first_[0] = 0;
  const double part = static_cast<double>(all) / ranks;
  for (std::size_t i = 0; i < work.size(); ++i) {
    const double middle = static_cast<double>(before) + 0.5 * static_cast<double>(work[i]);
    while (rank + 1 < static_cast<std::size_t>(ranks) && middle >= part * static_cast<double>(rank + 1))
      first_[++rank] = i;
    before += work[i];
  }
}

SharedWork::SharedWork(const Comm& comm) : comm_(comm), start_(seconds_now()) {}

SharedWork::~SharedWork() {
  if (!comm_.alone()) comm_.use().seconds_shared += seconds_now() - start_;
}

}  // namespace octafront
