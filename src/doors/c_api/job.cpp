#include "doors/c_api/job.h"

#include <octafront/error.h>
#include <octafront/limits.h>
#include <octafront/open_cavity_error.h>
#include <octafront/requirement_error.h>

#include "base/core/thread_limit.h"

#include <chrono>
#include <new>
#include <utility>

using namespace octafront;
using c_api::JobRanks;

namespace {

int status_of(const RankFailure& failure) {
  using Kind = RankFailure::Kind;
  switch (failure.kind) {
    case Kind::kOption:
      return OCTAFRONT_USAGE;
    case Kind::kInput:
      return OCTAFRONT_INPUT;
    case Kind::kMeshing:
      return OCTAFRONT_MESHING;
    case Kind::kOutput:
      return OCTAFRONT_OUTPUT;
    case Kind::kCancelled:
      return OCTAFRONT_CANCELLED;
    case Kind::kMemory:
      return OCTAFRONT_MEMORY;
    default:
      return OCTAFRONT_INTERNAL;
  }
}

}  // namespace

octafront_job::octafront_job(const Work& work, int threads) {
  context_.cancel = &cancelled_;
  context_.threads = threads;
  context_.progress = [this](std::string_view stage, double fraction) { post_progress(stage, fraction); };
  if (has_threads())
    worker_ = std::thread([this, work] { run(work); });
  else
    put_off_ = work;
}

octafront_job::~octafront_job() {
  freed_.store(true);
  cancel();
  if (worker_.joinable()) worker_.join();
}

void octafront_job::run(const Work& work) {
  try {
    work(*this);
    close(OCTAFRONT_DONE, "");
  } catch (const OptionError& e) {
    close(OCTAFRONT_USAGE, e.what());
  } catch (const InputError& e) {
    close(OCTAFRONT_INPUT, e.what());
  } catch (const OpenCavityError& e) {
    surface = std::make_unique<octafront_surface>(octafront_surface{e.cavity});
    close(OCTAFRONT_MESHING, e.what());
  } catch (const RequirementError& e) {
    report = Json::parse(to_json(e.report));
    close(OCTAFRONT_MESHING, e.what());
  } catch (const MeshingError& e) {
    close(OCTAFRONT_MESHING, e.what());
  } catch (const OutputError& e) {
    close(OCTAFRONT_OUTPUT, e.what());
  } catch (const Cancelled& e) {
    close(OCTAFRONT_CANCELLED, e.what());
  } catch (const RankFailure& e) {
    close(status_of(e), e.what());
  } catch (const LimitError& e) {
    close(OCTAFRONT_MEMORY, e.what());
  } catch (const std::bad_alloc&) {
    close(OCTAFRONT_MEMORY, "out of memory; ask for fewer elements (`elements`, `size`)");
  } catch (const std::exception& e) {
    close(OCTAFRONT_INTERNAL, std::string("unexpected error, which is a bug of ours: ") + e.what());
  }
}

void octafront_job::close(int status, std::string message) {
  const std::lock_guard lock(mutex_);
  status_ = status;
  message_ = std::move(message);
  ended_ = true;
  for_caller_.notify_all();
}

// Without the lock: what the watcher does is to call us.
void octafront_job::run_here() {
  const Work work = std::exchange(put_off_, nullptr);
  if (work) run(work);
}

void octafront_job::show(const Event& event) {
  octafront_event shown{};
  shown.kind = event.kind;
  shown.text = event.text.c_str();
  std::copy(event.values.begin(), event.values.end(), shown.values);
  watcher_(watcher_data_, &shown);
}

void octafront_job::watch(octafront_watcher watcher, void* data) {
  watcher_ = watcher;
  watcher_data_ = data;
}

void octafront_job::post(Event event) {
  if (!has_threads() && watcher_ != nullptr) return show(event);
  const std::lock_guard lock(mutex_);
  events_.push_back(std::move(event));
  for_caller_.notify_all();
}

// Of a stage only the latest word counts, and nobody is woken for it: the caller looks often enough.
void octafront_job::post_progress(std::string_view stage, double fraction) {
  if (!has_threads() && watcher_ != nullptr) return show({OCTAFRONT_EVENT_PROGRESS, std::string(stage), {fraction}});
  const std::lock_guard lock(mutex_);
  if (events_.empty() || events_.back().kind != OCTAFRONT_EVENT_PROGRESS || events_.back().text != stage)
    events_.push_back({OCTAFRONT_EVENT_PROGRESS, std::string(stage), {}});
  events_.back().values[0] = fraction;
}

void octafront_job::ask_sizes(std::span<const Vec3> points, std::span<double> sizes_wanted) {
  octafront_event question{};
  question.kind = OCTAFRONT_EVENT_SIZES;
  question.points = &points.front().x;
  question.sizes = sizes_wanted.data();
  question.count = points.size();
  ask(question, cancelled_);
}

void octafront_job::ask(const octafront_event& question, const std::atomic<bool>& may_go) {
  if (!has_threads()) {
    if (watcher_ == nullptr)
      throw OptionError("what asks the caller wants a watcher where the library has no threads: octafront_job_watch()");
    watcher_(watcher_data_, &question);
  } else {
    std::unique_lock lock(mutex_);
    question_ = question;
    is_asked_ = true, is_shown_ = false;
    for_caller_.notify_all();
    for_worker_.wait(lock, [&] { return !is_asked_ || may_go.load(); });
    is_asked_ = is_shown_ = false;
  }
  if (may_go.load()) throw Cancelled();
}

// Who is cancelled still tells the others; only one that is freed is gone.
Ranks* octafront_job::ranks_of(const octafront_options* options) {
  if (options == nullptr || options->ranks < 2) return nullptr;
  ranks_ = std::make_unique<JobRanks>(options->rank, options->ranks,
                                      [this](const octafront_event& talk) { ask(talk, freed_); });
  return ranks_.get();
}

Options octafront_job::options_of(const octafront_options* given) {
  if (given == nullptr) return {};
  Options options = given->options;
  if (given->asks_sizes)
    options.size.callback = [this](std::span<const Vec3> points, std::span<double> answers) {
      ask_sizes(points, answers);
    };
  if (given->tells_passes) {
    options.improve.after_pass = [this](const std::string& pass, const ImproveOptions::Worst& worst) {
      post(
          {OCTAFRONT_EVENT_PASS, pass, {worst.beta, worst.dihedral_min, worst.dihedral_max, worst.positive ? 1. : 0.}});
    };
  }
  return options;
}

bool octafront_job::take_event(octafront_event& event) {
  event = {};
  if (!events_.empty()) {
    current_ = std::move(events_.front());
    events_.pop_front();
    event.kind = current_.kind;
    event.text = current_.text.c_str();
    std::copy(current_.values.begin(), current_.values.end(), event.values);
    return true;
  }
  if (is_asked_ && !is_shown_) {
    is_shown_ = true;
    event = question_;
    return true;
  }
  if (ended_) event.kind = OCTAFRONT_EVENT_END;
  return ended_;
}

int octafront_job::wait(double seconds, octafront_event& event) {
  if (!has_threads()) run_here();
  std::unique_lock lock(mutex_);
  const auto something = [&] { return take_event(event); };
  if (seconds < 0)
    for_caller_.wait(lock, something);
  else
    for_caller_.wait_for(lock, std::chrono::duration<double>(seconds), something);
  return event.kind;
}

// An answer to a question that was taken back, as the job was cancelled, is none to the next.
void octafront_job::answer() {
  const std::lock_guard lock(mutex_);
  if (is_shown_) is_asked_ = false;
  for_worker_.notify_all();
}

void octafront_job::cancel() {
  const std::lock_guard lock(mutex_);
  cancelled_.store(true);
  for_worker_.notify_all();
}

const char* octafront_job::report_text() {
  // Names of files may hold bytes that no text has.
  report_text_ = report.dump(-1, ' ', false, Json::error_handler_t::replace);
  return report_text_.c_str();
}

int octafront_job_wait(octafront_job* job, double seconds, octafront_event* event) {
  return job->wait(seconds, *event);
}

int octafront_has_threads() {
  return has_threads() ? 1 : 0;
}

void octafront_job_watch(octafront_job* job, octafront_watcher watcher, void* data) {
  job->watch(watcher, data);
}

void octafront_job_answer(octafront_job* job) {
  job->answer();
}

void octafront_job_cancel(octafront_job* job) {
  job->cancel();
}

void octafront_job_free(octafront_job* job) {
  delete job;
}

int octafront_job_status(const octafront_job* job) {
  return job->status();
}

const char* octafront_job_message(const octafront_job* job) {
  return job->message();
}

const char* octafront_job_report(octafront_job* job) {
  return job->report_text();
}

const char* octafront_job_bytes(const octafront_job* job, size_t* length) {
  *length = job->bytes.size();
  return job->bytes.data();
}

octafront_surface* octafront_job_take_surface(octafront_job* job) {
  return job->surface.release();
}

octafront_mesh* octafront_job_take_mesh(octafront_job* job) {
  return job->mesh.release();
}

octafront_sizes* octafront_job_take_sizes(octafront_job* job) {
  return job->sizes.release();
}

octafront_image* octafront_job_take_image(octafront_job* job) {
  return job->image.release();
}
