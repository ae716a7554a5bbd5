#pragma once

#include <octafront/error.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace octafront {

/// What a rank has done so far beside the work that every rank does by itself.
struct RankUse {
  std::uint64_t messages = 0;                     ///< rounds of talk, all ranks with all
  std::uint64_t bytes_sent = 0, bytes_taken = 0;  ///< given to each of the others; taken from them
  double seconds_talking = 0;                     ///< wall time, waiting for others included
  double seconds_shared = 0;                      ///< wall time of the rank's part of work that is shared
};

/// One of several processes that make one mesh together. Each calls generate() with the same domain and the same
/// options, and a Ranks of its own in RunContext::ranks; each gets the same mesh, the one that a process alone gets,
/// bit for bit (or its share of that: shares_tets). octafront/mpi.h has the ranks of an MPI communicator.
///
/// A back end does two things, both at the same time on all ranks, from one thread of each. It must not fail: where a
/// rank is lost it ends the process, as MPI does. Who has no such back end needs nothing of this.
class Ranks {
 public:
  virtual ~Ranks() = default;
  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  virtual int rank() const = 0;  ///< in [0, size())
  virtual int size() const = 0;

  /// What each rank has, to all: `all` is filled in the order of ranks. All ranks give the same `sizes`, of each rank;
  /// that of this one is mine.size(), and `all` has room for their sum.
  virtual void gather(std::span<const std::byte> mine, std::span<const std::size_t> sizes, std::byte* all) = 0;

  /// out_sizes[r] bytes of `out` to rank r, and in_sizes[r] bytes from it, each in the order of ranks. What one rank
  /// sends another expects.
  virtual void exchange(const std::byte* out, std::span<const std::size_t> out_sizes, std::byte* in,
                        std::span<const std::size_t> in_sizes) = 0;

  RankUse use;
  /// True: of the mesh made each rank may get the tetrahedra, and their regions, that it has in the end: a stretch,
  /// those of rank 0 first; points, faces and names are whole. Result::is_share says whether that is so. False: each
  /// gets all.
  bool shares_tets = false;

 private:
  friend class Comm;
  std::exception_ptr told_;  ///< what was thrown last on all ranks
};

/// What went wrong on one rank, as all of them throw it. CLI status as for `kind`.
class RankFailure : public Error {
 public:
  enum class Kind : std::uint8_t { kOption = 1, kInput, kMeshing, kOutput, kCancelled, kMemory, kOther };
  RankFailure(Kind failed, const std::string& what) : Error(what), kind(failed) {}
  Kind kind;
};

/// work() on each rank. Where it throws on some, all throw: what it threw, if that is the same on all; Cancelled, if
/// one was asked to stop; else a RankFailure that names the first rank that failed, `stage`, and the reason. Nobody
/// waits for a rank that has failed, however far it came. `ranks` null: work() and no more.
void together(Ranks* ranks, std::string_view stage, const std::function<void()>& work);

/// Throws a RankFailure on all ranks if they do not all give the same number, the hash of what is meant to be the same
/// on all of them. `ranks` null: never.
void agree(Ranks* ranks, std::uint64_t hash, std::string_view what);

}  // namespace octafront
