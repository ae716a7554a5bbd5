#include "base/shared/comm.h"

#include "base/shared/shares.h"
#include "base/shared/virtual_ranks.h"

#include <cmath>
#include <mutex>
#include <new>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

constexpr int kCounts[] = {1, 2, 3, 5, 8};

/// What each rank threw, in words.
std::vector<std::string> errors_of(int count, const std::function<void(Ranks&)>& work) {
  std::vector<std::string> errors(static_cast<std::size_t>(count));
  run_virtual_ranks(count, [&](Ranks& ranks) {
    std::string& mine = errors[static_cast<std::size_t>(ranks.rank())];
    try {
      work(ranks);
      mine = "nothing";
    } catch (const RankFailure& e) {
      mine = "failure " + std::to_string(static_cast<int>(e.kind)) + ": " + e.what();
    } catch (const MeshingError& e) {
      mine = std::string("meshing: ") + e.what();
    } catch (const Cancelled&) {
      mine = "cancelled";
    }
  });
  return errors;
}

std::vector<Bytes> by_rank(const Gathered& all) {
  std::vector<Bytes> list;
  all.for_each([&](int, std::span<const std::byte> bytes) { list.emplace_back(bytes.begin(), bytes.end()); });
  return list;
}

TEST(Comm, AddsUpAndFindsTheLeast) {
  for (const int n : kCounts)
    run_virtual_ranks(n, [n](Ranks& ranks) {
      const Comm comm(&ranks);
      std::vector<std::int64_t> numbers{ranks.rank(), 1, std::int64_t{1} << 40};
      comm.sum(numbers, "numbers");
      EXPECT_EQ(numbers, (std::vector<std::int64_t>{n * (n - 1) / 2, n, n * (std::int64_t{1} << 40)}));
      std::vector<double> least{1.0 + ranks.rank(), -1.0 * ranks.rank()};
      comm.least(least, "least");
      EXPECT_EQ(least, (std::vector<double>{1.0, 1.0 - n}));
      EXPECT_EQ(comm.before(ranks.rank() + 1, "before"), ranks.rank() * (ranks.rank() + 1) / 2);
    });
}

TEST(Comm, AloneItIsWhatItWas) {
  const Comm comm(nullptr);
  std::vector<std::int64_t> numbers{7};
  comm.sum(numbers, "numbers");
  EXPECT_EQ(numbers[0], 7);
  EXPECT_EQ(comm.before(5, "before"), 0);
  EXPECT_EQ(by_rank(comm.exchange({Bytes(3)}, "bytes")), std::vector<Bytes>{Bytes(3)});
  comm.agree(1, "one");
  EXPECT_THROW(comm.together("a stage", Comm::Telling::kNamesRank, [] { throw MeshingError("x"); }), MeshingError);
}

Bytes text_from(int from, int to) {
  const std::string text(static_cast<std::size_t>(from * 7 + to), static_cast<char>('a' + from));
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

TEST(Comm, GathersAndExchangesInTheOrderOfRanks) {
  for (const int n : kCounts)
    run_virtual_ranks(n, [n](Ranks& ranks) {
      const Comm comm(&ranks);
      const int self = ranks.rank();
      int seen = 0;
      comm.gather(text_from(self, 0), "texts").for_each([&](int r, std::span<const std::byte> bytes) {
        EXPECT_EQ(r, seen++);
        EXPECT_EQ(Bytes(bytes.begin(), bytes.end()), text_from(r, 0));
      });
      EXPECT_EQ(seen, n);
      std::vector<Bytes> out, expected;
      for (int r = 0; r < n; ++r) out.push_back(text_from(self, r)), expected.push_back(text_from(r, self));
      EXPECT_EQ(by_rank(comm.exchange(out, "texts")), expected);
    });
}

TEST(Comm, FindsOutWhoDisagrees) {
  const auto errors = errors_of(4, [](Ranks& ranks) { agree(&ranks, ranks.rank() == 2 ? 1 : 0, "size field"); });
  for (const std::string& e : errors) {
    EXPECT_EQ(e, errors[0]);
    EXPECT_NE(e.find("rank 2 of 4 has another size field"), std::string::npos) << e;
  }
}

TEST(Comm, FindsOutWhoDoesOtherWork) {
  const auto errors = errors_of(3, [](Ranks& ranks) { agree(&ranks, 0, ranks.rank() == 1 ? "this" : "that"); });
  for (const std::string& e : errors) EXPECT_NE(e.find("rank 1 of 3 does other work"), std::string::npos) << e;
}

TEST(Comm, AllThrowWhatOneHasMet) {
  const auto fails_on = [](int rank, const auto& raise) {
    return errors_of(5, [&](Ranks& ranks) {
      const Comm comm(&ranks);
      comm.attempt("improve", Comm::Telling::kNamesRank, [&] {
        if (ranks.rank() == rank) raise();
      });
      std::int64_t one = 1;
      comm.sum(std::span(&one, 1), "ones");
    });
  };
  for (const int rank : {0, 3, 4}) {
    const std::string where = "rank " + std::to_string(rank) + " of 5, in stage \"improve\": ";
    for (const std::string& e : fails_on(rank, [] { throw std::bad_alloc(); }))
      EXPECT_EQ(e, "failure 6: " + where + "out of memory");
    for (const std::string& e : fails_on(rank, [] { throw MeshingError("no mesh"); }))
      EXPECT_EQ(e, "failure 3: " + where + "no mesh");
    for (const std::string& e : fails_on(rank, [] { throw Cancelled(); })) EXPECT_EQ(e, "cancelled");
  }
}

TEST(Comm, WhatAllMeetAlikeStaysWhatItIs) {
  const auto errors =
      errors_of(3, [](Ranks& ranks) { together(&ranks, "input", [] { throw MeshingError("all of us"); }); });
  for (const std::string& e : errors) EXPECT_EQ(e, "meshing: all of us");
}

TEST(Comm, ErrorsOfJobsAreThoseOfAProcessAlone) {
  const auto errors = errors_of(3, [](Ranks& ranks) {
    const Comm comm(&ranks);
    const Shares shares(std::vector<std::uint64_t>(30, 1), 3);
    do_share(comm, shares, "jobs", [](std::size_t i) {
      if (i == 29) throw MeshingError("job 29");
    });
    agree(&ranks, 0, "jobs");
  });
  for (const std::string& e : errors) EXPECT_EQ(e, "meshing: job 29");
}

TEST(Comm, GoesOnAfterAFailureThatWasMended) {
  run_virtual_ranks(3, [](Ranks& ranks) {
    const Comm comm(&ranks);
    for (int k = 0; k < 3; ++k) {
      EXPECT_THROW(comm.together("try", Comm::Telling::kAsIfAlone,
                                 [&] {
                                   if (ranks.rank() == k) throw MeshingError("not so");
                                 }),
                   MeshingError);
      std::int64_t one = 1;
      comm.sum(std::span(&one, 1), "ones");
      EXPECT_EQ(one, 3);
    }
  });
}

TEST(Comm, MemoryThatIsNotThereIsTold) {
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "sanitizers end the program instead";
#endif
  // What is asked for is more than any machine has; the others have their part.
  const auto errors = errors_of(3, [](Ranks& ranks) {
    const Comm comm(&ranks);
    comm.attempt("huge", Comm::Telling::kNamesRank, [&] {
      if (ranks.rank() == 1) Bytes(std::size_t{1} << 60);
    });
    comm.gather(Bytes(100), "list");
  });
  for (const std::string& e : errors) EXPECT_EQ(e, "failure 6: rank 1 of 3, in stage \"huge\": out of memory");
}

TEST(Comm, ARankThatEndsEndsTheOthers) {
  EXPECT_THROW(run_virtual_ranks(3,
                                 [](Ranks& ranks) {
                                   if (ranks.rank() == 1) return;
                                   agree(&ranks, 0, "this");
                                 }),
               RankFailure);
}

TEST(Shares, AreStretchesOfAboutTheSameWork) {
  for (const std::size_t jobs : {0, 1, 2, 7, 100})
    for (const int ranks : {1, 2, 3, 8}) {
      std::vector<std::uint64_t> work(jobs);
      for (std::size_t i = 0; i < jobs; ++i) work[i] = 1 + i % 5;
      const Shares shares(work, ranks);
      const std::uint64_t all = std::accumulate(work.begin(), work.end(), std::uint64_t{0});
      EXPECT_EQ(shares.begin(0), 0u);
      EXPECT_EQ(shares.end(ranks - 1), jobs);
      for (int r = 0; r < ranks; ++r) {
        EXPECT_EQ(shares.begin(r), r == 0 ? 0 : shares.end(r - 1));
        ASSERT_LE(shares.begin(r), shares.end(r));
        std::uint64_t own = 0;
        for (std::size_t i = shares.begin(r); i < shares.end(r); ++i) own += work[i];
        EXPECT_LE(static_cast<double>(own), static_cast<double>(all) / ranks + 5);
      }
    }
}

TEST(Shares, GiveEveryRankAllResults) {
  for (const int n : kCounts)
    run_virtual_ranks(n, [n](Ranks& ranks) {
      const Comm comm(&ranks);
      const Shares shares(std::vector<std::uint64_t>(17, 1), n);
      std::vector<std::vector<std::uint32_t>> results(17);
      do_share(comm, shares, "squares",
               [&](std::size_t i) { results[i].assign(i, static_cast<std::uint32_t>(i * i)); });
      gather_results(
          comm, shares, "squares", results, [](const auto& r, Packer& to) { to.add(r); },
          [](auto& r, Unpacker& from) { from.take(r); });
      for (std::uint32_t i = 0; i < 17; ++i) EXPECT_EQ(results[i], std::vector<std::uint32_t>(i, i * i));
    });
}

}  // namespace
}  // namespace octafront
