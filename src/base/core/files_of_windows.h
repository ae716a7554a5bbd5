#pragma once

// Functions of POSIX that Windows has by other names, or for names in wide characters: what opens and writes files is
// written for POSIX, and includes this beside its headers. Empty elsewhere.

#ifdef _WIN32

#include <cerrno>
#include <cstdint>

#define WIN32_LEAN_AND_MEAN
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <sys/stat.h>
#include <unistd.h>
#include <windows.h>
// Words of segmented memory.
#undef near
#undef far

// Bytes as they are; no other program that is started meanwhile has the file.
#define O_CLOEXEC (_O_BINARY | _O_NOINHERIT)
#define O_NONBLOCK 0

inline int open(const wchar_t* file, int flags, unsigned mode = 0) {
  int made = -1;
  // Others may read and write it meanwhile, as on other systems.
  const int error = _wsopen_s(&made, file, flags, _SH_DENYNO, (mode & 0200) != 0 ? _S_IREAD | _S_IWRITE : _S_IREAD);
  if (error != 0) errno = error;
  return made;
}

/// `mode`: of W_OK and X_OK, which asks nothing of a folder here.
inline int access(const wchar_t* file, int mode) {
  return _waccess(file, mode & (R_OK | W_OK));
}

inline int stat(const wchar_t* file, struct stat* status) {
  struct _stat64 found {};
  if (_wstat64(file, &found) != 0) return -1;
  status->st_mode = found.st_mode;
  status->st_size = static_cast<decltype(status->st_size)>(found.st_size);
  return 0;
}

inline int unlink(const wchar_t* file) {
  return _wunlink(file);
}

/// Replaces what is there, in one step.
inline int rename(const wchar_t* from, const wchar_t* to) {
  if (MoveFileExW(from, to, MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0) return 0;
  errno = GetLastError() == ERROR_FILE_NOT_FOUND ? ENOENT : EACCES;
  return -1;
}

inline int fsync(int fd) {
  return _commit(fd);
}

/// Files have no modes.
inline int fchmod(int, unsigned) {
  return 0;
}

inline ssize_t pwrite(int fd, const void* bytes, std::size_t size, std::int64_t position) {
  const std::int64_t before = _telli64(fd);
  if (before < 0 || _lseeki64(fd, position, SEEK_SET) < 0) return -1;
  const ssize_t done = write(fd, bytes, static_cast<unsigned>(size < 0x40000000 ? size : 0x40000000));
  return _lseeki64(fd, before, SEEK_SET) < 0 ? -1 : done;
}

#endif
