#include "pipe.h"

#include "measure.h"
#include "text.h"

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Message_ProgressIndicator.hxx>
#include <TCollection_AsciiString.hxx>
#include <algorithm>
#include <cerrno>
#include <cmath>

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

namespace octafront::cad {

namespace {

int frames = -1;
pid_t parent = 0;

void end_if_orphaned(int) {
  if (getppid() != parent) _exit(0);
}

void write_all(const char* bytes, std::size_t n) {
  while (n > 0) {
    const ssize_t written = write(frames, bytes, n);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(0);
    bytes += written, n -= static_cast<std::size_t>(written);
  }
}

void limit(int resource, double amount) {
  if (!(amount > 0)) return;
  rlimit now{};
  getrlimit(resource, &now);
  now.rlim_cur = std::min(now.rlim_max, static_cast<rlim_t>(std::ceil(amount)));
  setrlimit(resource, &now);
}

/// Keeps the library's complaints.
class Listener : public Message_Printer {
 public:
  static std::vector<std::string>& kept() {
    static std::vector<std::string> all;
    return all;
  }

 protected:
  void send(const TCollection_AsciiString& text, const Message_Gravity gravity) const override {
    constexpr std::size_t kMost = 20;
    if (gravity >= Message_Fail && kept().size() < kMost) kept().push_back(to_utf8(text.ToCString()));
  }
};

class Reporter : public Message_ProgressIndicator {
 public:
  Reporter(std::string stage, std::string what) : stage_(std::move(stage)), what_(std::move(what)) {}

 protected:
  void Show(const Message_ProgressScope&, const Standard_Boolean) override {
    const int hundredth = static_cast<int>(GetPosition() * 100);
    if (hundredth <= last_) return;
    last_ = hundredth;
    send_progress(stage_, what_, GetPosition());
  }

 private:
  const std::string stage_, what_;
  int last_ = 0;
};

}  // namespace

void take_standard_output() {
  frames = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  close(nowhere);
  signal(SIGPIPE, SIG_IGN);
  Message::DefaultMessenger()->ChangePrinters().Clear();
  Message::DefaultMessenger()->AddPrinter(new Listener);
}

std::vector<std::string> heard() {
  return Listener::kept();
}

// Not by PR_SET_PDEATHSIG: that looks at the thread that started us, which may end long before its process.
void end_with_parent() {
  parent = getppid();
  struct sigaction action {};
  action.sa_handler = end_if_orphaned;
  action.sa_flags = SA_RESTART;
  sigaction(SIGALRM, &action, nullptr);
  const itimerval each_second{{1, 0}, {1, 0}};
  setitimer(ITIMER_REAL, &each_second, nullptr);
}

void limit_memory(double bytes) {
  limit(RLIMIT_AS, bytes);
}
void limit_cpu(double seconds) {
  limit(RLIMIT_CPU, seconds);
}
void lift_cpu_limit() {
  rlimit now{};
  getrlimit(RLIMIT_CPU, &now);
  now.rlim_cur = now.rlim_max;
  setrlimit(RLIMIT_CPU, &now);
}

void send(FrameKind kind, const std::string& content) {
  std::string head = frame_head(kind, content.size());
  // A small frame goes out whole, or not at all if the process is ended here.
  if (head.size() + content.size() <= PIPE_BUF) {
    head += content;
    return write_all(head.data(), head.size());
  }
  write_all(head.data(), head.size());
  write_all(content.data(), content.size());
}
void send_note(const std::string& sentence) {
  send(FrameKind::kNote, sentence);
}
void send_error(const std::string& sentence) {
  send(FrameKind::kError, sentence);
}
void send_progress(const Where& where) {
  send(FrameKind::kProgress, to_bytes(where));
}
void send_progress(const std::string& stage, const std::string& what, double done) {
  send_progress(Where{stage, what, done, {}, {}});
}
void send_progress(const std::string& stage, const std::string& what, double done, const TopoDS_Shape& place) {
  const Box3 box = quick_box(place);
  send_progress(box.empty() ? Where{stage, what, done, {}, {}} : Where{stage, what, done, box.lo, box.hi});
}

Message_ProgressRange progress_of(const std::string& stage, const std::string& what) {
  // The indicator outlives the range that is handed out.
  static Handle(Message_ProgressIndicator) current;
  current = new Reporter(stage, what);
  return current->Start();
}

}  // namespace octafront::cad
