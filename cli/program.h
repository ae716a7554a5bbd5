#pragma once

#include "arguments.h"
#include "mcp_tools.h"
#include "session.h"
#include "workbench.h"

#include <functional>

namespace octafront::cli {

/// The commands and options of the program: the one table that parsing, help, man page, completions and schema come
/// from.
class Program {
 public:
  Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  CLI::App& app() { return app_; }
  /// What a command line that was parsed asked for; its limits hold from then on. Throws OptionError for lengths whose
  /// unit means nothing.
  Arguments& arguments(int argc, char** argv);
  const std::function<void(Session&)>& chosen() const { return chosen_; }

 private:
  CLI::App* add(const std::string& name, const std::string& help, const std::string& examples,
                std::function<void(Session&)> run);
  void declare_commands();
  void declare_helpers();
  void declare_server();
  void declare_workbench();
  void help(Session& session) const;
  void serve();

  CLI::App app_{"Octafront: tetrahedral meshes from closed surfaces", "octafront"};
  Arguments arguments_;
  std::string topic_, group_, shell_;
  bool wants_manual_ = false, speaks_mcp_ = false, is_without_browser_ = false;
  std::vector<std::filesystem::path> folders_;
  ToolLimits server_limits_;
  WorkbenchSetting workbench_;
  std::function<void(Session&)> chosen_;
};

/// What is wrong with a command line, in words, with the word that may have been meant.
Failure usage_error(const CLI::App& app, const CLI::ParseError& error);

/// The words of a command line, quoted for a shell.
std::string command_line_of(int argc, const char* const* argv);

/// "there is no command mehs; did you mean mesh?"
std::string unknown_command(const CLI::App& app, const std::string& typed);

}  // namespace octafront::cli
