#include "answer.h"

#include "pipe.h"
#include "triangulate.h"
#include "weld.h"

#include <Standard_Failure.hxx>
#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace octafront::cad {

namespace {

/// Attempts that one answer may take, and the part of what is left of its time that each may use.
constexpr int kAttempts = 12;
constexpr double kShareOfTime = .5;

/// Where an attempt is, kept where it can be read after its end.
struct Place {
  enum class Stage : int { kEdges, kFace, kRecord, kSending };
  volatile Stage stage = Stage::kEdges;
  volatile std::size_t face = 0;
};

class Attempts {
 public:
  Attempts(const Part& part, const Topology& topology, const CadModel& opened, const Fineness& fineness, double seconds)
      : part_(part),
        topology_(topology),
        opened_(opened),
        fineness_(fineness),
        seconds_(seconds),
        rung_(topology.faces.size(), 0) {
    void* memory = mmap(nullptr, sizeof(Place), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw Refusal("there is no memory left to triangulate in");
    place_ = new (memory) Place;
  }
  ~Attempts() { munmap(place_, sizeof(Place)); }
  Attempts(const Attempts&) = delete;
  Attempts& operator=(const Attempts&) = delete;

  void make() {
    for (int i = 0; i < kAttempts; ++i) {
      place_->stage = Place::Stage::kEdges;
      const int status = run();
      if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
      if (!learn_from(status)) return;
    }
    send_error("triangles cannot be made: OpenCASCADE does not survive too many of the faces");
  }

 private:
  /// One attempt in a process of its own; how it ended.
  int run() {
    const pid_t pid = fork();
    if (pid < 0) throw Refusal(fmt::format("no process can be started to triangulate in: {}", std::strerror(errno)));
    if (pid == 0) {
      end_with_parent();
      limit_cpu(seconds_ * kShareOfTime);
      work();
      _exit(0);
    }
    int status = 0;
    rusage used{};
    while (wait4(pid, &status, 0, &used) < 0 && errno == EINTR) {
    }
    if (seconds_ > 0)
      seconds_ = std::max(2.0, seconds_ - static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec));
    return status;
  }

  void work() {
    try {
      CadModel model = opened_;
      const double n = static_cast<double>(std::max<std::size_t>(1, topology_.faces.size()));
      send_progress("triangulating", "edges");
      rung_ = triangulate(part_, topology_, fineness_, rung_, [&](std::size_t f) {
        enter(Place::Stage::kFace, f);
        send_progress("triangulating", face_in_words(part_, topology_, f), static_cast<double>(f) / n,
                      topology_.faces[f].face);
      });
      add_triangles(
          part_, topology_, fineness_, rung_,
          [&](std::size_t f) {
            enter(Place::Stage::kRecord, f);
            send_progress("describing", face_in_words(part_, topology_, f), static_cast<double>(f) / n,
                          topology_.faces[f].face);
          },
          model);
      enter(Place::Stage::kSending, 0);
      lift_cpu_limit();
      send(FrameKind::kModel, to_bytes(model));
    } catch (const Standard_Failure& failure) {
      send_error(fmt::format("triangles cannot be made: OpenCASCADE says {}", failure.GetMessageString()));
    } catch (const std::exception& failure) {
      send_error(fmt::format("triangles cannot be made: {}", failure.what()));
    }
  }

  void enter(Place::Stage stage, std::size_t face) {
    place_->face = face;
    place_->stage = stage;
  }

  /// False: there is nothing that another attempt could do without.
  bool learn_from(int status) {
    const char* how = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU
                          ? "does not end in its time (of CPU: on another machine it may)"
                          : "ends the process";
    if (place_->stage != Place::Stage::kFace) {
      const bool record = place_->stage == Place::Stage::kRecord;
      send_error(record ? fmt::format("{} cannot be described: OpenCASCADE {} there",
                                      face_in_words(part_, topology_, place_->face), how)
                        : fmt::format("triangles cannot be made: OpenCASCADE {} at the edges", how));
      return false;
    }
    int& rung = rung_[place_->face];
    rung = std::min(rung + 1, kLastRung);
    send_note(fmt::format("OpenCASCADE {} at {}: {}", how, face_in_words(part_, topology_, place_->face),
                          rung == kLastRung ? "it stays without triangles" : "it is tried coarser"));
    return true;
  }

  const Part& part_;
  const Topology& topology_;
  const CadModel& opened_;
  const Fineness& fineness_;
  double seconds_;
  std::vector<int> rung_;
  Place* place_ = nullptr;
};

}  // namespace

void answer(const Part& part, const Topology& topology, const CadModel& opened, const Fineness& fineness,
            const Arguments& arguments) {
  Attempts(part, topology, opened, fineness, arguments.cpu_seconds).make();
}

}  // namespace octafront::cad
