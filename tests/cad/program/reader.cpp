#include "reader.h"

#include <chrono>
#include <csignal>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace octafront::testing {

namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Pipe {
  int read = -1, write = -1;
  Pipe() {
    int ends[2];
    if (pipe(ends) == 0) read = ends[0], write = ends[1];
  }
};

[[noreturn]] void become_reader(const std::string& file, const std::vector<std::string>& options, const Pipe& in,
                                const Pipe& out) {
  dup2(in.read, STDIN_FILENO), dup2(out.write, STDOUT_FILENO);
  for (const int end : {in.read, in.write, out.read, out.write}) close(end);
  std::vector<std::string> words = {OCTAFRONT_CAD_PROGRAM, file};
  words.insert(words.end(), options.begin(), options.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  _exit(127);
}

void take_frames(Answer& answer) {
  std::string_view rest = answer.bytes;
  while (!rest.empty()) {
    if (rest.size() < cad::kFrameHead) break;
    const auto head = cad::head_of(rest);
    if (!head || rest.size() - cad::kFrameHead < head->length) break;
    const std::string_view content = rest.substr(cad::kFrameHead, head->length);
    rest.remove_prefix(cad::kFrameHead + head->length);
    switch (head->kind) {
      case cad::FrameKind::kProgress:
        answer.stages.push_back(cad::where_of(content).stage);
        break;
      case cad::FrameKind::kNote:
        answer.notes.emplace_back(content);
        break;
      case cad::FrameKind::kOpened:
        answer.opened = cad::opened_of(content);
        break;
      case cad::FrameKind::kModel:
        answer.models.push_back(cad::model_of(content));
        break;
      case cad::FrameKind::kError:
        answer.errors.emplace_back(content);
        break;
    }
  }
  answer.complete = rest.empty();
}

}  // namespace

Answer run_reader(const std::string& file, const std::vector<std::string>& options, const std::string& lines,
                  double seconds) {
  const auto start = Clock::now();
  Answer answer;
  const Pipe in, out;
  const pid_t pid = fork();
  if (pid == 0) become_reader(file, options, in, out);
  close(in.read), close(out.write);
  // Few bytes: they fit into the pipe.
  std::signal(SIGPIPE, SIG_IGN);
  [[maybe_unused]] const ssize_t sent = write(in.write, lines.data(), lines.size());
  close(in.write);
  char buffer[1 << 16];
  for (;;) {
    pollfd waiting{out.read, POLLIN, 0};
    const double left = seconds - since(start);
    if (left <= 0 || poll(&waiting, 1, static_cast<int>(left * 1000) + 1) == 0) {
      kill(pid, SIGKILL);
      break;
    }
    const ssize_t n = read(out.read, buffer, sizeof buffer);
    if (n <= 0) break;
    answer.bytes.append(buffer, static_cast<std::size_t>(n));
  }
  int status = 0;
  waitpid(pid, &status, 0);
  close(out.read);
  answer.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  answer.seconds = since(start);
  take_frames(answer);
  return answer;
}

}  // namespace octafront::testing
