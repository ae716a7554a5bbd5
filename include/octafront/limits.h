#pragma once

#include <octafront/error.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace octafront {

/// A run took, or would take, more than it may, or a file from where it may not. CLI status 7; of memory 6.
class LimitError : public Error {
 public:
  enum class Limit { kElements, kCpuSeconds, kMemory, kFolders };
  LimitError(Limit of, const std::string& what) : Error(what), limit(of) {}
  Limit limit;
};

/// What this process may take as a whole, with the programs that it starts.
struct ProcessLimits {
  /// Bytes, > 0; none: as much as the machine has, or the control group that the process is in.
  std::optional<std::uint64_t> memory;
  std::optional<double> cpu_seconds;  ///< from now on, > 0; none: no limit
  /// Tetrahedra of a mesh that is made or read, and triangles of a surface that is made, >= 1; none: no limit.
  std::optional<std::uint64_t> elements;
  /// Files are read and written only in these folders and below, whoever names them: the user, or another file; empty:
  /// anywhere.
  std::vector<std::string> folders = {};
};

/// Sets the limits, once and before the work. Where memory ends, std::bad_alloc is thrown (on Linux; elsewhere only
/// what is known beforehand is refused). Where the time ends, RunContext::check() throws LimitError; a process that
/// does not come to ask for a quarter of it longer, or five seconds, is ended with status 7.
void set_process_limits(const ProcessLimits& limits);

/// Throws LimitError if a mesh has more elements than the limit; `of`: "the mesh", "in.msh".
void require_elements(double there, const std::string& of);
/// The same of a prediction: where it is so far beyond the limit that no mesh would come to it.
void require_expected_elements(double expected);

/// Bytes that this process may have at most: the least of what was set, of the system's limits and of the memory that
/// there is.
std::uint64_t memory_at_most();

/// Throws LimitError if `bytes`, for `what`, are more than that: "the 8e9 voxels of the image".
void require_memory(double bytes, const std::string& what);

/// "250 MB", "1.5 GB".
std::string bytes_in_words(double bytes);

/// Seconds that are left of the limit, those of programs that it started and that have ended taken off; infinity:
/// there is none.
double cpu_seconds_left();

/// To be called when such a program has ended: its seconds count from now on.
void count_ended_programs();

/// Whether a file, which need not exist, lies in one of the folders or below, once links and ".." are followed.
bool lies_in(const std::string& file, const std::vector<std::string>& folders);

/// Throws LimitError for a file that lies in none of the folders of the limits: to be called by all that opens files.
void require_in_folders(const std::string& file);

/// Throws LimitError once they are spent.
void check_cpu_seconds();

}  // namespace octafront
