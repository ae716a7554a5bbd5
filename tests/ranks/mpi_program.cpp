// What mpirun_test.py starts several times: a program of a user's, with MPI.
//   mpi_program messages              long messages in parts arrive as short ones do
//   mpi_program kill STAGE RANK IN OUT    meshes IN; RANK is killed as STAGE begins
#include <octafront/mpi.h>
#include <octafront/octafront.h>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace octafront;

std::vector<std::byte> message(int from, int to) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(1000 * from + 77 * to));
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::byte>(i * 31 + static_cast<std::size_t>(from));
  return bytes;
}

/// All that the other ranks send: of one rank to all, then of each to each.
std::vector<std::byte> talk(MpiRanks& ranks) {
  std::vector<std::size_t> sizes, out_sizes, in_sizes;
  std::vector<std::byte> out;
  std::size_t all = 0, in = 0;
  for (int r = 0; r < ranks.size(); ++r) {
    const std::vector<std::byte> to = message(ranks.rank(), r);
    out.insert(out.end(), to.begin(), to.end());
    out_sizes.push_back(to.size());
    in += in_sizes.emplace_back(message(r, ranks.rank()).size());
    all += sizes.emplace_back(message(r, 0).size());
  }
  std::vector<std::byte> got(all + in);
  ranks.gather(message(ranks.rank(), 0), sizes, got.data());
  ranks.exchange(out.data(), out_sizes, got.data() + all, in_sizes);
  return got;
}

int try_messages() {
  MpiRanks whole(MPI_COMM_WORLD), parts(MPI_COMM_WORLD, 640);
  std::vector<std::byte> expected;
  for (const bool to_all : {true, false})
    for (int r = 0; r < whole.size(); ++r) {
      const std::vector<std::byte> from = message(r, to_all ? 0 : whole.rank());
      expected.insert(expected.end(), from.begin(), from.end());
    }
  return talk(whole) == expected && talk(parts) == expected ? 0 : 1;
}

int mesh_and_kill(const std::string& stage, int rank, const std::string& in, const std::string& out) {
  MpiRanks ranks(MPI_COMM_WORLD);
  RunContext context;
  context.ranks = &ranks;
  context.threads = 1;
  context.progress = [&](std::string_view now, double) {
    if (ranks.rank() == 0) std::cout << now << std::endl;
    if (now == stage && ranks.rank() == rank) std::raise(SIGKILL);
  };
  Options options;
  options.size.elements = 20'000;
  const Result result = generate(open_domain(in), options, context);
  together(&ranks, "writing", [&] {
    context.report("writing", -1);
    if (ranks.rank() == 0) write_mesh(out, result.mesh, context);
  });
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(nullptr, nullptr);
  const std::vector<std::string> words(argv + 1, argv + argc);
  const int status =
      words.size() == 5 ? mesh_and_kill(words[1], std::atoi(words[2].c_str()), words[3], words[4]) : try_messages();
  MPI_Finalize();
  return status;
}
