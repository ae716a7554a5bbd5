#include "mcp_server.h"

#include <octafront/error.h>
#include <octafront/picture.h>

#include "plan_run.h"
#include "terminal.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <deque>
#include <memory>
#include <string_view>
#include <tuple>

#include <fmt/core.h>
#ifndef _WIN32
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#endif

namespace octafront::cli {

#ifdef _WIN32

void serve_mcp(const CLI::App&, const Folders&, const ToolLimits&) {
  throw OptionError("--mcp: the server does not run on Windows yet; under WSL it does");
}

#else

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array kProtocols{"2025-06-18", "2025-03-26", "2024-11-05"};
constexpr std::size_t kLongestLine = 4 << 20, kMostWaiting = 64;
/// What a picture in an answer may be at most; a larger one goes to a file.
constexpr std::size_t kLargestPicture = 2 << 20;

/// Codes of JSON-RPC 2.0.
enum RpcCode {
  kNotJson = -32700,
  kNoRequest = -32600,
  kNoSuchMethod = -32601,
  kBadParameters = -32602,
  kOurBug = -32603
};

struct RpcError {
  int code;
  std::string message;
};

bool is_id(const Json& id) {
  return id.is_string() || id.is_number_integer();
}

/// Answers that go out as one list, once all are there.
struct Batch {
  std::size_t waiting = 0;
  Json answers = Json::array();
};

/// A call of a tool that waits or runs.
struct Call {
  Json id, arguments, token;
  const Tool* tool = nullptr;
  std::shared_ptr<Batch> batch;
  Plan plan;
  std::unique_ptr<PlanRun> run;  ///< of one that runs, or has run
  Clock::time_point last_told;
  int told = 0;
};

class Server {
 public:
  Server(const CLI::App& app, const Folders& folders, const ToolLimits& limits)
      : app_(app), folders_(folders), limits_(limits) {}

  void run() {
    std::signal(SIGPIPE, SIG_IGN);
    ::fcntl(STDIN_FILENO, F_SETFL, ::fcntl(STDIN_FILENO, F_GETFL) | O_NONBLOCK);
    const std::atomic<bool>& is_stopped = install_interrupt_handler();
    while (!is_stopped && is_heard_) {
      wait_for_something();
      listen();
      go_on();
    }
  }

 private:
  // What comes in.

  void wait_for_something() {
    std::array<pollfd, 3> all{{{STDIN_FILENO, POLLIN, 0}, {-1, POLLIN, 0}, {-1, POLLIN, 0}}};
    if (running_) std::tie(all[1].fd, all[2].fd) = running_->run->pipes();
    constexpr int kSoon = 100, kLate = 1000;  // milliseconds
    ::poll(all.data(), all.size(), running_ ? kSoon : kLate);
  }

  void listen() {
    std::array<char, 1 << 16> buffer{};
    ssize_t count = 0;
    while ((count = ::read(STDIN_FILENO, buffer.data(), buffer.size())) > 0)
      hear({buffer.data(), static_cast<std::size_t>(count)});
    if (count == 0) is_heard_ = running_ || !waiting_.empty() ? hear_the_last() : false;
    if (count < 0 && errno != EAGAIN && errno != EINTR) is_heard_ = false;
  }
  /// Who closes standard input wants no more answers.
  bool hear_the_last() {
    running_.reset(), waiting_.clear();
    return false;
  }

  void hear(std::string_view bytes) {
    while (!bytes.empty()) {
      const std::size_t end = bytes.find('\n');
      if (!is_skipping_) line_.append(bytes.substr(0, end));
      if (line_.size() > kLongestLine) {
        is_skipping_ = true, line_.clear();
        tell_error(nullptr, {kNoRequest, fmt::format("a message has at most {} bytes", kLongestLine)}, nullptr);
      }
      if (end == std::string_view::npos) return;
      bytes.remove_prefix(end + 1);
      if (!is_skipping_) take_line(line_);
      is_skipping_ = false, line_.clear();
    }
  }

  void take_line(const std::string& line) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) return;
    constexpr int kDeepest = 64;  // what is deeper would be copied by calls as deep
    bool is_too_deep = false;
    const Json message = Json::parse(
        line,
        [&](int depth, Json::parse_event_t, Json&) {
          is_too_deep = is_too_deep || depth > kDeepest;
          return depth <= kDeepest;
        },
        false);
    if (is_too_deep)
      return tell_error(nullptr, {kNoRequest, fmt::format("a message is at most {} lists or objects deep", kDeepest)},
                        nullptr);
    if (message.is_discarded()) return tell_error(nullptr, {kNotJson, "a message is JSON in one line"}, nullptr);
    if (!message.is_array()) return take(message, nullptr);
    if (message.empty() || protocol_ != "2025-03-26")
      return tell_error(nullptr, {kNoRequest, "lists of messages belong to the protocol 2025-03-26, and are not empty"},
                        nullptr);
    const auto batch = std::make_shared<Batch>();
    for (const Json& one : message) batch->waiting += one.is_object() && one.contains("id") && one.contains("method");
    for (const Json& one : message) take(one, batch);
  }

  void take(const Json& message, const std::shared_ptr<Batch>& batch) {
    if (!message.is_object()) return tell_error(nullptr, {kNoRequest, "a message is an object"}, nullptr);
    const Json id = message.contains("id") ? message["id"] : Json();
    // Of requests of ours there are none that could be answered.
    if (!message.contains("method") && (message.contains("result") || message.contains("error"))) return;
    if (message.value("jsonrpc", Json()) != "2.0" || !message.contains("method") || !message["method"].is_string() ||
        (message.contains("id") && !is_id(id)))
      return tell_error(
          is_id(id) ? id : Json(),
          {kNoRequest, "a request has jsonrpc \"2.0\", a method, and an id that is a text or a whole number"},
          message.contains("id") && message.contains("method") ? batch : nullptr);
    const Json parameters = message.contains("params") ? message["params"] : Json::object();
    const std::string method = message["method"];
    if (!message.contains("id")) return take_notification(method, parameters);
    try {
      if (!parameters.is_object()) throw RpcError{kBadParameters, "params are an object"};
      take_request(id, method, parameters, batch);
    } catch (const RpcError& error) {
      tell_error(id, error, batch);
    } catch (const std::exception& error) {
      tell_error(id, {kOurBug, error.what()}, batch);
    }
  }

  void take_notification(const std::string& method, const Json& parameters) {
    if (method != "notifications/cancelled" || !parameters.is_object() || !parameters.contains("requestId")) return;
    const Json& id = parameters["requestId"];
    // It gets no answer.
    for (auto call = waiting_.begin(); call != waiting_.end(); ++call)
      if ((*call)->id == id) {
        answer_cancelled(**call);
        waiting_.erase(call);
        return;
      }
    if (running_ && running_->id == id) running_->run->cancel();
  }

  void take_request(const Json& id, const std::string& method, const Json& parameters,
                    const std::shared_ptr<Batch>& batch) {
    if (method == "initialize") return tell_result(id, initialized(parameters), batch);
    if (method == "ping") return tell_result(id, Json::object(), batch);
    if (method == "tools/list") return tell_result(id, tool_list(), batch);
    if (method == "tools/call") return take_call(id, parameters, batch);
    throw RpcError{kNoSuchMethod, fmt::format("there is no method {}", method.substr(0, 100))};
  }

  Json initialized(const Json& parameters) {
    const Json wanted = parameters.value("protocolVersion", Json());
    protocol_ = kProtocols.front();
    for (const char* known : kProtocols)
      if (wanted == known) protocol_ = known;
    return {{"protocolVersion", protocol_},
            {"capabilities", {{"tools", Json::object()}}},
            {"serverInfo",
             {{"name", "octafront"}, {"title", "Octafront, tetrahedral meshes"}, {"version", OCTAFRONT_VERSION}}},
            {"instructions",
             "Meshes of tetrahedra for solvers. Begin with inspect: it lists names of solids and faces, which options "
             "take. plan says what a "
             "mesh takes; mesh makes it; check and picture look at it. Options are those of the command line. A call "
             "that fails says which "
             "call may help."}};
  }

  Json tool_list() const {
    Json list = Json::array();
    for (const Tool& tool : tools()) list.push_back(tool_in_json(tool, app_, folders_));
    return {{"tools", list}};
  }

  void take_call(const Json& id, const Json& parameters, const std::shared_ptr<Batch>& batch) {
    if (!parameters.contains("name") || !parameters["name"].is_string())
      throw RpcError{kBadParameters, "a call has the name of a tool"};
    const std::string name = parameters["name"];
    const Tool* tool = tool_called(name);
    if (tool == nullptr) throw RpcError{kBadParameters, fmt::format("there is no tool {}", name.substr(0, 100))};
    if (is_known(id)) throw RpcError{kNoRequest, "a call of this id has no answer yet"};
    if (waiting_.size() >= kMostWaiting) throw RpcError{kOurBug, fmt::format("{} calls wait already", kMostWaiting)};
    auto call = std::make_unique<Call>();
    call->id = id, call->tool = tool, call->batch = batch;
    call->arguments = parameters.contains("arguments") ? parameters["arguments"] : Json::object();
    if (parameters.contains("_meta") && parameters["_meta"].is_object() &&
        parameters["_meta"].contains("progressToken") && is_id(parameters["_meta"]["progressToken"]))
      call->token = parameters["_meta"]["progressToken"];
    try {
      call->plan = plan_of(*tool, call->arguments, app_, folders_, limits_);
      if (call->plan.lines.empty()) return finish(*call, explained(call->arguments, last_failed_, app_));
    } catch (const BadCall& refused) {
      return finish(*call, answer_of(refused, *tool, call->arguments, folders_));
    }
    waiting_.push_back(std::move(call));
  }
  bool is_known(const Json& id) const {
    return (running_ && running_->id == id) ||
           std::ranges::any_of(waiting_, [&](const auto& call) { return call->id == id; });
  }

  // Work.

  void go_on() {
    if (running_) go_on_with(*running_);
    if (running_ || waiting_.empty()) return;
    std::unique_ptr<Call> next = std::move(waiting_.front());
    waiting_.pop_front();
    try {
      next->run = std::make_unique<PlanRun>(next->plan, folders_);
      running_ = std::move(next);
    } catch (const Error& error) {
      tell_error(next->id, {kOurBug, error.what()}, next->batch);
    }
  }

  void go_on_with(Call& call) {
    try {
      const bool goes_on = call.run->goes_on();
      if (const auto progress = call.run->progress()) tell_progress(call, *progress);
      if (goes_on) return;
    } catch (const Error& error) {
      const std::unique_ptr<Call> failed = std::move(running_);
      return tell_error(failed->id, {kOurBug, error.what()}, failed->batch);
    }
    if (call.run->is_cancelled()) return end_cancelled();
    const Json answer = answered(call);
    const std::unique_ptr<Call> done = std::move(running_);
    finish(*done, answer);
  }
  void end_cancelled() {
    const std::unique_ptr<Call> done = std::move(running_);
    answer_cancelled(*done);
  }
  /// Its batch waits for it no longer.
  void answer_cancelled(const Call& call) {
    if (call.batch && --call.batch->waiting == 0 && !call.batch->answers.empty()) send(call.batch->answers);
  }

  void tell_progress(Call& call, const Progress& progress) {
    constexpr std::chrono::milliseconds kBetween{200};
    const auto now = Clock::now();
    if (call.token.is_null() || call.run->is_cancelled() || now - call.last_told < kBetween) return;
    call.last_told = now;
    send(
        {{"jsonrpc", "2.0"},
         {"method", "notifications/progress"},
         {"params",
          {{"progressToken", call.token},
           {"progress", ++call.told},
           {"message", progress.fraction < 0 ? progress.stage
                                             : fmt::format("{} {:.0f} %", progress.stage, 100 * progress.fraction)}}}});
  }

  Json answered(const Call& call) {
    const bool is_drawn = call.tool->output == Tool::Output::kPicture && call.run->results().front().report.is_null() &&
                          call.run->results().front().status == 0;
    if (is_drawn && call.run->output().size() > kLargestPicture) {
      RunResult large{kLimitReached, Json::object(), {}};
      large.report["error"] = {
          {"kind", "limit"},
          {"code", "picture_size"},
          {"message", "the picture is too large for an answer: give a smaller size, or an output"}};
      return answer_of(*call.tool, call.arguments, {large}, folders_);
    }
    return answer_of(*call.tool, call.arguments, call.run->results(), folders_);
  }

  // What goes out.

  void finish(const Call& call, const Json& answer) {
    Json content = Json::array({{{"type", "text"}, {"text", in_a_sentence(*call.tool, answer)}}});
    if (call.run && call.run->output().starts_with("\x89PNG") && !answer.contains("error"))
      content.push_back({{"type", "image"}, {"data", to_base64(call.run->output())}, {"mimeType", "image/png"}});
    Json result{{"content", content}, {"isError", answer.contains("error")}};
    if (protocol_ == "2025-06-18") result["structuredContent"] = answer;
    if (answer.contains("error")) last_failed_ = answer;
    tell_result(call.id, result, call.batch);
  }
  void tell_result(const Json& id, const Json& result, const std::shared_ptr<Batch>& batch) {
    answer({{"jsonrpc", "2.0"}, {"id", id}, {"result", result}}, batch);
  }
  void tell_error(const Json& id, const RpcError& error, const std::shared_ptr<Batch>& batch) {
    answer({{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", error.code}, {"message", error.message}}}}, batch);
  }
  void answer(const Json& message, const std::shared_ptr<Batch>& batch) {
    if (!batch) return send(message);
    batch->answers.push_back(message);
    if (--batch->waiting == 0) send(batch->answers);
  }
  void send(const Json& message) {
    const std::string line = message.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    std::fwrite(line.data(), 1, line.size(), stdout);
    if (std::fflush(stdout) != 0) is_heard_ = false;
  }

  const CLI::App& app_;
  const Folders& folders_;
  const ToolLimits& limits_;
  std::string protocol_ = kProtocols.front(), line_;
  bool is_heard_ = true, is_skipping_ = false;
  std::deque<std::unique_ptr<Call>> waiting_;
  std::unique_ptr<Call> running_;
  Json last_failed_;
};

}  // namespace

void serve_mcp(const CLI::App& app, const Folders& folders, const ToolLimits& limits) {
  Server(app, folders, limits).run();
}

#endif

}  // namespace octafront::cli
