#include "mcp_server.h"

#include <octafront/error.h>
#include <octafront/picture.h>

#include "child_process.h"
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
  std::vector<RunResult> results;
  std::unique_ptr<ChildProcess> child;
  std::string output, errors, said;  ///< `errors`: what of them is no whole line yet
  Clock::time_point start, last_told, asked_to_end;
  int told = 0;
  bool is_cancelled = false, is_too_long = false;
};

class Server {
 public:
  Server(const CLI::App& app, const Folders& folders, const ToolLimits& limits)
      : app_(app), folders_(folders), limits_(limits) {}

  void run() {
    std::signal(SIGPIPE, SIG_IGN);
    ::fcntl(STDIN_FILENO, F_SETFL, ::fcntl(STDIN_FILENO, F_GETFL) | O_NONBLOCK);
    const std::atomic<bool>& interrupted = install_interrupt_handler();
    while (!interrupted && is_heard_) {
      wait_for_something();
      listen();
      go_on();
    }
  }

 private:
  // What comes in.

  void wait_for_something() {
    std::array<pollfd, 3> all{{{STDIN_FILENO, POLLIN, 0}, {-1, POLLIN, 0}, {-1, POLLIN, 0}}};
    if (running_ && running_->child) all[1].fd = running_->child->output(), all[2].fd = running_->child->errors();
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
    if (running_ && running_->id == id) running_->is_cancelled = true;
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
    running_ = std::move(waiting_.front());
    waiting_.pop_front();
    running_->start = Clock::now();
    start_line(*running_);
  }

  void start_line(Call& call) {
    try {
      ChildSetting setting{folders_.home(), folders_.all(), {"OCTAFRONT_PROGRESS=lines"}};
      call.output.clear(), call.errors.clear(), call.said.clear();
      call.child = std::make_unique<ChildProcess>(call.plan.lines[call.results.size()], setting);
    } catch (const Error& error) {
      const Json id = call.id;
      const auto batch = call.batch;
      running_.reset();
      tell_error(id, {kOurBug, error.what()}, batch);
    }
  }

  void go_on_with(Call& call) {
    std::string errors;
    const bool has_output = call.child->read_output(call.output), has_errors = call.child->read_errors(errors);
    hear_child(call, errors);
    hold_limits(call);
    if (has_output || has_errors) return;
    const int status = call.child->wait();
    call.child.reset();
    if (call.is_cancelled) return end_cancelled();
    call.results.push_back(result_of(call, status));
    // A file that cannot be read at all is not looked at twice.
    if (call.results.size() < call.plan.lines.size() && status == 0) return start_line(call);
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

  /// By the clock; who does not end when asked is ended.
  void hold_limits(Call& call) {
    constexpr std::chrono::seconds kGrace{3};
    const auto now = Clock::now();
    if (call.plan.seconds && std::chrono::duration<double>(now - call.start).count() > *call.plan.seconds)
      call.is_too_long = true;
    if (!call.is_cancelled && !call.is_too_long) return;
    if (call.asked_to_end == Clock::time_point()) call.asked_to_end = now, call.child->interrupt();
    if (now - call.asked_to_end > kGrace) call.child->kill();
  }

  /// Progress goes on to the client; the rest is kept.
  void hear_child(Call& call, const std::string& text) {
    constexpr std::size_t kMostSaid = 1 << 16;
    call.errors += text;
    for (std::size_t end = 0; (end = call.errors.find('\n')) != std::string::npos; call.errors.erase(0, end + 1)) {
      const std::string line = call.errors.substr(0, end);
      if (line.starts_with('\x1f'))
        tell_progress(call, line.substr(1));
      else if (call.said.size() < kMostSaid)
        call.said += line + "\n";
    }
  }
  void tell_progress(Call& call, const std::string& line) {
    constexpr std::chrono::milliseconds kBetween{200};
    const auto now = Clock::now();
    if (call.token.is_null() || call.is_cancelled || now - call.last_told < kBetween) return;
    call.last_told = now;
    const std::size_t tab = line.find('\t');
    const double share = tab == std::string::npos ? -1 : std::atof(line.c_str() + tab + 1);
    const std::string stage = line.substr(0, tab);
    send({{"jsonrpc", "2.0"},
          {"method", "notifications/progress"},
          {"params",
           {{"progressToken", call.token},
            {"progress", ++call.told},
            {"message", share < 0 ? stage : fmt::format("{} {:.0f} %", stage, 100 * share)}}}});
  }

  RunResult result_of(const Call& call, int status) const {
    RunResult result{status, Json::parse(call.output, nullptr, false), call.said + call.errors};
    if (result.report.is_discarded()) result.report = nullptr;
    if (!call.is_too_long) return result;
    result.status = kLimitReached;
    if (!result.report.is_object()) result.report = Json::object();
    result.report["error"] = {
        {"kind", "limit"},
        {"code", "seconds"},
        {"message",
         fmt::format("the {:g} seconds that it may take are over; no result was written", *call.plan.seconds)}};
    return result;
  }

  Json answered(const Call& call) {
    const bool is_drawn = call.tool->output == Tool::Output::kPicture && call.results.front().report.is_null() &&
                          call.results.front().status == 0;
    if (is_drawn && call.output.size() > kLargestPicture) {
      RunResult large{kLimitReached, Json::object(), {}};
      large.report["error"] = {
          {"kind", "limit"},
          {"code", "picture_size"},
          {"message", "the picture is too large for an answer: give a smaller size, or an output"}};
      return answer_of(*call.tool, call.arguments, {large}, folders_);
    }
    return answer_of(*call.tool, call.arguments, call.results, folders_);
  }

  // What goes out.

  void finish(const Call& call, const Json& answer) {
    Json content = Json::array({{{"type", "text"}, {"text", in_a_sentence(*call.tool, answer)}}});
    if (call.output.starts_with("\x89PNG") && !answer.contains("error"))
      content.push_back({{"type", "image"}, {"data", to_base64(call.output)}, {"mimeType", "image/png"}});
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
