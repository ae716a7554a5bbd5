#include "base/shared/virtual_ranks.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace octafront {

namespace {

/// Where the ranks lay out what they have for the others. Between two meetings nobody changes it.
struct Board {
  struct Place {
    const std::byte* bytes = nullptr;
    std::span<const std::size_t> sizes;  ///< of what goes to each rank
  };

  explicit Board(std::size_t count) : places(count) {}

  /// Returns once all ranks are there.
  void meet() {
    std::unique_lock lock(mutex);
    const std::size_t meeting = meetings;
    if (++there == places.size()) {
      there = 0, ++meetings;
      changed.notify_all();
      return;
    }
    changed.wait(lock, [&] { return meetings != meeting || has_left; });
    if (meetings == meeting) throw RankFailure(RankFailure::Kind::kOther, "a rank has ended before the others");
  }

  void leave() {
    const std::lock_guard lock(mutex);
    has_left = true;
    changed.notify_all();
  }

  std::vector<Place> places;
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t there = 0, meetings = 0;
  bool has_left = false;
};

class VirtualRank : public Ranks {
 public:
  VirtualRank(Board& board, std::size_t rank) : board_(board), rank_(rank) {}

  int rank() const override { return static_cast<int>(rank_); }
  int size() const override { return static_cast<int>(board_.places.size()); }

  void gather(std::span<const std::byte> mine, std::span<const std::size_t> sizes, std::byte* all) override {
    board_.places[rank_] = {mine.data(), sizes};
    board_.meet();
    for (std::size_t r = 0; r < sizes.size(); ++r) all = std::copy_n(board_.places[r].bytes, sizes[r], all);
    board_.meet();
  }

  void exchange(const std::byte* out, std::span<const std::size_t> out_sizes, std::byte* in,
                std::span<const std::size_t> in_sizes) override {
    board_.places[rank_] = {out, out_sizes};
    board_.meet();
    for (std::size_t r = 0; r < in_sizes.size(); ++r) {
      const auto& [bytes, sizes] = board_.places[r];
      std::size_t first = 0;
      for (std::size_t k = 0; k < rank_; ++k) first += sizes[k];
      in = std::copy_n(bytes + first, in_sizes[r], in);
    }
    board_.meet();
  }

 private:
  Board& board_;
  const std::size_t rank_;
};

}  // namespace

void run_virtual_ranks(int count, const std::function<void(Ranks&)>& rank) {
  const auto n = static_cast<std::size_t>(count);
  Board board(n);
  std::vector<std::exception_ptr> errors(n);
  std::vector<std::thread> threads;
  for (std::size_t r = 0; r < n; ++r)
    threads.emplace_back([&, r] {
      VirtualRank self(board, r);
      try {
        rank(self);
      } catch (...) {
        errors[r] = std::current_exception();
      }
      board.leave();
    });
  for (std::thread& t : threads) t.join();
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace octafront
