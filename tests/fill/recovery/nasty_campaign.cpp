// Meshes random nasty surfaces, each by recover_volume() and by generate() with the surface kept, and checks the
// results. Not a unit test: bench/campaigns/nasty.sh runs it over as many seeds as wanted.

#include <octafront/error.h>
#include <octafront/generate.h>
#include <octafront/io.h>
#include <octafront/validity.h>

#include "fill/recovery/recover.h"
#include "support/nasty_surfaces.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

namespace octafront {
namespace {

using Mesher = std::function<TetMesh(const SurfaceMesh&, const RunContext&)>;

TetMesh by_recovery(const SurfaceMesh& surface, const RunContext& context) {
  StageReport report;
  return recover_volume(surface, {context, report});
}

TetMesh by_generate(const SurfaceMesh& surface, const RunContext& context) {
  Options options;
  options.surface.keep = true;
  return generate(surface, options, context).mesh;
}

// Sets a flag after so many seconds, unless it goes out of scope before. If the run has not ended after as long again,
// it does not heed the flag, and only the end of the process can stop it.
class TimeLimit {
 public:
  TimeLimit(std::chrono::seconds limit, std::string run)
      : run_(std::move(run)), thread_([this, limit] { watch(limit); }) {}
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;
  ~TimeLimit() {
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }
  const std::atomic<bool>& expired() const { return expired_; }

 private:
  void watch(std::chrono::seconds limit) {
    std::unique_lock lock(mutex_);
    const auto is_done = [this] { return done_; };
    if (wake_.wait_for(lock, limit, is_done)) return;
    expired_ = true;
    if (wake_.wait_for(lock, limit, is_done)) return;
    std::printf("%s: no end, and cannot be cancelled; stopping here\n", run_.c_str());
    std::fflush(stdout);
    std::_Exit(EXIT_FAILURE);
  }

  std::string run_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::atomic<bool> expired_ = false;
  std::thread thread_;  // last: it uses the others
};

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::ranges::replace(text, '\n', ' ');
  return text;
}

// What went wrong, if anything.
std::optional<std::string> failure(const Mesher& mesher, const SurfaceMesh& surface, std::chrono::seconds limit,
                                   const std::string& run) {
  const TimeLimit timer(limit, run);
  RunContext context;
  context.cancel = &timer.expired();
  try {
    return first_defect(mesher(surface, context), surface);
  } catch (const Cancelled&) {
    return "no end in " + std::to_string(limit.count()) + " s";
  } catch (const std::exception& error) {
    return one_line(error.what());
  }
}

constexpr std::uint64_t kSeedsPerLine = 500;  // of progress

struct Tally {
  std::uint64_t passed = 0, failed = 0;
  double slowest_seconds = 0;
  std::string slowest;
};

void mesh_surface(std::uint64_t seed, std::chrono::seconds limit, Tally& tally) {
  const testing::NastySurface nasty = testing::nasty_surface(seed);
  const auto try_one = [&](const char* name, const Mesher& mesher) {
    const std::string run =
        nasty.name + ", " + std::to_string(nasty.surface.triangles.size()) + " triangles, by " + name;
    const auto start = std::chrono::steady_clock::now();
    const auto what = failure(mesher, nasty.surface, limit, run);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    what ? ++tally.failed : ++tally.passed;
    if (what) std::printf("%s: %s\n", run.c_str(), what->c_str());
    if (seconds.count() <= tally.slowest_seconds) return;
    tally.slowest_seconds = seconds.count();
    tally.slowest = run;
  };
  try_one("recover_volume()", by_recovery);
  try_one("generate()", by_generate);
  std::fflush(stdout);
}

int run_campaign(std::uint64_t count, std::uint64_t first, std::chrono::seconds limit) {
  const auto number = [](std::uint64_t n) { return std::to_string(n); };
  std::printf("seeds %s to %s, each by recover_volume() and by generate() with the surface kept\n",
              number(first).c_str(), number(first + count - 1).c_str());
  Tally tally;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    mesh_surface(seed, limit, tally);
    if ((seed + 1 - first) % kSeedsPerLine != 0) continue;
    std::printf("%s seeds done, %s failures\n", number(seed + 1 - first).c_str(), number(tally.failed).c_str());
    std::fflush(stdout);
  }
  std::printf("the slowest, %.1f s: %s\n", tally.slowest_seconds, tally.slowest.c_str());
  std::printf("%s passed, %s failed\n", number(tally.passed).c_str(), number(tally.failed).c_str());
  return tally.failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace octafront

int main(int argc, char** argv) {
  if (argc == 4 && std::string_view(argv[1]) == "write") {
    octafront::write_surface(argv[3], octafront::testing::nasty_surface(std::strtoull(argv[2], nullptr, 10)).surface);
    return 0;
  }
  const auto argument = [&](int i, std::uint64_t otherwise) {
    return argc > i ? std::strtoull(argv[i], nullptr, 10) : otherwise;
  };
  const std::uint64_t count = argument(1, 100), limit = argument(3, 60);
  if (argc > 4 || count == 0 || limit == 0) {
    std::fprintf(stderr,
                 "usage: nasty_campaign [COUNT] [FIRST_SEED] [SECONDS]\n       nasty_campaign write SEED FILE.off\n");
    return 2;
  }
  return octafront::run_campaign(count, argument(2, 0), std::chrono::seconds(limit));
}
