#include "command_line.h"

#include <octafront/io.h>

#include "failure.h"
#include "program.h"
#include "ranks.h"
#include "rehearsal.h"
#include "session.h"
#include "terminal.h"
#include "text.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace {

using namespace octafront;
using namespace octafront::cli;

/// Of several ranks, which fail alike, the first speaks for all.
bool speaks = true;

int fail(const Failure& failure, const std::vector<std::string>& words) {
  if (!speaks) return failure.status;
  clear_progress();
  fmt::print(stderr, "octafront: {}\n", printable(failure.message, words));
  return failure.status;
}

/// A buffer that the disk or pipe did not take is found out now or never.
int finished(int status) {
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  return written || status != kDone ? status : fail({kNotWritten, "output", "standard output cannot be written"}, {});
}

int fail_with_json(const Session& session, Failure failure) {
  const std::vector<std::string>& words = session.arguments().words_with_line_ends;
  failure.message = session.arguments().names.translated(failure.message);
  const int status = fail(failure, words);
  try {
    session.write_json(json_of(failure));
  } catch (const std::exception& error) {
    fail({kNotWritten, "output", error.what()}, words);
  }
  return status;
}

/// The file behind --json, of a command line that may not have been understood; empty: none.
std::filesystem::path json_target(int argc, char** argv) {
  std::filesystem::path target;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("--json=")) target = word.substr(std::string("--json=").size());
    if (word == "--json" && i + 1 < argc) target = argv[i + 1];
  }
  return target;
}

/// Whether it is sure that a file of the user is not lost, whatever the command line means.
bool is_harmless(const std::filesystem::path& target, int argc, char** argv) {
  if (target == kStandardOutput) return true;
  std::error_code error;
  if (std::filesystem::exists(target, error) && target.extension() != ".json") return false;
  int named = 0;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    named += same_file(word.substr(word.starts_with("--") ? word.find('=') + 1 : 0), target.string());
  }
  return named == 1;
}

/// Of a run that did not come to begin.
int fail_early(const std::string& command, int argc, char** argv, const Failure& failure) {
  const std::vector<std::string> words = words_with_line_ends(argc, argv);
  fail(failure, words);
  const std::filesystem::path target = json_target(argc, argv);
  if (target.empty() || !speaks || !is_harmless(target, argc, argv)) return failure.status;
  Json json = json_head(command, command_line_of(argc, argv));
  json["status"] = static_cast<int>(failure.status);
  json["error"] = json_of(failure);
  try {
    write_json_to(target, json);
  } catch (const std::exception& error) {
    fail({kNotWritten, "output", error.what()}, words);
  }
  return failure.status;
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

std::string name_of_command(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? "" : chosen.front()->get_name();
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
    return fail_early(name_of_command(program.app()), argc, argv, current_failure());
  }
}

int refuse_usage(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  const std::string command = name_of_command(app);
  Failure failure = usage_error(app, error);
  failure.message += fmt::format("\nMore: octafront {}--help", command.empty() ? "" : command + " ");
  return fail_early(command, argc, argv, failure);
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
    return fail_early(
        "", argc, argv,
        {kUsage, "usage", fmt::format("there is an empty value behind {}: give one, or leave it out", before)});
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) return refuse_usage(app, e, argc, argv);
    return launch.is_first() ? finished(app.exit(e)) : kDone;
  }
  return run(program, argc, argv, launch);
}
