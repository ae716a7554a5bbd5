#pragma once

#include "base/core/parallel.h"
#include "base/shared/packing.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace octafront {

/// Where the stretch of a rank begins, of things that are shared evenly.
inline std::size_t begin_of_stretch(std::size_t rank, std::size_t ranks, std::size_t count) {
  return count / ranks * rank + std::min(rank, count % ranks);
}

/// Which of many jobs in a row each rank does: stretches of about the same work. Who does a job changes nothing in the
/// result, for jobs are pure and results are joined in the order of jobs.
class Shares {
 public:
  /// `work`: of each job, in any unit; all ranks give the same.
  Shares(std::span<const std::uint64_t> work, int ranks);

  std::size_t begin(int rank) const { return first_[static_cast<std::size_t>(rank)]; }
  std::size_t end(int rank) const { return first_[static_cast<std::size_t>(rank) + 1]; }
  int rank_of(std::size_t job) const {
    return static_cast<int>(std::ranges::upper_bound(first_, job) - first_.begin()) - 1;
  }

 private:
  std::vector<std::size_t> first_;  ///< jobs, per rank; one more
};

/// Wall time until its end counts as shared work of this rank.
class SharedWork {
 public:
  explicit SharedWork(const Comm& comm);
  ~SharedWork();
  SharedWork(const SharedWork&) = delete;
  SharedWork& operator=(const SharedWork&) = delete;

 private:
  const Comm& comm_;
  double start_;
};

/// job(i) for those of this rank, on its threads. What one rank's job throws, all throw: at once, or in their next
/// round of talk.
template <class Job>
void do_share(const Comm& comm, const Shares& shares, std::string_view what, const Job& job) {
  comm.attempt(what, Comm::Telling::kAsIfAlone, [&] {
    const SharedWork timer(comm);
    const std::size_t first = shares.begin(comm.rank());
    parallel_for(
        shares.end(comm.rank()) - first, [&](std::size_t i) { job(first + i); }, Split::kSingly);
  });
}

/// Gives every rank all results: pack(result, packer) of those that this rank has made, unpack(result, unpacker) of the
/// others'.
template <class Result, class Pack, class Unpack>
void gather_results(const Comm& comm, const Shares& shares, std::string_view what, std::vector<Result>& results,
                    const Pack& pack, const Unpack& unpack) {
  if (comm.alone()) return;
  Packer mine;
  comm.attempt(what, Comm::Telling::kNamesRank, [&] {
    for (std::size_t i = shares.begin(comm.rank()); i < shares.end(comm.rank()); ++i) pack(results[i], mine);
  });
  const Gathered all = comm.gather(mine.bytes(), what);
  mine = {};
  comm.attempt(what, Comm::Telling::kNamesRank, [&] {
    all.for_each([&](int rank, std::span<const std::byte> bytes) {
      if (rank == comm.rank()) return;
      Unpacker in(bytes);
      for (std::size_t i = shares.begin(rank); i < shares.end(rank); ++i) unpack(results[i], in);
    });
  });
}

}  // namespace octafront
