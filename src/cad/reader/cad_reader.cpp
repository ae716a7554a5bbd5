#include "cad/reader/cad_reader.h"

#include <octafront/error.h>
#include <octafront/limits.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __APPLE__
#include <crt_externs.h>
#else
extern char** environ;
#endif

namespace octafront::cad {

namespace {

/// How often the user is heard while the program works.
constexpr int kPollMilliseconds = 50;
/// How a program ends that cannot be loaded.
constexpr int kNotStarted = 127;
/// Nothing that octafront-cad sends is longer.
constexpr std::uint64_t kLongestFrame = std::uint64_t{1} << 36;

void close_end(int& fd) {
  if (fd >= 0) close(fd);
  fd = -1;
}

/// What programs that are started are told of this one's; libraries of macOS see it by a function alone.
char** environment() {
#ifdef __APPLE__
  return *_NSGetEnviron();
#else
  return environ;
#endif
}

int open_pipe(std::array<int, 2>& ends) {
#ifdef __APPLE__
  // There is no pipe2().
  if (pipe(ends.data()) != 0) return -1;
  for (const int fd : ends) fcntl(fd, F_SETFD, FD_CLOEXEC);
  return 0;
#else
  return pipe2(ends.data(), O_CLOEXEC);
#endif
}

/// A pipe whose ends no other program that is started meanwhile inherits.
std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{-1, -1};
  if (open_pipe(ends) != 0) throw InputError(fmt::format("no pipe to the CAD reader: {}", std::strerror(errno)));
  return ends;
}

/// Signals that are blocked in this thread, and came meanwhile, are had.
void take_pending(const sigset_t& signals) {
#ifdef __APPLE__
  // There is no sigtimedwait(). SIGPIPE goes to the thread that wrote, so nobody else takes what is seen here.
  for (sigset_t pending; sigpending(&pending) == 0 && sigismember(&pending, SIGPIPE) == 1;) {
    int taken = 0;
    sigwait(&signals, &taken);
  }
#else
  const timespec now{};
  while (sigtimedwait(&signals, nullptr, &now) > 0) {
  }
#endif
}

std::string place_of(const Where& where) {
  if (where.lo == where.hi) return "";
  const Vec3 c = 0.5 * (where.lo + where.hi);
  return fmt::format(", around ({:.6g}, {:.6g}, {:.6g})", c.x, c.y, c.z);
}

std::string in_words(const Where& where) {
  if (where.stage.empty()) return "at its start";
  return fmt::format("while {}{}{}", where.stage, where.what.empty() ? "" : " " + where.what, place_of(where));
}

/// No more than is left to the whole run.
ReaderOptions within_limits(ReaderOptions options) {
  options.seconds = std::min(options.seconds, std::max(1.0, std::ceil(cpu_seconds_left())));
  options.memory = std::min(options.memory, memory_at_most());
  return options;
}

}  // namespace

/// The program and the pipes to it. Writing to one that is dead must not kill us: SIGPIPE is held off by the caller's
/// thread while it writes.
class CadReader::Process {
 public:
  Process(const std::string& file, const ReaderOptions& options, Tell tell, const RunContext& context)
      : options_(within_limits(options)),
        is_hurried_(options_.seconds < options.seconds),
        tell_(std::move(tell)),
        context_(context) {
    const std::string program = reader_program();
    std::array<int, 2> to = make_pipe(), from = make_pipe();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, to[0], 0);
    posix_spawn_file_actions_adddup2(&actions, from[1], 1);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    std::vector<std::string> arguments = arguments_of(program, file);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    const int failed = posix_spawn(&pid_, program.c_str(), &actions, nullptr, argv.data(), environment());
    posix_spawn_file_actions_destroy(&actions);
    close_end(to[0]), close_end(from[1]);
    to_ = to[1], from_ = from[0];
    if (failed != 0) {
      pid_ = -1;
      throw InputError(fmt::format("{} does not start: {}", program, std::strerror(failed)));
    }
  }

  ~Process() {
    close_end(to_), close_end(from_);
    if (pid_ > 0) kill(pid_, SIGKILL), waitpid(pid_, nullptr, 0);
    count_ended_programs();
  }
  Process(const Process&) = delete;

  void send(const std::string& line) {
    sigset_t pipe, before;
    sigemptyset(&pipe), sigaddset(&pipe, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe, &before);
    std::size_t sent = 0;
    while (sent < line.size()) {
      const ssize_t n = write(to_, line.data() + sent, line.size() - sent);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) break;  // it is dead: reading will tell
      sent += static_cast<std::size_t>(n);
    }
    take_pending(pipe);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  /// The content of the next frame of this kind; tells what comes before it.
  std::string answer(FrameKind wanted) {
    for (;;) {
      const std::optional<Head> head = head_of(take(kFrameHead));
      if (!head || head->length > kLongestFrame) throw InputError("the CAD reader does not keep to its protocol");
      std::string content = take(head->length);
      if (head->kind == wanted) return content;
      if (head->kind == FrameKind::kError) throw InputError(content);
      if (head->kind == FrameKind::kNote && tell_) tell_(content);
      if (head->kind == FrameKind::kProgress) {
        where_ = where_of(content);
        context_.report(where_.stage, where_.done);
      }
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::vector<std::string> arguments_of(const std::string& program, const std::string& file) const {
    std::vector<std::string> arguments{program,     file,
                                       "--memory",  std::to_string(options_.memory),
                                       "--cpu",     std::to_string(static_cast<long>(options_.seconds)),
                                       "--overlap", word_of(options_.overlap)};
    if (options_.tolerance > 0)
      arguments.insert(arguments.end(), {"--tolerance", fmt::format("{}", options_.tolerance)});
    if (!options_.heals) arguments.push_back("--no-heal");
    if (options_.keeps_going) arguments.push_back("--keep-going");
    return arguments;
  }

  std::string take(std::uint64_t n) {
    while (received_.size() - read_ < n) receive();
    std::string taken = received_.substr(read_, n);
    read_ += n;
    if (read_ == received_.size()) received_.clear(), read_ = 0;
    return taken;
  }

  /// Waits for bytes; throws where none will come.
  void receive() {
    const auto begun = Clock::now();
    for (;;) {
      context_.check();
      pollfd waiting{from_, POLLIN, 0};
      const int ready = poll(&waiting, 1, kPollMilliseconds);
      if (ready > 0) break;
      if (std::chrono::duration<double>(Clock::now() - begun).count() > options_.seconds)
        fail_as_slow("without a sign of life");
    }
    std::array<char, 1 << 16> block;
    const ssize_t n = read(from_, block.data(), block.size());
    if (n < 0 && errno == EINTR) return;
    if (n <= 0) fail_as_ended();
    received_.append(block.data(), static_cast<std::size_t>(n));
  }

  [[noreturn]] void fail_as_slow(const char* how) const {
    const std::string what =
        fmt::format("the CAD reader was stopped after {:.0f} s {} {}", options_.seconds, how, in_words(where_));
    if (is_hurried_)
      throw LimitError(LimitError::Limit::kCpuSeconds, what + ", when the run's time was spent (`cpu_seconds`)");
    throw InputError(what + ". Give it more by `cad_seconds`, or a larger size");
  }

  [[noreturn]] void fail_as_ended() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (signal == SIGXCPU || signal == SIGKILL) fail_as_slow("of work");
    if (WIFEXITED(status) && WEXITSTATUS(status) == kNotStarted && where_.stage.empty())
      throw InputError(
          "the CAD reader octafront-cad does not start: OpenCASCADE's libraries are not here, or not those that it was "
          "built with. On Debian 12: apt-get install libocct-data-exchange-7.6 libocct-ocaf-7.6");
    throw InputError(fmt::format(
        "the CAD reader (OpenCASCADE) failed {}: {}. The file may be damaged there; export it again, or leave that "
        "part out",
        in_words(where_),
        signal != 0 ? fmt::format("signal {}", signal) : fmt::format("exit status {}", WEXITSTATUS(status))));
  }

  ReaderOptions options_;
  bool is_hurried_;  ///< by what is left of the run's own CPU seconds
  Tell tell_;
  const RunContext& context_;
  pid_t pid_ = -1;
  int to_ = -1, from_ = -1;
  std::string received_;
  std::size_t read_ = 0;
  Where where_;
};

CadReader::CadReader(const std::string& file, const ReaderOptions& options, Tell tell, const RunContext& context)
    : process_(std::make_unique<Process>(file, options, std::move(tell), context)),
      opened_(opened_of(process_->answer(FrameKind::kOpened))) {}

CadReader::~CadReader() = default;

CadModel CadReader::triangulate(const Fineness& fineness) {
  process_->send(fmt::format("triangulate {:.17g} {:.17g}\n", fineness.deflection, fineness.angle));
  return model_of(process_->answer(FrameKind::kModel));
}

}  // namespace octafront::cad
