#pragma once

#include <octafront/ranks.h>

#include <mpi.h>

namespace octafront {

/// The ranks of an MPI communicator. In a library of its own, octafront::mpi, for programs that use MPI: built with
/// OCTAFRONT_MPI.
///
/// Between MPI_Init_thread (MPI_THREAD_SERIALIZED, or MPI_THREAD_FUNNELED where generate() is called by the main
/// thread) and MPI_Finalize:
///
///     MpiRanks ranks(MPI_COMM_WORLD);
///     RunContext context;
///     context.ranks = &ranks;
///     const Result result = generate(domain, options, context);   // the same on all ranks
///
/// It speaks on a copy of the communicator, so its messages meet no others. A rank that is lost ends all, as MPI does
/// by default.
class MpiRanks : public Ranks {
 public:
  /// `most_bytes`: of a message; longer ones go in parts, for MPI counts in 31 bits.
  explicit MpiRanks(MPI_Comm communicator, std::size_t most_bytes = std::size_t{1} << 30);
  ~MpiRanks() override;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void gather(std::span<const std::byte> mine, std::span<const std::size_t> sizes, std::byte* all) override;
  void exchange(const std::byte* out, std::span<const std::size_t> out_sizes, std::byte* in,
                std::span<const std::size_t> in_sizes) override;

  /// How many of the ranks are on this machine.
  int ranks_here() const;

 private:
  MPI_Comm communicator_;
  std::size_t most_bytes_;
  int rank_ = 0, size_ = 1;
};

}  // namespace octafront
