#include "formats/containers/atomic_file.h"

#include <octafront/error.h>
#include <octafront/limits.h>

#include "base/core/files_of_windows.h"
#include "base/core/parallel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <mutex>
#include <set>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

namespace octafront::io {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

constexpr std::string_view kTemporary = ".tmp";

/// What names of temporary files of this machine begin with: others may share the folder, with processes of their own.
std::string name_of_ours() {
  std::array<char, 64> host{};
#ifndef _WIN32
  if (::gethostname(host.data(), host.size() - 1) != 0) host = {};
#endif
  std::string name = ".octafront-";
  for (const char c : std::string_view(host.data()))
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  return name + '-';
}

/// The process that a temporary file is of, by its name; 0: it is not one of this machine's.
int owner_of(std::string_view name, std::string_view ours) {
  if (!name.starts_with(ours) || !name.ends_with(kTemporary)) return 0;
  name.remove_prefix(ours.size());
  int process = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
  return error == std::errc() && *end == '-' ? process : 0;
}

/// What killed processes left in a folder goes, once for each folder that is written to.
void remove_those_of_dead([[maybe_unused]] const fs::path& folder) {
#ifndef _WIN32
  static std::mutex mutex;
  static std::set<fs::path> seen;
  const std::lock_guard lock(mutex);
  if (!seen.insert(folder).second) return;
  const std::string ours = name_of_ours();
  std::vector<fs::path> dead;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const int owner = owner_of(at->path().filename().string(), ours);
    if (owner > 0 && ::kill(owner, 0) != 0 && errno == ESRCH) dead.push_back(at->path());
  }
  for (const fs::path& file : dead) fs::remove_all(file, error);
#endif
}

}  // namespace

fs::path temporary_beside(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  remove_those_of_dead(folder_of(target));
  return folder_of(target) / fmt::format("{}{}-{}{}", name_of_ours(), ::getpid(), counter++, kTemporary);
}

// Replacing a link would cut it; what it points to is replaced instead, or made where it points to nothing yet.
fs::path links_followed(const fs::path& file) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  fs::path at = file;
  std::error_code error;
  for (int links = 0; fs::is_symlink(at, error); ++links) {
    const fs::path to = fs::read_symlink(at, error);
    if (error) throw OutputError(fmt::format("{}: cannot be written: {}", file.string(), error.message()));
    if (links == kMostLinks)
      throw OutputError(fmt::format("{}: cannot be written: its symbolic links lead in a circle", file.string()));
    at = folder_of(at) / to;
  }
  return at;
}

void check_writable(const fs::path& target) {
  const std::string name = target.string();
  require_in_folders(name);
  const fs::path file = links_followed(target);
  const fs::path folder = folder_of(file);
  std::error_code error;
  if (file.filename().empty()) throw OutputError(fmt::format("{}: is not the name of a file", name));
  if (!fs::is_directory(folder, error))
    throw OutputError(
        fmt::format("{}: cannot be written: there is no folder {}; create it first", name, folder.string()));
  const fs::file_status status = fs::status(file, error);
  if (fs::is_directory(status)) throw OutputError(fmt::format("{}: cannot be written: it is a folder", name));
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw OutputError(fmt::format("{}: cannot be written: it is not a plain file", name));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw OutputError(fmt::format("{}: cannot be written: the folder {}: {}", name, folder.string(),
                                  std::generic_category().message(errno)));
}

void check_folder_writable(const fs::path& target) {
  const std::string name = target.string();
  std::error_code error;
  if (!fs::exists(target, error)) return check_writable(target);
  require_in_folders(target.string());
  if (!fs::is_directory(target, error)) throw OutputError(name + ": cannot be written: it is no folder");
  if (!fs::is_empty(target, error) && !fs::exists(target / "faces", error))
    throw OutputError(name + ": cannot be written: the folder has other files, which would be lost; give another name");
}

void check_folder_of_pieces(const fs::path& target, const std::string& stem, const std::string& extension) {
  std::error_code error;
  if (!fs::exists(target, error)) return check_writable(target);
  require_in_folders(target.string());
  if (!fs::is_directory(target, error))
    throw OutputError(target.string() + ": cannot be written: it is no folder, which the pieces need");
  for (const fs::directory_entry& entry : fs::directory_iterator(target)) {
    const fs::path file = entry.path();
    const std::string name = file.stem().string();
    const bool is_piece = file.extension() == extension && name.size() > stem.size() + 1 &&
                          name.compare(0, stem.size() + 1, stem + '_') == 0 &&
                          name.find_first_not_of("0123456789", stem.size() + 1) == std::string::npos;
    if (!is_piece)
      throw OutputError(target.string() +
                        ": the pieces cannot be written: the folder has other files, which would be lost, such as " +
                        file.filename().string() + "; give another name");
  }
}

AtomicFile::AtomicFile(const fs::path& target, const RunContext& context)
    : context_(context), name_(target.string()), target_(links_followed(target)) {
  check_writable(target);
  struct stat status {};
  if (::stat(target_.c_str(), &status) == 0) mode_ = status.st_mode & 07777;
#ifdef O_TMPFILE
  // Giving a name to a nameless file goes through /proc.
  if (::access("/proc/self/fd", X_OK) == 0)
    fd_ = ::open(folder_of(target_).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, mode_);
#endif
  if (fd_ < 0) open_named();
}

void AtomicFile::open_named() {
  temporary_ = temporary_beside(target_);
  fd_ = ::open(temporary_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, mode_);
  if (fd_ >= 0) return;
  const int error = errno;
  temporary_.clear();
  fail("cannot be created", error);
}

AtomicFile::~AtomicFile() {
  if (fd_ >= 0) ::close(fd_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::fail(std::string_view what, int error) const {
  throw OutputError(fmt::format("{}: {}: {} (at byte {}); an older file of this name is unchanged", name_, what,
                                std::generic_category().message(error), position()));
}

void AtomicFile::write_out(const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t done = ::write(fd_, bytes, size);
    if (done < 0) {
      if (errno == EINTR) continue;
      fail("cannot be written", errno);
    }
    bytes += done;
    size -= static_cast<std::size_t>(done);
    flushed_ += static_cast<std::uint64_t>(done);
  }
}

void AtomicFile::flush() {
  context_.check();
  const std::size_t size = filled_;
  filled_ = 0;
  write_out(buffer_.get(), size);
}

void AtomicFile::write(const void* bytes, std::size_t size) {
  if (size > kBuffer - filled_) flush();
  if (size >= kBuffer) return write_out(static_cast<const char*>(bytes), size);
  std::memcpy(buffer_.get() + filled_, bytes, size);
  filled_ += size;
}

void AtomicFile::write_records(std::size_t count, std::size_t size,
                               FunctionRef<void(std::size_t begin, std::size_t end, char* to)> form) {
  const std::size_t batch = std::min(count, kBatch / size);  // records
  std::array<std::unique_ptr<char[]>, 2> room;
  for (auto& r : room) r.reset(new char[batch * size]);
  const auto form_batch = [&](std::size_t first, char* to) {
    const std::size_t records = std::min(batch, count - first);
    parallel_ranges(records, Split::kAdaptive,
                    [&](std::size_t begin, std::size_t end) { form(first + begin, first + end, to + begin * size); });
  };
  if (count > 0) form_batch(0, room[0].get());
  for (std::size_t first = 0; first < count; first += batch, std::swap(room[0], room[1])) {
    const std::size_t next = first + batch;
    parallel_invoke([&] { write(room[0].get(), std::min(batch, count - first) * size); },
                    [&] {
                      if (next < count) form_batch(next, room[1].get());
                    });
    context_.check();
  }
}

void AtomicFile::restart(std::uint64_t position) {
  flush();
  if (::ftruncate(fd_, static_cast<off_t>(position)) != 0 || ::lseek(fd_, static_cast<off_t>(position), SEEK_SET) < 0)
    fail("cannot be written again", errno);
  flushed_ = position;
}

void AtomicFile::overwrite(std::uint64_t position, const void* bytes, std::size_t size) {
  flush();
  const char* from = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t done = ::pwrite(fd_, from, size, static_cast<off_t>(position));
    if (done < 0) {
      if (errno == EINTR) continue;
      fail("cannot be written", errno);
    }
    from += done;
    position += static_cast<std::uint64_t>(done);
    size -= static_cast<std::size_t>(done);
  }
}

fs::path AtomicFile::path_for_library() const {
  return temporary_.empty() ? fs::path(fmt::format("/proc/self/fd/{}", fd_)) : temporary_;
}

#ifdef O_TMPFILE
void AtomicFile::give_name() {
  const fs::path name = temporary_beside(target_);
  const std::string self = fmt::format("/proc/self/fd/{}", fd_);
  if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
    temporary_ = name;
  } else {
    copy_to_named();
  }
}

/// Some file systems make nameless files but cannot name them.
void AtomicFile::copy_to_named() {
  const int nameless = fd_;
  struct stat status {};
  if (::fstat(nameless, &status) != 0) fail("cannot be copied", errno);
  const auto size = static_cast<std::uint64_t>(status.st_size);  // a library may have written it
  fd_ = -1;
  flushed_ = 0;
  try {
    open_named();
    for (std::uint64_t at = 0; at < size;) {
      const ssize_t got = ::pread(nameless, buffer_.get(), kBuffer, static_cast<off_t>(at));
      if (got <= 0) fail("cannot be copied", got < 0 ? errno : EIO);
      write_out(buffer_.get(), static_cast<std::size_t>(got));
      at += static_cast<std::uint64_t>(got);
    }
  } catch (...) {
    ::close(nameless);
    throw;
  }
  ::close(nameless);
  if (::fsync(fd_) != 0) fail("cannot be written to the disk", errno);
}
#endif

void AtomicFile::flush_to_disk() {
  flush();
  if (::fsync(fd_) != 0 && errno != EINVAL && errno != EROFS) fail("cannot be written to the disk", errno);
}

void AtomicFile::commit() {
  flush_to_disk();
  // A new file has the mode that the user's mask leaves; an old one keeps its own, which the mask must not touch.
  struct stat status {};
  if (::stat(target_.c_str(), &status) == 0) ::fchmod(fd_, status.st_mode & 07777);
#ifdef O_TMPFILE
  if (temporary_.empty()) give_name();
#endif
  const int closing = fd_;
  fd_ = -1;
  if (::close(closing) != 0) fail("cannot be closed", errno);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot be renamed into place", errno);
  temporary_.clear();
}

}  // namespace octafront::io
