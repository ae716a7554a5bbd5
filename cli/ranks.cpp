#include "ranks.h"

#include <octafront/error.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <thread>
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

/// What each rank tells the first at the end.
struct Taken {
  std::uint64_t peak_memory = 0, messages = 0, bytes_sent = 0, bytes_taken = 0;
  double seconds_talking = 0, seconds_shared = 0;
};

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
  a.json.clear(), a.page.clear(), a.defects.clear();
}

void tell_ranks(Session& session, const Report& report) {
  Ranks* const ranks = session.context().ranks;
  if (ranks == nullptr) return;
  const RankUse& use = ranks->use;
  const Taken mine{report.peak_memory_bytes, use.messages,        use.bytes_sent,
                   use.bytes_taken,          use.seconds_talking, use.seconds_shared};
  std::vector<Taken> all(static_cast<std::size_t>(ranks->size()));
  ranks->gather(std::as_bytes(std::span(&mine, 1)), std::vector<std::size_t>(all.size(), sizeof(Taken)),
                reinterpret_cast<std::byte*>(all.data()));
  Json rows = Json::array();
  for (const Taken& t : all)
    rows.push_back({{"peak_memory_bytes", t.peak_memory},
                    {"rounds_of_talk", t.messages},
                    {"bytes_sent", t.bytes_sent},
                    {"bytes_taken", t.bytes_taken},
                    {"talking_seconds", t.seconds_talking},
                    {"shared_seconds", t.seconds_shared}});
  session.found({{"ranks", rows}});
  const auto [least, most] = std::ranges::minmax(all, {}, &Taken::peak_memory);
  session.say(fmt::format("{} ranks: peak memory {:.2f} to {:.2f} GB each\n", all.size(),
                          1e-9 * static_cast<double>(least.peak_memory), 1e-9 * static_cast<double>(most.peak_memory)));
}

}  // namespace octafront::cli
