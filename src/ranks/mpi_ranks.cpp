#include <octafront/mpi.h>
#include <octafront/ranks.h>

#include "ranks/message_parts.h"

#include <cstring>
#include <numeric>
#include <vector>

namespace octafront {

namespace {

std::size_t sum_of(std::span<const std::size_t> sizes) {
  return std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
}

/// As MPI wants them. REQUIRES that their sum fits.
std::vector<int> counts_of(std::span<const std::size_t> sizes) {
  return {sizes.begin(), sizes.end()};
}

std::vector<int> firsts_of(std::span<const std::size_t> sizes) {
  std::vector<int> firsts(sizes.size());
  std::exclusive_scan(sizes.begin(), sizes.end(), firsts.begin(), 0);
  return firsts;
}

}  // namespace

MpiRanks::MpiRanks(MPI_Comm communicator, std::size_t most_bytes) : most_bytes_(most_bytes) {
  MPI_Comm_dup(communicator, &communicator_);
  MPI_Comm_rank(communicator_, &rank_);
  MPI_Comm_size(communicator_, &size_);
}

MpiRanks::~MpiRanks() {
  int is_over = 0;
  MPI_Finalized(&is_over);
  if (!is_over) MPI_Comm_free(&communicator_);
}

void MpiRanks::gather(std::span<const std::byte> mine, std::span<const std::size_t> sizes, std::byte* all) {
  if (sum_of(sizes) <= most_bytes_) {
    MPI_Allgatherv(mine.data(), static_cast<int>(mine.size()), MPI_BYTE, all, counts_of(sizes).data(),
                   firsts_of(sizes).data(), MPI_BYTE, communicator_);
    return;
  }
  for (int r = 0; r < size_; ++r) {
    const std::size_t size = sizes[static_cast<std::size_t>(r)];
    if (r == rank_) std::memcpy(all, mine.data(), size);
    in_parts(size, most_bytes_,
             [&](std::size_t first, int count) { MPI_Bcast(all + first, count, MPI_BYTE, r, communicator_); });
    all += size;
  }
}

void MpiRanks::exchange(const std::byte* out, std::span<const std::size_t> out_sizes, std::byte* in,
                        std::span<const std::size_t> in_sizes) {
  // All take the same way.
  int fits = sum_of(out_sizes) <= most_bytes_ && sum_of(in_sizes) <= most_bytes_;
  MPI_Allreduce(MPI_IN_PLACE, &fits, 1, MPI_INT, MPI_MIN, communicator_);
  if (fits) {
    MPI_Alltoallv(out, counts_of(out_sizes).data(), firsts_of(out_sizes).data(), MPI_BYTE, in,
                  counts_of(in_sizes).data(), firsts_of(in_sizes).data(), MPI_BYTE, communicator_);
    return;
  }
  // Parts between two ranks arrive in the order in which they are sent.
  std::vector<MPI_Request> requests;
  for (int r = 0; r < size_; ++r) {
    const std::size_t size = in_sizes[static_cast<std::size_t>(r)];
    in_parts(size, most_bytes_, [&](std::size_t first, int count) {
      MPI_Irecv(in + first, count, MPI_BYTE, r, 0, communicator_, &requests.emplace_back());
    });
    in += size;
  }
  for (int r = 0; r < size_; ++r) {
    const std::size_t size = out_sizes[static_cast<std::size_t>(r)];
    in_parts(size, most_bytes_, [&](std::size_t first, int count) {
      MPI_Isend(out + first, count, MPI_BYTE, r, 0, communicator_, &requests.emplace_back());
    });
    out += size;
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

int MpiRanks::ranks_here() const {
  MPI_Comm here;
  MPI_Comm_split_type(communicator_, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
  int count = 1;
  MPI_Comm_size(here, &count);
  MPI_Comm_free(&here);
  return count;
}

}  // namespace octafront
