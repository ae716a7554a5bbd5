// Functions of newer versions of glibc that libstdc++ and ours ask for, on top of those that an older one has: see
// backend/old_glibc.py. Compiled into what is to run there, and hidden from others.

#include <ctime>

#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>

extern "C" {

// Before 2.33 these four were calls of functions with the version of the structure.
int __xstat(int version, const char* file, struct stat* found);
int __lxstat(int version, const char* file, struct stat* found);
int __fxstat(int version, int descriptor, struct stat* found);
int __fxstatat(int version, int folder, const char* file, struct stat* found, int flags);

#ifdef __x86_64__
static const int kStatVersion = 1;
#else
static const int kStatVersion = 0;
#endif

#pragma GCC visibility push(hidden)

int stat(const char* file, struct stat* found) noexcept {
  return __xstat(kStatVersion, file, found);
}
int lstat(const char* file, struct stat* found) noexcept {
  return __lxstat(kStatVersion, file, found);
}
int fstat(int descriptor, struct stat* found) noexcept {
  return __fxstat(kStatVersion, descriptor, found);
}
int fstatat(int folder, const char* file, struct stat* found, int flags) noexcept {
  return __fxstatat(kStatVersion, folder, file, found, flags);
}
// The same structure on machines of 64 bits.
int stat64(const char* file, struct stat64* found) noexcept {
  return __xstat(kStatVersion, file, reinterpret_cast<struct stat*>(found));
}
int fstat64(int descriptor, struct stat64* found) noexcept {
  return __fxstat(kStatVersion, descriptor, reinterpret_cast<struct stat*>(found));
}

// 2.32: true would let shared_ptr count without atomic operations.
char __libc_single_threaded = 0;

// 2.30. The deadline of any clock as one of the clock that all conditions know.
int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                           const timespec* deadline) {
  timespec now, of_condition;
  clock_gettime(clock, &now);
  clock_gettime(CLOCK_REALTIME, &of_condition);
  constexpr std::int64_t kNanoseconds = 1'000'000'000;
  const std::int64_t left = (deadline->tv_sec - now.tv_sec) * kNanoseconds + deadline->tv_nsec - now.tv_nsec;
  const std::int64_t end = of_condition.tv_nsec + (left > 0 ? left : 0);
  of_condition.tv_sec += end / kNanoseconds;
  of_condition.tv_nsec = end % kNanoseconds;
  return pthread_cond_timedwait(condition, mutex, &of_condition);
}

// 2.25; libstdc++ asks for it in std::random_device alone.
int getentropy(void* to, std::size_t length) {
  const long got = syscall(SYS_getrandom, to, length, 0);
  if (got == static_cast<long>(length)) return 0;
  errno = EIO;
  return -1;
}

// 2.36, for the same.
std::uint32_t arc4random() noexcept {
  std::uint32_t value = 0;
  if (getentropy(&value, sizeof value) != 0) value = static_cast<std::uint32_t>(clock());
  return value;
}

#pragma GCC visibility pop
}
