#pragma once

#include <octafront/adapt.h>
#include <octafront/octafront_c.h>
#include <octafront/run_context.h>

#include "doors/c_api/c_api.h"
#include "doors/c_api/job_ranks.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <thread>
#include <vector>

/// Work on a thread of its own, and what its caller waits for. The worker posts events, the caller takes them; only to
/// a question about sizes does the worker wait for an answer. Where there are no threads, the work is done in the first
/// wait, and a watcher is told of events as they happen.
struct octafront_job {
 public:
  using Json = nlohmann::ordered_json;
  using Work = std::function<void(octafront_job&)>;

  octafront_job(const Work& work, int threads);
  /// Cancels and waits.
  ~octafront_job();
  octafront_job(const octafront_job&) = delete;
  octafront_job& operator=(const octafront_job&) = delete;

  // For the worker.
  const octafront::RunContext& context() const { return context_; }
  /// The options with their callbacks, if they want events.
  octafront::Options options_of(const octafront_options* options);
  /// work(context) by the processes that the options name, whose context it is; where it fails on one, it does on all.
  template <class WorkInContext>
  void on_ranks(const octafront_options* options, const char* stage, const WorkInContext& work) {
    octafront::RunContext context = context_;
    context.ranks = ranks_of(options);
    octafront::together(context.ranks, stage, [&] { work(context); });
  }
  Json report = Json::object();
  std::string bytes;
  std::unique_ptr<octafront_surface> surface;
  std::unique_ptr<octafront_mesh> mesh;
  std::unique_ptr<octafront_sizes> sizes;
  std::unique_ptr<octafront_image> image;

  // For the caller.
  int wait(double seconds, octafront_event& event);
  void watch(octafront_watcher watcher, void* data);
  void answer();
  void cancel();
  int status() const { return status_; }
  const char* message() const { return message_.c_str(); }
  const char* report_text();

 private:
  struct Event {
    int kind;
    std::string text;
    std::array<double, 4> values{};
  };

  void run(const Work& work);
  void run_here();
  void show(const Event& event);
  void close(int status, std::string message);
  void post(Event event);
  void post_progress(std::string_view stage, double fraction);
  void ask_sizes(std::span<const octafront::Vec3> points, std::span<double> sizes);
  /// Waits for the answer; `may_go` ends the wait before.
  void ask(const octafront_event& question, const std::atomic<bool>& may_go);
  octafront::Ranks* ranks_of(const octafront_options* options);
  bool take_event(octafront_event& event);

  Work put_off_;  ///< until somebody waits, where there are no threads
  octafront_watcher watcher_ = nullptr;
  void* watcher_data_ = nullptr;
  octafront::RunContext context_;
  std::atomic<bool> cancelled_{false}, freed_{false};
  std::mutex mutex_;
  std::condition_variable for_caller_, for_worker_;
  std::deque<Event> events_;
  Event current_{};  ///< what the caller looks at
  octafront_event question_{};
  std::unique_ptr<octafront::c_api::JobRanks> ranks_;
  bool is_asked_ = false, is_shown_ = false, ended_ = false;
  int status_ = OCTAFRONT_INTERNAL;
  std::string message_, report_text_;
  std::thread worker_;  // last: it sees all of the above
};

namespace octafront::c_api {

/// A job, or null where there is no memory or thread for one.
octafront_job* started(const octafront_job::Work& work, int threads = 0);

/// What walls stand for; null: nothing is given. Throws InputError for indices out of range.
const Domain* domain_of(const octafront_surface* ground);

/// Hands over the mesh, with how it fits in the report.
void give_adapted(octafront_job& job, AdaptedMesh adapted);
void give_adapted(octafront_job& job, AdaptedSurface adapted);

/// A leak leaves the way through it in the report.
template <class Work>
void with_leak(octafront_job& job, const Work& work) {
  try {
    work();
  } catch (const LeakError& leak) {
    job.report["leak"] = octafront_job::Json::array();
    for (const Vec3 p : leak.way) job.report["leak"].push_back({p.x, p.y, p.z});
    throw;
  }
}

/// Copies.
std::vector<Body> bodies_of(const octafront_surface* const* bodies, const char* const* names, std::size_t count);

/// What the job leaves.
inline void give(octafront_job& job, Domain domain) {
  job.surface = std::make_unique<octafront_surface>(octafront_surface{std::move(domain)});
}
inline void give(octafront_job& job, TetMesh mesh) {
  job.mesh = std::make_unique<octafront_mesh>(octafront_mesh{std::move(mesh)});
}
inline void give(octafront_job& job, const SizeField& sizes) {
  job.sizes = std::make_unique<octafront_sizes>(octafront_sizes{sizes});
}

}  // namespace octafront::c_api
