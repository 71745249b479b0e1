// SPDX-License-Identifier: BSD-3-Clause
// cpp-httplib in threads of low priority; each request passes the guard first.
#include "cli/page_server.h"

#include <httplib.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;
using httplib::Request;
using httplib::Response;

constexpr auto kTurn = 100ms;
constexpr int kHeartbeat = 20;          // turns without news after which a sign of life is sent
constexpr int kOtherRequests = 8;       // at once, besides the streams
constexpr std::size_t kLongest = 1024;  // of a request's target

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != std::ssize(bytes)) {
    throw std::runtime_error("the system gives no random numbers");
  }
  std::string text;
  for (const unsigned char byte : bytes) {
    for (const int digit : {byte >> 4, byte & 15}) text += "0123456789abcdef"[digit];
  }
  return text;
}

std::string own_name() {
  char name[256] = {};
  gethostname(name, sizeof name - 1);
  return name;
}

/// Takes as long for a wrong text as for the right one of its length.
bool same(const std::string& a, const std::string& b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  }
  return difference == 0;
}

/// Always false, for those that ask whether a request passes.
bool refuse(Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(why + "\n", "text/plain; charset=utf-8");
  return false;
}

/// "[::1]" of "[::1]:80", "a.b" of "a.b:80".
std::string name_in(const std::string& host) {
  const auto bracket = host.find(']');
  return host.substr(0, host.find(':', bracket == host.npos ? 0 : bracket));
}

/// Whether it is an address: a page of another site cannot make a browser use one as our name,
/// because it has no name to rebind.
bool is_address(const std::string& name) {
  unsigned char bytes[16];
  if (name.starts_with('[') && name.ends_with(']')) {
    return inet_pton(AF_INET6, name.substr(1, name.size() - 2).c_str(), bytes) == 1;
  }
  return inet_pton(AF_INET, name.c_str(), bytes) == 1;
}

class Server final : public PageServer {
 public:
  Server(const Options& options, Content content)
      : address_(options.listen.empty() ? "127.0.0.1" : options.listen),
        token_(options.listen.empty() ? "" : random_token()),
        content_(std::move(content)) {
    server_.new_task_queue = [] { return new httplib::ThreadPool(kMostStreams + kOtherRequests); };
    server_.set_socket_options([](socket_t socket) {
      const int yes = 1;  // but not SO_REUSEPORT: two servers must not share a port
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server_.set_tcp_nodelay(true);
    server_.set_read_timeout(5s);
    server_.set_write_timeout(5s);
    server_.set_keep_alive_timeout(2);
    server_.set_payload_max_length(0);
    server_.set_pre_routing_handler([this](const Request& request, Response& response) {
      lower_priority();
      set_headers(response);
      return admit(request, response) ? httplib::Server::HandlerResponse::Unhandled
                                      : httplib::Server::HandlerResponse::Handled;
    });
    route();
  }
  ~Server() override {
    {
      const std::scoped_lock lock(mutex_);
      stopping_ = true;
    }
    stop_.notify_all();
    server_.stop();
    if (thread_.joinable()) thread_.join();
  }

  std::optional<std::string> listen(int port) {
    const auto bound = [this](int wanted) { return server_.bind_to_port(address_, wanted); };
    port_ = port > 0 ? port : kUsualPort;
    if (!bound(port_)) {
      if (port > 0)
        return "port " + std::to_string(port) + " of " + address_ +
               " is not free; choose another with --port";
      port_ = server_.bind_to_any_port(address_);
    }
    if (port_ <= 0) return "cannot listen on " + address_ + ": is it an address of this host?";
    thread_ = std::thread([this] {
      lower_priority();
      server_.listen_after_bind();
    });
    while (!server_.is_running()) std::this_thread::sleep_for(1ms);
    return {};
  }

  std::string url() const override {
    const bool anywhere = address_ == "0.0.0.0" || address_ == "::";
    std::string host = anywhere ? own_name() : address_;
    if (host.find(':') != host.npos) host = '[' + host + ']';
    const std::string base = "http://" + host + ':' + std::to_string(port_) + '/';
    return token_.empty() ? base : base + "?token=" + token_;
  }

 private:
  void set_headers(Response& response) const {
    response.set_header("Content-Security-Policy", content_.policy + "; frame-ancestors 'none'");
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("X-Frame-Options", "DENY");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header("Cross-Origin-Resource-Policy", "same-origin");
    response.set_header("Cross-Origin-Opener-Policy", "same-origin");
    response.set_header("Cache-Control", "no-store");
  }

  bool our_name(const std::string& host) const {
    const std::string name = name_in(host), port = host.substr(name.size());
    if (port != ':' + std::to_string(port_) && !(port.empty() && port_ == 80)) return false;
    if (token_.empty()) return name == "127.0.0.1" || name == "localhost";
    return name == "localhost" || name == address_ || name == own_name() || is_address(name);
  }

  /// Whether the request passes; if not, the answer says why.
  bool admit(const Request& request, Response& response) const {
    if (request.method != "GET") return refuse(response, 405, "only GET");
    if (request.target.size() > kLongest) return refuse(response, 414, "too long");
    const std::string host = request.get_header_value("Host");
    if (request.get_header_value_count("Host") != 1 || !our_name(host)) {
      return refuse(response, 421, "this server does not have that name");
    }
    const std::string site = request.get_header_value("Sec-Fetch-Site");
    const bool navigates =
        request.path == "/" && request.get_header_value("Sec-Fetch-Mode") == "navigate";
    if (!site.empty() && site != "same-origin" && site != "none" && !navigates) {
      return refuse(response, 403, "not for other sites");
    }
    if (request.has_header("Origin") && request.get_header_value("Origin") != "http://" + host) {
      return refuse(response, 403, "not for other sites");
    }
    return token_.empty() || knows_token(request, response);
  }

  bool knows_token(const Request& request, Response& response) const {
    const std::string name = "ergocast-" + std::to_string(port_);
    if (request.path == "/" && same(request.get_param_value("token"), token_)) {
      response.set_header("Set-Cookie",
                          name + '=' + token_ + "; HttpOnly; SameSite=Strict; Path=/");
      response.set_redirect("/", 303);  // the address bar shows it no more
      return false;
    }
    const std::string cookies = "; " + request.get_header_value("Cookie") + ';',
                      begin = "; " + name + '=';
    const auto at = cookies.find(begin);
    if (at != cookies.npos) {
      const auto value = at + begin.size();
      if (same(cookies.substr(value, cookies.find(';', value) - value), token_)) return true;
    }
    return refuse(response, 403, "open the address that was printed, with its token");
  }

  void route() {
    server_.Get("/", [this](const Request&, Response& response) {
      response.set_content(content_.page(), "text/html; charset=utf-8");
    });
    server_.Get("/record.json", [this](const Request&, Response& response) {
      const auto record = content_.record ? content_.record() : std::nullopt;
      if (!record) {
        refuse(response, 404, "there is no record yet");
        return;
      }
      response.set_content(*record, "application/json");
    });
    server_.Get("/events", [this](const Request&, Response& response) {
      if (!content_.events) {
        refuse(response, 404, "there are no events");
        return;
      }
      if (++streams_ > kMostStreams) {
        --streams_;
        refuse(response, 503, "too many browsers watch already");
        return;
      }
      response.set_chunked_content_provider(
          "text/event-stream",
          [this, next = content_.events(), quiet = 0](
              std::size_t, httplib::DataSink& sink) mutable { return send(next, quiet, sink); },
          [this](bool) { --streams_; });
    });
  }

  /// Sends what is new, or waits a moment. A browser that takes nothing for 5 s is let go.
  bool send(Stream& next, int& quiet, httplib::DataSink& sink) {
    auto text = next();
    if (!text) {
      sink.done();
      return true;
    }
    if (text->empty() && ++quiet >= kHeartbeat) *text = ":\n\n";
    if (!text->empty()) {
      quiet = 0;
      if (!sink.write(text->data(), text->size())) return false;
    }
    std::unique_lock lock(mutex_);
    return !stop_.wait_for(lock, kTurn, [this] { return stopping_; });
  }

  std::string address_, token_;
  Content content_;
  httplib::Server server_;
  int port_ = 0;
  std::atomic<int> streams_ = 0;
  std::mutex mutex_;
  std::condition_variable stop_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace

void lower_priority() {
  static thread_local bool lowered = false;
  if (!std::exchange(lowered, true)) {
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), 10);
  }
}

std::variant<std::unique_ptr<PageServer>, std::string> PageServer::start(const Options& options,
                                                                         Content content) {
  auto server = std::make_unique<Server>(options, std::move(content));
  if (auto problem = server->listen(options.port)) return std::move(*problem);
  return std::unique_ptr<PageServer>(std::move(server));
}

}  // namespace ergocast::cli
