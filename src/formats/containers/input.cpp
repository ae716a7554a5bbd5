#include "formats/containers/input.h"

#include <octafront/error.h>
#include <octafront/limits.h>

#include "base/core/files_of_windows.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>
#ifndef _WIN32
#include <poll.h>
#endif

namespace octafront::io {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

std::string system_reason(int error) {
  return std::generic_category().message(error);
}

/// Until there is something to read, or the writer of a pipe has gone.
void wait_for_bytes([[maybe_unused]] int fd, const RunContext& context) {
#ifdef _WIN32
  context.check();  // reading waits, where nothing can be asked beforehand
#else
  constexpr int kMilliseconds = 20;
  pollfd waiting{fd, POLLIN, 0};
  do {
    context.check();
  } while (::poll(&waiting, 1, kMilliseconds) <= 0);
#endif
}

/// Bytes read, at most `size`; fewer only at the end of the file.
std::size_t read_fully(int fd, char* to, std::size_t size, const std::string& name, const RunContext& context) {
  std::size_t done = 0;
  while (done < size) {
    constexpr std::size_t kMostAtOnce = std::size_t{1} << 24;
    wait_for_bytes(fd, context);
    const ssize_t got = ::read(fd, to + done, std::min(size - done, kMostAtOnce));
    if (got == 0) break;
    if (got < 0) {
      if (errno == EINTR || errno == EAGAIN) continue;
      throw InputError(fmt::format("{}, byte {}: cannot be read: {}", name, done, system_reason(errno)));
    }
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::unique_ptr<char[]> allocate(std::size_t size, const std::string& name) {
  try {
    return std::unique_ptr<char[]>(new char[size]);
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("{}: too large for this machine's memory ({} bytes)", name, size));
  }
}

/// A pipe has no size beforehand.
std::pair<std::unique_ptr<char[]>, std::size_t> read_pipe(int fd, const std::string& name, const RunContext& context) {
  std::size_t capacity = std::size_t{1} << 16, size = 0;
  auto bytes = allocate(capacity, name);
  while ((size += read_fully(fd, bytes.get() + size, capacity - size, name, context)) == capacity) {
    auto larger = allocate(2 * capacity, name);
    std::memcpy(larger.get(), bytes.get(), size);
    bytes = std::move(larger);
    capacity *= 2;
  }
  return {std::move(bytes), size};
}

std::size_t line_of(std::string_view bytes, const char* at) {
  const auto before = bytes.substr(0, static_cast<std::size_t>(at - bytes.data()));
  const auto feeds = std::count(before.begin(), before.end(), '\n');
  if (feeds == 0 && bytes.find('\n') == std::string_view::npos)
    return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\r'));
  return 1 + static_cast<std::size_t>(feeds);
}

/// Without the byte order mark that some editors put before a text in UTF-8. The head of a binary STL file, which may
/// be anything, is followed by a count with a zero byte.
std::string_view without_mark(std::string_view bytes) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  constexpr std::size_t kHead = 84;
  const bool is_text = bytes.substr(0, kHead).find('\0') == std::string_view::npos;
  return bytes.starts_with(kMark) && is_text ? bytes.substr(kMark.size()) : bytes;
}

}  // namespace

void Input::fail(std::string_view message) const {
  throw InputError(fmt::format("{}: {}", name, message));
}

void Input::fail_at_line(const char* at, std::string_view message) const {
  throw InputError(fmt::format("{}, line {}: {}", name, line_of(bytes, at), message));
}

void Input::fail_at_byte(const char* at, std::string_view message) const {
  throw InputError(fmt::format("{}, byte {}: {}", name, at - bytes.data(), message));
}

void ReadingProgress::tell(const char* at) {
  input_->context.check();
  const double size = static_cast<double>(input_->bytes.size());
  input_->context.report("reading", static_cast<double>(at - input_->bytes.data()) / size);
  set_next(at);
}

LoadedFile::LoadedFile(const std::filesystem::path& file, const RunContext& context) {
  input_.name = file.string();
  input_.context = context;
  require_in_folders(input_.name);
  // A pipe that nobody writes to would block the opening, where nothing could cancel it.
  const Descriptor fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (fd.get() < 0) {
    if (errno == ENOENT) input_.fail("there is no such file");
    input_.fail(fmt::format("cannot be opened: {}", system_reason(errno)));
  }
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) input_.fail(fmt::format("cannot be examined: {}", system_reason(errno)));
  if (S_ISDIR(status.st_mode)) input_.fail("is a directory, not a file");
  std::size_t size = 0;
  if (S_ISREG(status.st_mode)) {
    size = static_cast<std::size_t>(status.st_size);
    bytes_ = allocate(size, input_.name);
    size = read_fully(fd.get(), bytes_.get(), size, input_.name, context);
  } else if (S_ISFIFO(status.st_mode)) {
    std::tie(bytes_, size) = read_pipe(fd.get(), input_.name, context);
  } else {
    input_.fail("is a device or socket, not a file");
  }
  input_.bytes = without_mark({bytes_.get(), size});
  if (size == 0) input_.fail("is empty (0 bytes); export or copy it again");
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string out = "\"";
  for (const char c : text.substr(0, kMost)) {
    const auto u = static_cast<unsigned char>(c);
    if (u >= 0x20 && u < 0x7f) {
      out += c;
    } else {
      out += fmt::format("\\x{:02x}", u);
    }
  }
  if (text.size() > kMost) out += "...";
  return out + '"';
}

std::string names_in_quotes(std::span<const std::string> names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + in_quotes(name);
  return list;
}

}  // namespace octafront::io
