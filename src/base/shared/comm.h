#pragma once

// base/shared: what the processes that make one mesh say to each other. Only what cannot depend on an order: sums of
// integers, least numbers, lists in the order of ranks. Whatever goes wrong on one rank is told to all in the next
// round of talk, so that none waits for another.
//
// Three back ends: none (null), where all is answered at once; VirtualRanks, threads of one process, for tests; MPI, in
// a library of its own.

#include <octafront/ranks.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <string_view>
#include <vector>

namespace octafront {

using Bytes = std::vector<std::byte>;

/// What all ranks gave, in the order of ranks, in one piece of memory.
class Gathered {
 public:
  Gathered(Bytes all, std::vector<std::size_t> sizes) : all_(std::move(all)), sizes_(std::move(sizes)) {}
  std::size_t size() const { return sizes_.size(); }
  /// `visit(rank, bytes)` for each rank in turn.
  template <class Visit>
  void for_each(const Visit& visit) const {
    std::size_t first = 0;
    for (std::size_t r = 0; r < sizes_.size(); ++r) {
      visit(static_cast<int>(r), std::span<const std::byte>(all_).subspan(first, sizes_[r]));
      first += sizes_[r];
    }
  }

 private:
  Bytes all_;
  std::vector<std::size_t> sizes_;
};

/// The talk of one rank with the others. Every member is called by all ranks, in the same order, with the same `what`:
/// a name for messages, and to find out where ranks came out of step. All throw together(). Alone, they do what is left
/// to do.
class Comm {
 public:
  explicit Comm(Ranks* ranks) : ranks_(ranks != nullptr && ranks->size() > 1 ? ranks : nullptr) {}

  bool alone() const { return ranks_ == nullptr; }
  int rank() const { return alone() ? 0 : ranks_->rank(); }
  int size() const { return alone() ? 1 : ranks_->size(); }
  /// Not alone only.
  RankUse& use() const { return ranks_->use; }

  /// Each number becomes the sum of all ranks'.
  void sum(std::span<std::int64_t> numbers, std::string_view what) const;
  /// Each number becomes the least of all ranks'.
  void least(std::span<double> numbers, std::string_view what) const;
  /// The sum of what the ranks before this one give.
  std::int64_t before(std::int64_t mine, std::string_view what) const;
  Gathered gather(const Bytes& mine, std::string_view what) const;
  /// out[r] goes to rank r; comes back what the ranks have sent here.
  Gathered exchange(std::vector<Bytes> out, std::string_view what) const;
  void agree(std::uint64_t hash, std::string_view what) const;

  /// How a failure is told.
  enum class Telling {
    kNamesRank,  ///< something that this rank met alone, or all of them alike
    kAsIfAlone,  ///< of the library's own errors: as a process alone would have thrown it, for its callers
  };
  /// Tells all ranks of `error`, and throws what they all throw: instead of what they are about to say next.
  [[noreturn]] void fail(const std::exception_ptr& error, std::string_view stage, Telling telling) const;

  /// work() on each rank; where it throws on one, all throw. Ends with a round of talk.
  template <class Work>
  void together(std::string_view stage, Telling telling, const Work& work) const {
    attempt(stage, telling, work);
    agree(0, stage);
  }

  /// The same without the round: who comes through learns of failures in his next one.
  template <class Work>
  auto attempt(std::string_view stage, Telling telling, const Work& work) const {
    if (alone()) return work();
    try {
      return work();
    } catch (...) {
      if (was_told()) throw;
      fail(std::current_exception(), stage, telling);
    }
  }

 private:
  struct Word;
  struct Failure;

  /// In a catch clause: whether all ranks know of what is handled.
  bool was_told() const;
  std::vector<Word> round(const Word& mine, const Failure* failure) const;
  [[noreturn]] void spread(const std::vector<Word>& words, const Failure* failure) const;
  /// Memory for what is to come; a rank that has none says so, and all throw.
  Bytes room_for(std::size_t size, std::string_view what) const;

  Ranks* ranks_;
};

}  // namespace octafront
