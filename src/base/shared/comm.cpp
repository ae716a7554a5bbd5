#include "base/shared/comm.h"

#include <octafront/limits.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <new>
#include <numeric>

#include <fmt/core.h>

namespace octafront {

/// What each rank says first in every round: how it is, what it is about to do, and how much it will send.
struct Comm::Word {
  std::uint64_t failed = 0;  ///< a RankFailure::Kind; 0: all is well
  std::uint64_t what = 0;    ///< hash of the name of what is going on
  std::uint64_t size = 0;    ///< bytes to come; of a failed rank, of its message
  std::uint64_t hash = 0;    ///< of what must be equal; of a failed rank, of its message
  std::uint64_t plain = 0;   ///< of a failed rank: Telling::kAsIfAlone
};

struct Comm::Failure {
  std::exception_ptr error;
  std::string message;
};

namespace {

using FailureKind = RankFailure::Kind;

std::uint64_t hash_of_text(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span<const T, 1>(&value, 1));
}

/// Adds the time until its end to a rank's.
class TalkTimer {
 public:
  explicit TalkTimer(RankUse& use) : use_(use) {}
  ~TalkTimer() {
    use_.seconds_talking += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  TalkTimer(const TalkTimer&) = delete;
  TalkTimer& operator=(const TalkTimer&) = delete;

 private:
  RankUse& use_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct Told {
  FailureKind kind = FailureKind::kOther;
  std::string message;
};

Told told_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const RankFailure& e) {
    return {e.kind, e.what()};
  } catch (const OptionError& e) {
    return {FailureKind::kOption, e.what()};
  } catch (const InputError& e) {
    return {FailureKind::kInput, e.what()};
  } catch (const MeshingError& e) {
    return {FailureKind::kMeshing, e.what()};
  } catch (const OutputError& e) {
    return {FailureKind::kOutput, e.what()};
  } catch (const Cancelled& e) {
    return {FailureKind::kCancelled, e.what()};
  } catch (const LimitError& e) {
    return {FailureKind::kMemory, e.what()};
  } catch (const std::bad_alloc&) {
    return {FailureKind::kMemory, "out of memory"};
  } catch (const std::exception& e) {
    return {FailureKind::kOther, e.what()};
  } catch (...) {
    return {FailureKind::kOther, "unknown error"};
  }
}

/// As a process alone would have thrown it.
[[noreturn]] void throw_as(FailureKind kind, const std::string& message) {
  switch (kind) {
    case FailureKind::kOption:
      throw OptionError(message);
    case FailureKind::kInput:
      throw InputError(message);
    case FailureKind::kMeshing:
      throw MeshingError(message);
    case FailureKind::kOutput:
      throw OutputError(message);
    case FailureKind::kCancelled:
      throw Cancelled();
    default:
      throw RankFailure(kind, message);
  }
}

}  // namespace

bool Comm::was_told() const {
  return ranks_->told_ && std::current_exception() == ranks_->told_;
}

std::vector<Comm::Word> Comm::round(const Word& mine, const Failure* failure) const {
  const auto count = static_cast<std::size_t>(size());
  std::vector<Word> words(count);
  const std::vector<std::size_t> sizes(count, sizeof(Word));
  {
    const TalkTimer timer(use());
    ranks_->gather(bytes_of(mine), sizes, reinterpret_cast<std::byte*>(words.data()));
  }
  ++use().messages;
  use().bytes_sent += sizeof(Word), use().bytes_taken += sizeof(Word) * (count - 1);
  if (std::ranges::any_of(words, [](const Word& w) { return w.failed != 0; })) spread(words, failure);
  for (std::size_t r = 1; r < count; ++r)
    if (words[r].what != words[0].what) {
      const std::string what = fmt::format(
          "rank {} of {} does other work than rank 0: they were given other arguments, run other versions or on unlike "
          "processors, or this is a bug of ours",
          r, count);
      const auto error = std::make_exception_ptr(RankFailure(FailureKind::kOther, what));
      ranks_->told_ = error;
      std::rethrow_exception(error);
    }
  return words;
}

void Comm::spread(const std::vector<Word>& words, const Failure* failure) const {
  std::vector<std::size_t> sizes(words.size(), 0);
  for (std::size_t r = 0; r < words.size(); ++r)
    if (words[r].failed != 0) sizes[r] = words[r].size;
  std::string all(std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}), '\0');
  const std::string_view mine = failure != nullptr ? std::string_view(failure->message) : std::string_view();
  ranks_->gather(std::as_bytes(std::span(mine)), sizes, reinterpret_cast<std::byte*>(all.data()));

  const auto is_failed = [](const Word& w) { return w.failed != 0; };
  const auto is_as_first = [&](const Word& w) { return w.failed == words[0].failed && w.hash == words[0].hash; };
  const auto raise = [&] {
    if (failure != nullptr && std::ranges::all_of(words, is_as_first)) std::rethrow_exception(failure->error);
    const auto first = static_cast<std::size_t>(std::ranges::find_if(words, is_failed) - words.begin());
    std::string message = all.substr(
        std::accumulate(sizes.begin(), sizes.begin() + static_cast<long>(first), std::size_t{0}), sizes[first]);
    const auto kind = static_cast<FailureKind>(words[first].failed);
    if (words[first].plain != 0 || kind == FailureKind::kCancelled) throw_as(kind, message);
    // The message begins with the stage.
    throw RankFailure(kind, fmt::format("rank {} of {}, {}", first, words.size(), message));
  };
  try {
    raise();
  } catch (...) {
    ranks_->told_ = std::current_exception();
    throw;
  }
  std::terminate();  // raise() throws
}

void Comm::fail(const std::exception_ptr& error, std::string_view stage, Telling telling) const {
  const Told told = told_of(error);
  const bool is_own =
      told.kind != FailureKind::kMemory && told.kind != FailureKind::kOther && told.kind != FailureKind::kCancelled;
  const bool plain = telling == Telling::kAsIfAlone && is_own;
  Failure failure{error, plain ? told.message : fmt::format("in stage \"{}\": {}", stage, told.message)};
  Word word;
  word.failed = static_cast<std::uint64_t>(told.kind);
  word.size = failure.message.size(), word.hash = hash_of_text(failure.message), word.plain = plain;
  round(word, &failure);
  std::terminate();  // round() throws where a rank has failed
}

Bytes Comm::room_for(std::size_t size, std::string_view what) const {
  Bytes room;
  std::exception_ptr error;
  try {
    room.resize(size);
  } catch (const std::bad_alloc&) {
    error = std::current_exception();
  }
  if (error) fail(error, what, Telling::kNamesRank);
  round({.what = hash_of_text(what) + 1}, nullptr);
  return room;
}

void Comm::agree(std::uint64_t hash, std::string_view what) const {
  if (alone()) return;
  const std::vector<Word> words = round({.what = hash_of_text(what), .hash = hash}, nullptr);
  for (std::size_t r = 1; r < words.size(); ++r)
    if (words[r].hash != words[0].hash) {
      const auto error = std::make_exception_ptr(
          RankFailure(FailureKind::kOther,
                      fmt::format("rank {} of {} has another {} than rank 0: the ranks were given other input or "
                                  "options, run other versions, or their machines compute differently",
                                  r, words.size(), what)));
      ranks_->told_ = error;
      std::rethrow_exception(error);
    }
}

Gathered Comm::gather(const Bytes& mine, std::string_view what) const {
  if (alone()) return {mine, {mine.size()}};
  const std::vector<Word> words = round({.what = hash_of_text(what), .size = mine.size()}, nullptr);
  std::vector<std::size_t> sizes(words.size());
  for (std::size_t r = 0; r < words.size(); ++r) sizes[r] = words[r].size;
  const std::size_t total = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
  Bytes all = room_for(total, what);
  const TalkTimer timer(use());
  ranks_->gather(mine, sizes, all.data());
  use().bytes_sent += mine.size(), use().bytes_taken += total - mine.size();
  return {std::move(all), std::move(sizes)};
}

Gathered Comm::exchange(std::vector<Bytes> out, std::string_view what) const {
  if (alone()) return {out[0], {out[0].size()}};
  const auto count = static_cast<std::size_t>(size());
  std::vector<std::size_t> out_sizes(count), in_sizes(count);
  Bytes sizes(count * sizeof(std::uint64_t));
  for (std::size_t r = 0; r < count; ++r) {
    const std::uint64_t bytes = out_sizes[r] = out[r].size();
    std::memcpy(sizes.data() + r * sizeof bytes, &bytes, sizeof bytes);
  }
  gather(sizes, what).for_each([&](int r, std::span<const std::byte> row) {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, row.data() + static_cast<std::size_t>(rank()) * sizeof bytes, sizeof bytes);
    in_sizes[static_cast<std::size_t>(r)] = bytes;
  });
  const std::size_t sent = std::accumulate(out_sizes.begin(), out_sizes.end(), std::size_t{0});
  const std::size_t taken = std::accumulate(in_sizes.begin(), in_sizes.end(), std::size_t{0});
  Bytes all_out = room_for(sent, what), all_in = room_for(taken, what);
  std::size_t at = 0;
  for (Bytes& part : out) {
    std::copy(part.begin(), part.end(), all_out.begin() + static_cast<std::ptrdiff_t>(at));
    at += part.size();
    part = Bytes();
  }
  const TalkTimer timer(use());
  ranks_->exchange(all_out.data(), out_sizes, all_in.data(), in_sizes);
  use().bytes_sent += sent, use().bytes_taken += taken;
  return {std::move(all_in), std::move(in_sizes)};
}

namespace {

/// fold(sum, number) of each rank's numbers, in the order of ranks.
template <class T, class Fold>
void fold_numbers(const Gathered& all, std::span<T> numbers, const Fold& fold) {
  all.for_each([&](int rank, std::span<const std::byte> bytes) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      T number;
      std::memcpy(&number, bytes.data() + i * sizeof(T), sizeof(T));
      numbers[i] = rank == 0 ? number : fold(numbers[i], number);
    }
  });
}

template <class T>
Bytes packed_numbers(std::span<T> numbers) {
  const auto bytes = std::as_bytes(numbers);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

void Comm::sum(std::span<std::int64_t> numbers, std::string_view what) const {
  if (!alone()) fold_numbers(gather(packed_numbers(numbers), what), numbers, std::plus<>());
}

void Comm::least(std::span<double> numbers, std::string_view what) const {
  if (!alone())
    fold_numbers(gather(packed_numbers(numbers), what), numbers, [](double a, double b) { return std::min(a, b); });
}

std::int64_t Comm::before(std::int64_t mine, std::string_view what) const {
  std::int64_t sum = 0;
  if (alone()) return sum;
  gather(packed_numbers(std::span(&mine, 1)), what).for_each([&](int r, std::span<const std::byte> bytes) {
    std::int64_t number = 0;
    std::memcpy(&number, bytes.data(), sizeof number);
    if (r < rank()) sum += number;
  });
  return sum;
}

void together(Ranks* ranks, std::string_view stage, const std::function<void()>& work) {
  Comm(ranks).together(stage, Comm::Telling::kNamesRank, work);
}

void agree(Ranks* ranks, std::uint64_t hash, std::string_view what) {
  Comm(ranks).agree(hash, what);
}

}  // namespace octafront
