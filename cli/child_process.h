#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace octafront::cli {

/// The file of this very program.
std::filesystem::path this_program();

/// What a program that is started may do.
struct ChildSetting {
  std::filesystem::path folder;          ///< that it runs in
  std::vector<std::string> folders;      ///< where it may read and write, with what lies below
  std::vector<std::string> environment;  ///< NAME=VALUE, beside what there is
};

/// This very program once more, in a process group of its own with the programs that it starts, with pipes for what it
/// writes. Where the kernel has Landlock, files outside of the folders cannot be opened, but to run programs: whatever
/// the program, or a library that it uses, tries. Not on Windows.
class ChildProcess {
 public:
  /// `arguments` without the name of the program. Throws OutputError if no process can be made.
  ChildProcess(const std::vector<std::string>& arguments, const ChildSetting& setting);
  /// Kills it, if it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  int output() const { return output_; }
  int errors() const { return errors_; }
  /// Reads what is there; false once the other end is closed. Does not wait.
  bool read_output(std::string& to) { return read_from(output_, to); }
  bool read_errors(std::string& to) { return read_from(errors_, to); }
  /// Asks it to end, as Ctrl-C does; kills it with all that it started.
  void interrupt();
  void kill();
  /// Waits until it has ended. The exit status, or 128 and the signal that ended it.
  int wait();

 private:
  static bool read_from(int& pipe, std::string& to);

  int process_ = -1, output_ = -1, errors_ = -1;
};

}  // namespace octafront::cli
