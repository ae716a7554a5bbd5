#include "child_process.h"

#include <octafront/error.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <utility>

#include <fmt/core.h>
#ifndef _WIN32
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#endif
#ifdef __APPLE__
#include <mach-o/dyld.h>
#endif
#ifdef __linux__
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#if __has_include(<linux/close_range.h>)
#include <linux/close_range.h>
#endif
#endif

namespace octafront::cli {

std::filesystem::path this_program() {
#ifdef __APPLE__
  std::array<char, 4096> name{};
  auto size = static_cast<std::uint32_t>(name.size());
  if (_NSGetExecutablePath(name.data(), &size) == 0) return name.data();
#endif
  std::error_code error;
  const std::filesystem::path found = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::path("octafront") : found;
}

#ifdef _WIN32

ChildProcess::ChildProcess(const std::vector<std::string>&, const ChildSetting&) {
  throw OutputError("programs cannot be started in this way on Windows");
}
ChildProcess::~ChildProcess() = default;
void ChildProcess::interrupt() {}
void ChildProcess::kill() {}
int ChildProcess::wait() {
  return 0;
}
bool ChildProcess::read_from(int&, std::string&) {
  return false;
}

#else

namespace {

constexpr int kCannotRun = 127;

#ifdef __linux__

/// Rights of Landlock's first version (Linux 5.13), and to move files between the folders.
constexpr std::uint64_t kRead = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR | LANDLOCK_ACCESS_FS_EXECUTE;
constexpr std::uint64_t kFirstVersion = (std::uint64_t{1} << 13) - 1, kRefer = std::uint64_t{1} << 13;

void allow(int rules, const std::filesystem::path& folder, std::uint64_t rights) {
  const int there = ::open(folder.c_str(), O_PATH | O_CLOEXEC);
  if (there < 0) return;
  landlock_path_beneath_attr rule{};
  rule.allowed_access = rights, rule.parent_fd = there;
  ::syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  ::close(there);
}

/// What this process and those that it starts can open from now on; nothing changes where the kernel cannot.
void shut_in(const std::vector<std::string>& folders, const std::filesystem::path& program) {
  const long version = ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return;
  const std::uint64_t all = version < 2 ? kFirstVersion : kFirstVersion | kRefer;
  landlock_ruleset_attr handled{};
  handled.handled_access_fs = all;
  const int rules =
      static_cast<int>(::syscall(SYS_landlock_create_ruleset, &handled, sizeof handled.handled_access_fs, 0));
  if (rules < 0) return;
  for (const char* system : {"/usr", "/lib", "/lib64", "/bin", "/etc", "/proc", "/sys", "/dev", "/opt"})
    allow(rules, system, kRead);
  allow(rules, "/dev/null", LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE);
  // Its libraries, and the program that reads CAD.
  allow(rules, program.parent_path().parent_path(), kRead);
  if (const char* reader = std::getenv("OCTAFRONT_CAD"))
    allow(rules, std::filesystem::path(reader).parent_path(), kRead);
  for (const std::string& folder : folders) allow(rules, folder, all);
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  ::syscall(SYS_landlock_restrict_self, rules, 0);
  ::close(rules);
}

#else
void shut_in(const std::vector<std::string>&, const std::filesystem::path&) {}
#endif

/// What this process has open beyond the standard streams, such as connections, is not for the program that it becomes.
void leave_files_behind() {
#if defined(__linux__) && defined(SYS_close_range) && defined(CLOSE_RANGE_CLOEXEC)
  ::syscall(SYS_close_range, STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
#endif
}

[[noreturn]] void become(const std::filesystem::path& program, std::vector<char*>& argv, const ChildSetting& setting,
                         int output, int errors) {
  ::setpgid(0, 0);
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (::dup2(nothing, STDIN_FILENO) < 0 || ::dup2(output, STDOUT_FILENO) < 0 || ::dup2(errors, STDERR_FILENO) < 0)
    ::_exit(kCannotRun);
  if (::chdir(setting.folder.c_str()) != 0) ::_exit(kCannotRun);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, SIG_DFL);
  for (const std::string& variable : setting.environment)
    if (const std::size_t equals = variable.find('='); equals != std::string::npos)
      ::setenv(variable.substr(0, equals).c_str(), variable.c_str() + equals + 1, 1);
  leave_files_behind();
  shut_in(setting.folders, program);
  ::execv(program.c_str(), argv.data());
  ::_exit(kCannotRun);
}

std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) throw OutputError("no pipe can be made");
  for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return ends;
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments, const ChildSetting& setting) {
  const std::filesystem::path program = this_program();
  std::vector<std::string> words{"octafront"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::array<int, 2> output = make_pipe(), errors = make_pipe();
  process_ = ::fork();
  if (process_ == 0) become(program, argv, setting, output[1], errors[1]);
  ::close(output[1]), ::close(errors[1]);
  output_ = output[0], errors_ = errors[0];
  if (process_ < 0) throw OutputError("no process can be made");
  ::setpgid(process_, process_);
}

ChildProcess::~ChildProcess() {
  kill();
  wait();
  for (const int pipe : {output_, errors_})
    if (pipe >= 0) ::close(pipe);
}

bool ChildProcess::read_from(int& pipe, std::string& to) {
  std::array<char, 1 << 16> buffer{};
  while (pipe >= 0) {
    const ssize_t count = ::read(pipe, buffer.data(), buffer.size());
    if (count > 0) {
      to.append(buffer.data(), static_cast<std::size_t>(count));
    } else if (count < 0 && (errno == EAGAIN || errno == EINTR)) {
      return true;
    } else {
      ::close(std::exchange(pipe, -1));
    }
  }
  return false;
}

void ChildProcess::interrupt() {
  if (process_ > 0) ::kill(-process_, SIGTERM);
}

void ChildProcess::kill() {
  if (process_ > 0) ::kill(-process_, SIGKILL);
}

int ChildProcess::wait() {
  int status = 0;
  if (process_ <= 0) return 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  // What it started and left behind.
  ::kill(-std::exchange(process_, -1), SIGKILL);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

#endif

}  // namespace octafront::cli
