#include "command_line.h"

#include "failure.h"
#include "program.h"
#include "ranks.h"
#include "rehearsal.h"
#include "session.h"
#include "terminal.h"
#include "text.h"

#include <cstdio>
#include <memory>

#include <fmt/core.h>

namespace {

using namespace octafront;
using namespace octafront::cli;

/// Of several ranks, which fail alike, the first speaks for all.
bool speaks = true;

int fail(Status status, const std::string& message) {
  if (!speaks) return status;
  clear_progress();
  fmt::print(stderr, "octafront: {}\n", printable(message));
  return status;
}

/// A buffer that the disk or pipe did not take is found out now or never.
int finished(int status) {
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  return written || status != kDone ? status : fail(kNotWritten, "standard output cannot be written");
}

int fail_with_json(const Session& session, const Failure& failure) {
  const std::string message = session.arguments().names.translated(failure.message);
  const int status = fail(failure.status, message);
  try {
    session.write_json({{"kind", failure.kind}, {"message", message}});
  } catch (const std::exception& error) {
    fail(kNotWritten, error.what());
  }
  return status;
}

int run_session(const Program& program, const Arguments& arguments, Ranks* ranks) {
  Session session(arguments, ranks);
  try {
    together(ranks, arguments.command, [&] {
      if (ranks == nullptr) rehearse_reading(arguments);
      program.chosen()(session);
      session.write_json(nullptr);
    });
    return finished(kDone);
  } catch (const std::exception&) {
    return fail_with_json(session, current_failure());
  }
}

int run(Program& program, int argc, char** argv, const Launch& launch) {
  std::unique_ptr<MpiSession> mpi;
  try {
    Arguments& arguments = program.arguments(argc, argv);
    if (launch.size > 1 && !shares_work(arguments) && !launch.is_first()) return kDone;
    if (launch.size > 1 && shares_work(arguments)) {
      mpi = start_mpi(launch);
      adapt_to_ranks(arguments, launch, mpi->ranks_here());
    }
    Ranks* const ranks = mpi ? &mpi->ranks() : nullptr;
    together(ranks, "start", [&] {
      if (launch.is_first()) check_files(arguments);
    });
    return run_session(program, arguments, ranks);
  } catch (const std::exception&) {
    const Failure failure = current_failure();
    return fail(failure.status, failure.message);
  }
}

int refuse_usage(const CLI::App& app, const CLI::ParseError& error) {
  const auto chosen = app.get_subcommands();
  const std::string command = chosen.empty() ? "" : chosen.front()->get_name() + " ";
  return fail(kUsage, fmt::format("{}\nMore: octafront {}--help", usage_error(app, error), command));
}

/// An empty value is a variable of a script that was not set: never what was meant.
bool has_empty_argument(int argc, char** argv, std::string& before) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    before = argument.empty() ? argv[i - 1] : argument;
    if (argument.empty() || (argument.starts_with("--") && argument.ends_with('='))) return true;
  }
  return false;
}

}  // namespace

int octafront_command_line(int argc, char** argv) {
  prepare_process();
  const Launch launch = launch_of_environment();
  speaks = launch.is_first();
  Program program;
  CLI::App& app = program.app();
  std::string before;
  if (has_empty_argument(argc, argv, before))
    return fail(kUsage, fmt::format("there is an empty value behind {}: give one, or leave it out", before));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) return refuse_usage(app, e);
    return launch.is_first() ? finished(app.exit(e)) : kDone;
  }
  return run(program, argc, argv, launch);
}
