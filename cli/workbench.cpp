#include "workbench.h"

#include <octafront/error.h>

#include "failure.h"
#include "plan_run.h"
#include "terminal.h"
#include "text.h"
#include "workbench_calls.h"
#include "workbench_files.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <thread>

#include <fmt/core.h>
#include <httplib.h>
#include <spawn.h>

namespace octafront::cli {

namespace {

using Clock = std::chrono::steady_clock;
using httplib::Request, httplib::Response, httplib::DataSink, httplib::ContentReader;

constexpr std::size_t kLongestCall = 1 << 20, kLargestUpload = std::size_t{4} << 30;
constexpr int kMostRuns = 4;
constexpr std::size_t kThreads = 24;  // a page that is open, and each run, has one
/// For how long no page may be there: one that is loaded anew is back sooner.
constexpr std::chrono::seconds kPatience{6};

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void answer(Response& response, const Json& json, int status = 200) {
  response.status = status;
  response.set_content(text_of(json), "application/json");
}
void answer_error(Response& response, const RefusedRequest& error) {
  answer(response, in_json(error), error.status);
}
httplib::Server::HandlerResponse answer_handled(Response& response, const RefusedRequest& error) {
  answer_error(response, error);
  return httplib::Server::HandlerResponse::Handled;
}

/// What the library itself refuses.
RefusedRequest error_of_status(int status) {
  if (status == 413) return {status, "too_large", "that is more than is taken"};
  if (status == 404) return {status, "not_found", "nothing is served here"};
  return {status, "bad_request", fmt::format("no request that is understood ({})", status)};
}

/// Not in one piece, which the library would take a second to compress.
void send_text(Response& response, std::string text, const char* type) {
  const std::size_t size = text.size();
  response.set_content_provider(size, type,
                                [text = std::move(text)](std::size_t offset, std::size_t length, DataSink& sink) {
                                  return sink.write(text.data() + offset, length);
                                });
}

std::string random_hex() {
  std::random_device source;
  std::string hex;
  for (int i = 0; i < 4; ++i) hex += fmt::format("{:08x}", source());
  return hex;
}

/// As long as it takes to compare all of it, wherever they differ.
bool is_same_secret(std::string_view a, std::string_view b) {
  unsigned differs = a.size() != b.size() ? 1 : 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) differs |= static_cast<unsigned>(a[i] ^ b[i]);
  return differs == 0;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The page, which scripts/ui.sh makes, where it lies beside this program. Throws OptionError if it does not.
std::filesystem::path workbench_page() {
  if (const char* named = std::getenv("OCTAFRONT_UI_PAGE")) return named;
  std::error_code ignored;
  const std::filesystem::path folder = this_program().parent_path(), name = "octafront-ui.html";
  for (const std::filesystem::path& place :
       {folder / name, folder / "../share/octafront" / name, folder / "../../ui" / name})
    if (std::filesystem::is_regular_file(place, ignored)) return place;
  throw OptionError(
      "the page of the workbench, octafront-ui.html, is not beside this program: scripts/ui.sh makes it (Node and "
      "npm); "
      "the variable OCTAFRONT_UI_PAGE names it elsewhere");
}

class Workbench {
 public:
  Workbench(const CLI::App& app, const WorkbenchSetting& setting)
      : app_(app), setting_(setting), page_(content_of(workbench_page())) {
    scratch_.add("uploads");
    if (setting.file.empty()) return;
    file_ = std::filesystem::absolute(setting.file);
    if (!std::filesystem::exists(file_)) throw InputError(setting.file.string() + ": there is no such file");
  }

  void run() {
    const std::atomic<bool>& interrupted = install_interrupt_handler();
    set_up();
    const std::string address = bind();
    std::thread serving([this] { server_.listen_after_bind(); });
    if (setting_.opens_browser) open_browser(address + "open/" + key_);
    fmt::print("The workbench is at {}{}/\nIt ends when its page is closed, or by Ctrl-C.\n", address, token_);
    std::fflush(stdout);
    while (!interrupted && !is_left()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    is_ending_ = true;
    server_.stop();
    serving.join();
  }

 private:
  // The server.

  void set_up() {
    server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    server_.set_keep_alive_max_count(1000);
    server_.set_keep_alive_timeout(2);  // seconds, for which the end may have to wait
    server_.set_tcp_nodelay(true);
    server_.set_payload_max_length(kLargestUpload);
    server_.set_default_headers({{"Cache-Control", "no-store"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"X-Content-Type-Options", "nosniff"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"},
                                 {"X-Frame-Options", "DENY"}});
    server_.set_pre_routing_handler([this](const Request& request, Response& response) {
      if (const auto refused = refusal_of(request)) return answer_handled(response, *refused);
      return httplib::Server::HandlerResponse::Unhandled;
    });
    server_.set_error_handler([](const Request&, Response& response) {
      if (response.body.empty()) answer_error(response, error_of_status(response.status));
    });
    server_.set_exception_handler([](const Request&, Response& response, std::exception_ptr thrown) {
      try {
        std::rethrow_exception(thrown);
      } catch (const RefusedRequest& error) {
        answer_error(response, error);
      } catch (...) {
        answer_error(response, {500, "internal", current_failure().message});
      }
    });
    set_routes("/" + token_ + "/");
  }

  void set_routes(const std::string& at) {
    server_.Get("/open/" + key_, [this, at](const Request&, Response& response) { open_once(at, response); });
    server_.Get(at,
                [this](const Request&, Response& response) { send_text(response, page_, "text/html; charset=utf-8"); });
    server_.Get(at + "about", [this](const Request&, Response& response) {
      send_text(response, text_of(about_workbench(app_, file_)), "application/json");
    });
    server_.Get(at + "alive", [this](const Request&, Response& response) { stay(response); });
    server_.Get(at + "made/(\\d{1,9})/(.+)",
                [this](const Request& request, Response& response) { send_made(request, response); });
    server_.Put(at + "upload/(.+)", [this](const Request& request, Response& response, const ContentReader& content) {
      take_upload(request, response, content);
    });
    server_.Post(at + "run", [this](const Request&, Response& response, const ContentReader& content) {
      take_call(response, content);
    });
  }

  std::string bind() {
    const char* const host = "127.0.0.1";
    port_ = setting_.port > 0 ? setting_.port : server_.bind_to_any_port(host);
    if (port_ <= 0 || (setting_.port > 0 && !server_.bind_to_port(host, port_)))
      throw OutputError(fmt::format("--port: {} cannot be had on the loopback address", setting_.port));
    return fmt::format("http://{}:{}/", host, port_);
  }

  /// Nobody else's page, under whatever name it knows this machine, and nobody without the token.
  std::optional<RefusedRequest> refusal_of(const Request& request) const {
    const std::string host = request.get_header_value("Host");
    if (request.get_header_value_count("Host") != 1 ||
        (host != fmt::format("127.0.0.1:{}", port_) && host != fmt::format("localhost:{}", port_)))
      return RefusedRequest{403, "bad_host", "requests name the address that was printed"};
    const bool is_first_look = request.method == "GET" && is_same_secret(request.path, "/open/" + key_);
    if (!is_first_look &&
        !is_same_secret(std::string_view(request.path).substr(0, token_.size() + 2), "/" + token_ + "/"))
      return RefusedRequest{403, "no_token", "requests have the token of the address that was printed"};
    const std::string site = request.get_header_value("Sec-Fetch-Site");
    const bool is_typed = site == "none" && request.method == "GET";
    if ((request.has_header("Origin") && request.get_header_value("Origin") != "http://" + host) ||
        (!site.empty() && site != "same-origin" && !is_typed && !is_first_look))
      return RefusedRequest{403, "bad_origin", "requests come from the page that is served here"};
    return std::nullopt;
  }

  /// The browser's command line can be seen by others; what stands there is good for one look.
  void open_once(const std::string& at, Response& response) {
    if (was_opened_.exchange(true)) throw RefusedRequest{403, "no_token", "this address was good for one look"};
    response.set_redirect(at, 303);
  }

  static void open_browser(const std::string& address) {
#ifdef __APPLE__
    const char* const program = "open";
#else
    const char* const program = "xdg-open";
#endif
    std::string word = address;
    std::array<char*, 3> argv{const_cast<char*>(program), word.data(), nullptr};
    // Ctrl-C here is not for the browser. Whoever has none opens the address that is printed.
    posix_spawnattr_t apart;
    ::posix_spawnattr_init(&apart);
    ::posix_spawnattr_setflags(&apart, POSIX_SPAWN_SETPGROUP);
    pid_t process = 0;
    ::posix_spawnp(&process, program, nullptr, &apart, argv.data(), environ);
    ::posix_spawnattr_destroy(&apart);
  }

  // Pages that are open.

  void stay(Response& response) {
    ++pages_;
    response.set_chunked_content_provider(
        "application/octet-stream",  // of text the library would keep back what it may compress better
        [this](std::size_t, DataSink& sink) {
          for (int i = 0; i < 5 && !is_ending_; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(200));
          if (is_ending_) sink.done();
          return is_ending_ || sink.write("\n", 1);
        },
        [this](bool) { last_left_ = Clock::now().time_since_epoch().count(), was_seen_ = true, --pages_; });
  }
  bool is_left() const {
    const Clock::time_point left{Clock::duration(last_left_.load())};
    return was_seen_ && pages_ == 0 && Clock::now() - left > kPatience;
  }

  // Files.

  std::filesystem::path folder_of(const std::string& run) const {
    return scratch_.path() / ("run-" + run);
  }

  void take_upload(const Request& request, Response& response, const ContentReader& content) {
    const std::string name = request.matches[1];
    if (!is_plain_name(name))
      throw RefusedRequest{400, "bad_name", "a file has a name without folders, of at most 200 bytes"};
    const std::filesystem::path file = scratch_.path() / "uploads" / name;
    std::ofstream out(file, std::ios::binary | std::ios::trunc);
    std::size_t total = 0;
    const bool is_whole = content([&](const char* data, std::size_t size) {
      return (total += size) <= kLargestUpload && out.write(data, static_cast<std::streamsize>(size));
    });
    out.close();
    if (is_whole && out.good()) return answer(response, file_in_json(file, name));
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    throw RefusedRequest{400, "not_whole", "the file did not come in whole, or there is no room for it"};
  }

  void send_made(const Request& request, Response& response) const {
    const std::filesystem::path folder = folder_of(request.matches[1]);
    const std::string name = request.matches[2];
    const std::vector<std::string> there = files_below(folder);
    if (std::ranges::find(there, name) == there.end())
      throw RefusedRequest{404, "not_found", "no run has left this file"};
    const auto in = std::make_shared<std::ifstream>(folder / name, std::ios::binary);
    response.set_content_provider(
        std::filesystem::file_size(folder / name), "application/octet-stream",
        [in](std::size_t offset, std::size_t length, DataSink& sink) {
          std::array<char, 1 << 16> buffer{};
          in->seekg(static_cast<std::streamoff>(offset));
          in->read(buffer.data(), static_cast<std::streamsize>(std::min(length, buffer.size())));
          return in->gcount() > 0 && sink.write(buffer.data(), static_cast<std::size_t>(in->gcount()));
        });
  }

  // Runs.

  static std::string read_call(const ContentReader& content) {
    std::string text;
    const bool is_whole = content([&](const char* data, std::size_t size) {
      text.append(data, size);
      return text.size() <= kLongestCall;
    });
    if (!is_whole) throw RefusedRequest{413, "too_large", fmt::format("a call has at most {} bytes", kLongestCall)};
    return text;
  }

  struct Running {
    std::string number;
    const Tool* tool;
    Json arguments;
    std::unique_ptr<Folders> folders;
    std::unique_ptr<PlanRun> run;
  };

  void take_call(Response& response, const ContentReader& content) {
    const ToolCall call = call_of(read_call(content));
    if (++runs_ > kMostRuns) {
      --runs_;
      throw RefusedRequest{503, "busy", fmt::format("{} runs go on already", kMostRuns)};
    }
    const std::shared_ptr<Running> running(new Running, [this](Running* ended) { delete ended, --runs_; });
    running->number = std::to_string(++last_run_), running->tool = call.tool, running->arguments = call.arguments;
    std::vector<std::filesystem::path> folders{scratch_.add("run-" + running->number), scratch_.path()};
    if (!file_.empty()) folders.push_back(file_.parent_path());
    running->folders = std::make_unique<Folders>(folders);
    try {
      start(*running);
    } catch (const BadCall& bad) {
      return answer(response, answer_of(bad, *running->tool, running->arguments, *running->folders), 400);
    }
    response.set_chunked_content_provider(
        "application/x-ndjson", [this, running](std::size_t, DataSink& sink) { return go_on(*running, sink); });
  }
  void start(Running& running) {
    Plan plan = plan_of(*running.tool, running.arguments, app_, *running.folders, {});
    const std::lock_guard one_at_a_time(starting_);
    running.run = std::make_unique<PlanRun>(std::move(plan), *running.folders);
  }

  /// A line of JSON as soon as there is something to tell, an empty one now and then: who is gone is found out by it.
  bool go_on(Running& running, DataSink& sink) {
    const auto tell = [&](const Json& line) {
      const std::string text = text_of(line) + "\n";
      return sink.write(text.data(), text.size());
    };
    constexpr int kSoon = 100;  // milliseconds
    const auto until = Clock::now() + std::chrono::milliseconds(2 * kSoon);
    while (Clock::now() < until) {
      running.run->wait(kSoon);
      if (is_ending_) return false;
      if (running.run->goes_on()) continue;
      const bool is_told = tell(outcome(running));
      sink.done();
      return is_told;
    }
    if (const auto progress = running.run->progress())
      return tell({{"stage", progress->stage}, {"fraction", progress->fraction}});
    return sink.write("\n", 1);
  }

  Json outcome(const Running& running) const {
    const RunOfTool run{*running.tool, running.arguments, running.number, folder_of(running.number)};
    return {{"done", outcome_of(run, running.run->results(), *running.folders)}};
  }

  const CLI::App& app_;
  const WorkbenchSetting setting_;
  const std::string page_, token_ = random_hex(), key_ = random_hex();
  const ScratchFolder scratch_;
  std::filesystem::path file_;
  httplib::Server server_;
  int port_ = 0;
  std::atomic<int> pages_ = 0, runs_ = 0, last_run_ = 0;
  std::atomic<bool> was_opened_ = false, was_seen_ = false, is_ending_ = false;
  std::atomic<Clock::rep> last_left_ = 0;
  std::mutex starting_;
};

}  // namespace

void serve_workbench(const CLI::App& app, const WorkbenchSetting& setting) {
  Workbench(app, setting).run();
}

}  // namespace octafront::cli
