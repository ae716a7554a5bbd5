#include "ranks.h"

#include <octafront/error.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <unistd.h>

namespace octafront::cli {

namespace {

/// -1 if there is no such variable, or no number in it.
int number_in(const char* variable) {
  const char* const text = std::getenv(variable);
  int number = -1;
  return text != nullptr && CLI::detail::lexical_cast(std::string(text), number) ? number : -1;
}

/// The machine's threads, shared among the ranks on it; where each is bound to some, these are its own.
int threads_of_rank(int ranks_here) {
  const int allowed = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
#ifdef _WIN32
  const long machine = allowed;
#else
  const long machine = sysconf(_SC_NPROCESSORS_ONLN);
#endif
  return allowed < machine ? allowed : std::max(1, allowed / ranks_here);
}

/// What each rank tells the first at the end: of the run, and of each stage.
struct Taken {
  std::uint64_t peak_memory = 0;
  double messages = 0, bytes_sent = 0, bytes_taken = 0, seconds_talking = 0, seconds_shared = 0;
};

double counter(const StageReport& stage, std::string_view key) {
  const auto found = std::ranges::find(stage.counters, key, &std::pair<std::string, double>::first);
  return found == stage.counters.end() ? 0 : found->second;
}

Taken taken_by(const StageReport& stage) {
  return {0,
          counter(stage, "rounds of talk"),
          counter(stage, "bytes sent"),
          counter(stage, "bytes taken"),
          counter(stage, "talking seconds"),
          counter(stage, "shared seconds")};
}

Json as_json(const Taken& t) {
  return {{"rounds_of_talk", t.messages},
          {"bytes_sent", t.bytes_sent},
          {"bytes_taken", t.bytes_taken},
          {"talking_seconds", t.seconds_talking},
          {"shared_seconds", t.seconds_shared}};
}

/// The rows of all ranks, one rank's behind the other's.
std::vector<Taken> gathered(Ranks& ranks, const std::vector<Taken>& mine) {
  const auto count = static_cast<std::size_t>(ranks.size());
  std::vector<Taken> all(count * mine.size());
  ranks.gather(std::as_bytes(std::span(mine)), std::vector<std::size_t>(count, mine.size() * sizeof(Taken)),
               reinterpret_cast<std::byte*>(all.data()));
  return all;
}

}  // namespace

Launch launch_of_environment() {
  // Open MPI; MPICH, Intel's and others by Hydra; srun, which sets the last of these in the steps that it starts only.
  constexpr std::array<std::array<const char*, 2>, 2> kNames{
      {{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, {"PMI_RANK", "PMI_SIZE"}}};
  for (const auto& [rank, size] : kNames)
    if (number_in(rank) >= 0 && number_in(size) > 0) return {number_in(rank), number_in(size)};
  if (number_in("SLURM_STEP_NUM_TASKS") > 1 && number_in("SLURM_PROCID") >= 0 && number_in("SLURM_LOCALID") >= 0)
    return {number_in("SLURM_PROCID"), number_in("SLURM_STEP_NUM_TASKS")};
  return {};
}

bool shares_work(const Arguments& arguments) {
  return arguments.command == "mesh" && !arguments.dry_run;
}

void adapt_to_ranks(Arguments& a, const Launch& launch, int ranks_here) {
  for (const std::filesystem::path& body : a.bodies)
    if (body == "/dev/stdin") throw OptionError("of several ranks only one gets standard input: give a file as input");
  if (a.threads == 0) a.threads = threads_of_rank(ranks_here);
  if (launch.is_first()) return;
  a.quiet = true;
  a.json.clear(), a.defects.clear();
}

void tell_ranks(Session& session, const Report& report) {
  Ranks* const ranks = session.context().ranks;
  if (ranks == nullptr) return;
  const RankUse& use = ranks->use;
  std::vector<Taken> mine{{report.peak_memory_bytes, static_cast<double>(use.messages),
                           static_cast<double>(use.bytes_sent), static_cast<double>(use.bytes_taken),
                           use.seconds_talking, use.seconds_shared}};
  for (const StageReport& stage : report.stages) mine.push_back(taken_by(stage));
  const std::vector<Taken> all = gathered(*ranks, mine);
  Json rows = Json::array();
  std::uint64_t least = mine[0].peak_memory, most = 0;
  for (std::size_t first = 0; first < all.size(); first += mine.size()) {
    Json row{{"peak_memory_bytes", all[first].peak_memory}};
    row.update(as_json(all[first]));
    for (std::size_t s = 0; s < report.stages.size(); ++s)
      row["stages"].push_back(as_json(all[first + 1 + s])), row["stages"].back()["name"] = report.stages[s].name;
    least = std::min(least, all[first].peak_memory), most = std::max(most, all[first].peak_memory);
    rows.push_back(row);
  }
  session.found({{"ranks", rows}});
  session.say(fmt::format("{} ranks: peak memory {:.2f} to {:.2f} GB each\n", ranks->size(),
                          1e-9 * static_cast<double>(least), 1e-9 * static_cast<double>(most)));
}

}  // namespace octafront::cli
