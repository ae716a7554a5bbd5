// Processes that make one mesh together, by the C interface: virtual ranks stand for them and for their MPI.

#include <octafront/octafront_c.h>

#include "base/shared/virtual_ranks.h"
#include "doors/c_api/job_ranks.h"
#include "support/named_surfaces.h"

#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace octafront {
namespace {

/// What octafront_mpi_talk() does with MPI.
bool talk(const octafront_event& event, Ranks& ranks) {
  const auto count = static_cast<std::size_t>(ranks.size());
  const auto* const out = static_cast<const std::byte*>(event.out);
  const std::span in_sizes(event.in_sizes, count);
  if (event.kind == OCTAFRONT_EVENT_GATHER) {
    const std::size_t mine = in_sizes[static_cast<std::size_t>(ranks.rank())];
    ranks.gather({out, mine}, in_sizes, static_cast<std::byte*>(event.in));
    return true;
  }
  if (event.kind != OCTAFRONT_EVENT_EXCHANGE) return false;
  ranks.exchange(out, std::span(event.out_sizes, count), static_cast<std::byte*>(event.in), in_sizes);
  return true;
}

/// What became of a job; `cancel_at`: a stage in which it is cancelled.
struct Ending {
  int status = -1;
  std::string message;
  std::vector<std::uint32_t> tets;
};

Ending ending_of(octafront_job* job, Ranks& ranks, const std::string& cancel_at) {
  octafront_event event;
  while (octafront_job_wait(job, -1, &event) != OCTAFRONT_EVENT_END) {
    if (talk(event, ranks)) octafront_job_answer(job);
    if (event.kind == OCTAFRONT_EVENT_PROGRESS && cancel_at == event.text) octafront_job_cancel(job);
  }
  Ending end{octafront_job_status(job), octafront_job_message(job), {}};
  if (octafront_mesh* const mesh = octafront_job_take_mesh(job)) {
    octafront_array tets{};
    EXPECT_EQ(octafront_mesh_array(mesh, "tets", &tets), 0);
    const auto* const first = static_cast<const std::uint32_t*>(tets.data);
    end.tets.assign(first, first + 4 * tets.rows);
    octafront_mesh_free(mesh);
  }
  octafront_job_free(job);
  return end;
}

octafront_options* rank_options(const Ranks& ranks, const char* json) {
  octafront_options* const options = octafront_options_new();
  EXPECT_EQ(octafront_options_set(options, json), 0);
  EXPECT_EQ(octafront_options_ranks(options, ranks.rank(), ranks.size()), 0);
  return options;
}

/// generate() of a torus on one of the ranks.
Ending made_by(Ranks& ranks, const char* json, const std::string& cancel_at = "") {
  const SurfaceMesh torus = testing::torus(40, 20);
  octafront_surface* const surface = octafront_surface_new();
  octafront_surface_set_array(surface, "points", torus.points.data(), torus.points.size());
  octafront_surface_set_array(surface, "triangles", torus.triangles.data(), torus.triangles.size());
  octafront_options* const options = rank_options(ranks, json);
  Ending end = ending_of(octafront_generate(surface, options, 1), ranks, cancel_at);
  octafront_options_free(options);
  octafront_surface_free(surface);
  return end;
}

constexpr const char* kFine = R"({"size": 0.15})";

std::vector<std::uint32_t> made_alone() {
  Ending end;
  run_virtual_ranks(1, [&](Ranks& alone) { end = made_by(alone, kFine); });
  EXPECT_EQ(end.status, OCTAFRONT_DONE) << end.message;
  return end.tets;
}

TEST(CApiRanks, MakeTheMeshOfAProcessAlone) {
  const std::vector<std::uint32_t> alone = made_alone();
  EXPECT_GT(alone.size(), 4'000u);
  for (const int count : {2, 3})
    run_virtual_ranks(count, [&](Ranks& ranks) {
      const Ending end = made_by(ranks, kFine);
      EXPECT_EQ(end.status, OCTAFRONT_DONE) << end.message;
      EXPECT_EQ(end.tets, alone) << "rank " << ranks.rank() << " of " << count;
    });
}

TEST(CApiRanks, OneThatIsCancelledEndsAll) {
  run_virtual_ranks(3, [&](Ranks& ranks) {
    const Ending end = made_by(ranks, kFine, ranks.rank() == 1 ? "volume front" : "");
    EXPECT_EQ(end.status, OCTAFRONT_CANCELLED) << end.message;
    EXPECT_TRUE(end.tets.empty());
  });
}

TEST(CApiRanks, WhatOneRankIsRefusedIsRefusedToAll) {
  run_virtual_ranks(3, [&](Ranks& ranks) {
    const Ending end = made_by(ranks, ranks.rank() == 2 ? R"({"size": 0.1, "min_size": 2, "max_size": 1})" : kFine);
    EXPECT_EQ(end.status, OCTAFRONT_USAGE) << end.message;
    EXPECT_EQ(end.message.rfind("rank 2 of 3, ", 0), 0u) << end.message;
  });
}

TEST(CApiRanks, AFileThatOneRankDoesNotHaveEndsAll) {
  run_virtual_ranks(2, [&](Ranks& ranks) {
    octafront_options* const options = rank_options(ranks, "{}");
    const char* const file = ranks.rank() == 1 ? "/missing/part.stl" : OCTAFRONT_SAMPLES "/bracket.stl";
    const Ending end = ending_of(octafront_open_files(&file, 1, "{}", options, 1), ranks, "");
    EXPECT_EQ(end.status, OCTAFRONT_INPUT);
    EXPECT_NE(end.message.find("/missing/part.stl"), std::string::npos) << end.message;
    octafront_options_free(options);
  });
}

TEST(CApiRanks, AJobThatIsFreedWaitsForNoOther) {
  run_virtual_ranks(1, [](Ranks&) {
    octafront_options* const options = octafront_options_new();
    EXPECT_NE(octafront_options_ranks(options, 2, 2), 0);
    EXPECT_NE(octafront_options_ranks(options, -1, 2), 0);
    EXPECT_EQ(octafront_options_ranks(options, 0, 2), 0);
    const char* const file = OCTAFRONT_SAMPLES "/bracket.stl";
    octafront_job* const job = octafront_open_files(&file, 1, "{}", options, 1);
    octafront_event event;
    while (octafront_job_wait(job, -1, &event) != OCTAFRONT_EVENT_GATHER) {
    }
    octafront_job_free(job);
    octafront_options_free(options);
  });
}

/// Bytes that tell from whom they come, to whom they go, and their place.
std::vector<std::byte> letter(int from, int to) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(100 * from + 37 * to));
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::byte>(31 * i + static_cast<std::size_t>(7 * from + to));
  return bytes;
}

void append(std::vector<std::byte>& all, const std::vector<std::byte>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

TEST(CApiRanks, LongTalkGoesInParts) {
  constexpr int kCount = 4;
  for (const std::size_t most : {2UL, 33UL, 150UL, 1'000'000UL})
    run_virtual_ranks(kCount, [&](Ranks& by) {
      std::size_t longest = 0;
      c_api::JobRanks ranks(
          by.rank(), by.size(),
          [&](const octafront_event& event) {
            const std::span sizes(event.in_sizes, kCount);
            longest = std::max(longest, std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}));
            EXPECT_TRUE(talk(event, by));
          },
          most);
      std::vector<std::byte> out, in, all;
      std::vector<std::size_t> out_sizes, in_sizes, all_sizes;
      for (int r = 0; r < kCount; ++r) {
        append(out, letter(by.rank(), r)), out_sizes.push_back(letter(by.rank(), r).size());
        append(in, letter(r, by.rank())), in_sizes.push_back(letter(r, by.rank()).size());
        append(all, letter(r, 9)), all_sizes.push_back(letter(r, 9).size());
      }
      std::vector<std::byte> got_in(in.size()), got_all(all.size());
      ranks.gather(letter(by.rank(), 9), all_sizes, got_all.data());
      EXPECT_EQ(got_all, all);
      EXPECT_LE(longest, most);
      ranks.exchange(out.data(), out_sizes, got_in.data(), in_sizes);
      EXPECT_EQ(got_in, in);
    });
}

}  // namespace
}  // namespace octafront
