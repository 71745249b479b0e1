// SPDX-License-Identifier: BSD-3-Clause
// cpp-httplib reads a request's head from memory and writes the answer's head to memory. (Its own
// server needs a thread for each client, and limits neither the number of headers nor their time.)
// The guard checks each request first.
#include "cli/watch/page_server.h"

#include <httplib.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace ergocast::cli {
namespace {

using httplib::Request;
using httplib::Response;

/// Limit (Page): length of the address that a browser asks for [bytes]. Beyond it: the answer is
/// 414.
constexpr std::size_t kLongest = 1024;  // of a request's target

/// The headers of a request of an operator. A page of another origin cannot set them.
constexpr const char* kTokenHeader = "X-Ergocast-Token";
constexpr const char* kRequestHeader = "X-Ergocast-Request";

/// Always returns false, so that a check can return its result.
bool refuse(Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(why + "\n", "text/plain; charset=utf-8");
  return false;
}

/// Removes the headers that request parts of an answer. Answers are always sent whole, because
/// cpp-httplib would copy the page once for each part.
std::string without_ranges(const std::string& head) {
  std::string kept;
  for (std::size_t begin = 0, end = 0; begin < head.size(); begin = end) {
    end = std::min(head.find('\n', begin), head.size() - 1) + 1;
    if (strncasecmp(head.c_str() + begin, "range:", 6) != 0) kept.append(head, begin, end - begin);
  }
  return kept;
}

/// Stands for a connection in cpp-httplib; reads and writes memory.
class Exchange final : public httplib::Stream {
 public:
  explicit Exchange(std::string request) : request_(std::move(request)) {}

  std::string take_answer() { return std::move(answer_); }

  bool is_readable() const override { return read_ < request_.size(); }
  bool is_writable() const override { return true; }
  ssize_t read(char* to, std::size_t size) override {
    const std::size_t count = request_.copy(to, size, read_);
    read_ += count;
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* from, std::size_t size) override {
    answer_.append(from, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return INVALID_SOCKET; }

 private:
  std::string request_, answer_;
  std::size_t read_ = 0;
};

/// Never listens.
class Protocol final : public httplib::Server {
 public:
  void process(Exchange& exchange) { process(*this, exchange); }

 private:
  /// A template, so that one call of the two compiles: since cpp-httplib 0.17 it also takes the
  /// addresses of both ends, which nothing here reads.
  template <typename Self>
  static void process(Self& self, Exchange& exchange) {
    bool closed = false;
    if constexpr (requires { self.process_request(exchange, true, closed, {}); }) {
      self.process_request(exchange, true, closed, {});
    } else {
      self.process_request(exchange, {}, 0, {}, 0, true, closed, {});
    }
  }
};

class Server final : public PageServer {
 public:
  Server(PageSocket socket, Content content)
      : socket_(std::move(socket)),
        content_(std::move(content)),
        connections_(
            socket_.fd(), [this](const std::string& head) { return answer(head); },
            [this](Socket accepted) { return socket_.stream(std::move(accepted)); }) {
    protocol_.set_pre_routing_handler([this](const Request& request, Response& response) {
      set_headers(response);
      return admit(request, response) ? httplib::Server::HandlerResponse::Unhandled
                                      : httplib::Server::HandlerResponse::Handled;
    });
    route();
  }

  int fd() const override { return connections_.fd(); }
  void serve(Instant now) override { connections_.serve(now); }
  std::vector<std::string> clients() const override {
    std::vector<std::string> names;
    for (const std::string& peer : connections_.peers()) names.push_back("browser " + peer);
    return names;
  }

 private:
  Connections::Answer answer(const std::string& head) {
    Exchange exchange(without_ranges(head));
    answer_ = {};
    protocol_.process(exchange);
    answer_.head = exchange.take_answer();
    return std::move(answer_);
  }

  /// Strict-Transport-Security is not set. It would hold for all ports of this host's name, and for
  /// longer than the mission: a browser would no longer open other servers of the host by http.
  void set_headers(Response& response) const {
    response.set_header("Content-Security-Policy", content_.policy + "; frame-ancestors 'none'");
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("X-Frame-Options", "DENY");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header("Cross-Origin-Resource-Policy", "same-origin");
    response.set_header("Cross-Origin-Opener-Policy", "same-origin");
    response.set_header("Cache-Control", "no-store");
  }

  /// Whether the request passes; if not, the answer contains the reason.
  bool admit(const Request& request, Response& response) const {
    const bool orders = request.method == "POST" && request.path == "/control" && content_.control;
    if (request.method != "GET" && !orders) return refuse(response, 405, "only GET");
    if (request.target.size() > kLongest) return refuse(response, 414, "too long");
    const std::string host = request.get_header_value("Host");
    if (request.get_header_value_count("Host") != 1 || !socket_.is_called(host)) {
      return refuse(response, 421, "this server does not have that name");
    }
    const std::string site = request.get_header_value("Sec-Fetch-Site");
    const bool navigates =
        request.path == "/" && request.get_header_value("Sec-Fetch-Mode") == "navigate";
    if (!site.empty() && site != "same-origin" && site != "none" && !navigates) {
      return refuse(response, 403, "not for other sites");
    }
    if (request.has_header("Origin") &&
        request.get_header_value("Origin") != socket_.origin(host)) {
      return refuse(response, 403, "not for other sites");
    }
    if (orders && !may_order(request, response)) return false;
    return socket_.token().empty() || knows_token(request, response);
  }

  /// A browser names the origin of each POST. The token comes as a header and never as a cookie,
  /// because a cookie is sent to every port of a host.
  bool may_order(const Request& request, Response& response) const {
    if (!request.has_header("Origin")) return refuse(response, 403, "not for other sites");
    if (same_secret(request.get_header_value(kTokenHeader), content_.control_token)) return true;
    return refuse(response, 403, "open the address that was printed, with all that follows #");
  }

  bool knows_token(const Request& request, Response& response) const {
    const std::string name = "ergocast-" + std::to_string(socket_.port());
    const std::string& token = socket_.token();
    if (request.path == "/" && same_secret(request.get_param_value("token"), token)) {
      response.set_header("Set-Cookie", name + '=' + token + "; HttpOnly; SameSite=Strict; Path=/" +
                                            (socket_.encrypted() ? "; Secure" : ""));
      response.set_redirect("/", 303);  // removes the token from the address bar
      return false;
    }
    const std::string cookies = "; " + request.get_header_value("Cookie") + ';',
                      begin = "; " + name + '=';
    const auto at = cookies.find(begin);
    if (at != cookies.npos) {
      const auto value = at + begin.size();
      if (same_secret(cookies.substr(value, cookies.find(';', value) - value), token)) return true;
    }
    return refuse(response, 403, "open the address that was printed, with its token");
  }

  void route() {
    protocol_.Get("/", [this](const Request&, Response& response) {
      send(response, content_.page(), "text/html; charset=utf-8");
    });
    protocol_.Get("/record.json", [this](const Request&, Response& response) {
      auto record = content_.record ? content_.record() : nullptr;
      if (!record) {
        refuse(response, 404, "there is no record yet");
        return;
      }
      send(response, std::move(record), "application/json");
    });
    protocol_.Post("/control", [this](const Request& request, Response& response) {
      pass_on(request, response);
    });
    protocol_.Get("/events", [this](const Request&, Response& response) {
      if (!content_.events) {
        refuse(response, 404, "there are no events");
        return;
      }
      answer_.stream = content_.events();
      // No length: the answer ends with the connection.
      response.set_content_provider("text/event-stream",
                                    [](std::size_t, httplib::DataSink&) { return false; });
    });
  }

  void pass_on(const Request& request, Response& response) {
    const std::string text = request.get_header_value(kRequestHeader);
    const auto order = ControlRequest::parse(text);
    if (!order) {
      refuse(response, 400, "no request of an operator");
    } else if (!content_.control(*order, text)) {
      refuse(response, 503,
             "no order can be given now: the mission is over, there are too many requests, or the "
             "process that gives orders does not answer");
    } else {
      response.status = 202;
    }
  }

  /// The text follows the head that cpp-httplib writes. It does not pass through cpp-httplib, so
  /// that all browsers share one copy.
  void send(Response& response, Connections::Text text, const char* type) {
    response.set_content_provider(
        text->size(), type, [](std::size_t, std::size_t, httplib::DataSink&) { return false; });
    answer_.body = std::move(text);
  }

  PageSocket socket_;
  Content content_;
  Protocol protocol_;
  Connections::Answer answer_;  // the one that is being made
  Connections connections_;
};

}  // namespace

std::unique_ptr<PageServer> PageServer::make(PageSocket socket, Content content) {
  return std::make_unique<Server>(std::move(socket), std::move(content));
}

}  // namespace ergocast::cli
