// SPDX-License-Identifier: BSD-3-Clause
// --foxglove of `ergocast watch` and `run`: a real team read by Foxglove's own client, slow
// clients, and clients that try to harm it.
#include <arpa/inet.h>

#include <map>
#include <memory>
#include <set>

#include "runtime/bus/socket.h"
#include "tests/cli/foxglove/client_frames.h"
#include "tests/process/support/mission.h"
#include "tests/support/http.h"
#include "tests/support/tls.h"

namespace ergocast::test {
namespace {

using nlohmann::json;

constexpr int kPort = 8901;
const std::string kAddress = "ws://127.0.0.1:8901/";
const std::string kKey = "dGhlIHNhbXBsZSBub25jZQ==";

/// The request of a client, with other header lines in the place of those of the same name.
std::string handshake(const std::map<std::string, std::string>& others = {},
                      const std::string& target = "/") {
  std::map<std::string, std::string> headers{
      {"Host", "127.0.0.1:8901"},  {"Connection", "Upgrade"},
      {"Upgrade", "websocket"},    {"Sec-WebSocket-Version", "13"},
      {"Sec-WebSocket-Key", kKey}, {"Sec-WebSocket-Protocol", "foxglove.websocket.v1"}};
  for (const auto& [name, value] : others) headers[name] = value;
  std::string text = "GET " + target + " HTTP/1.1\r\n";
  for (const auto& [name, value] : headers)
    if (!value.empty()) text += name + ": " + value + "\r\n";
  return text + "\r\n";
}

/// A client that reads only in reads() and reads_until().
class RawClient {
 public:
  explicit RawClient(const std::string& request = handshake()) : socket_(AF_INET, SOCK_STREAM) {
    const int small = 4096;
    setsockopt(socket_.fd(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    const timeval patience{300, 0};
    setsockopt(socket_.fd(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    const sockaddr_in to = address_of("127.0.0.1", kPort);
    EXPECT_EQ(connect(socket_.fd(), reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    send(request);
  }
  void send(const std::string& bytes) const {
    ::send(socket_.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  void send_json(const json& message) const { send(client_frame(1, message.dump())); }
  void subscribe_to_all(int channels) const {
    json request = {{"op", "subscribe"}};
    for (int id = 1; id <= channels; ++id)
      request["subscriptions"].push_back({{"id", id}, {"channelId", id}});
    send_json(request);
  }
  /// Reads until a frame has that text; false if the connection ends before.
  bool reads(const std::string& part) {
    const auto has_it = [&](const ServerFrame& frame) {
      return frame.payload.find(part) != frame.payload.npos;
    };
    return reads_until(has_it);
  }
  bool reads_until(const std::function<bool(const ServerFrame&)>& enough) {
    for (;;) {
      if (head_.empty() && in_.find("\r\n\r\n") != in_.npos) {
        head_ = in_.substr(0, in_.find("\r\n\r\n") + 4);
        in_.erase(0, head_.size());
      }
      if (!head_.empty()) {
        for (const ServerFrame& frame : take_frames(in_))
          if (enough(frame)) return true;
      }
      char bytes[65536];
      const ssize_t count = recv(socket_.fd(), bytes, sizeof bytes, 0);
      if (count <= 0) return false;
      in_.append(bytes, static_cast<std::size_t>(count));
    }
  }
  /// As the team's displays name it.
  std::string name() const {
    sockaddr_in own{};
    socklen_t size = sizeof own;
    getsockname(socket_.fd(), reinterpret_cast<sockaddr*>(&own), &size);
    return "Foxglove client 127.0.0.1:" + std::to_string(ntohs(own.sin_port));
  }
  /// Reads to the end of the connection; the code of the frame that closes it, 0: none.
  int close_code() {
    int code = 0;
    reads_until([&](const ServerFrame& frame) {
      if (frame.opcode == 8 && frame.payload.size() >= 2)
        code = static_cast<unsigned char>(frame.payload[0]) << 8 |
               static_cast<unsigned char>(frame.payload[1]);
      return false;
    });
    return code;
  }

 private:
  Socket socket_;
  std::string in_, head_;
};

class ShownInFoxglove : public RunningMission {
 protected:
  std::filesystem::path there() {
    const auto file = scenario("", "random_count: 4");
    std::ofstream(file, std::ios::app) << "\norigin { latitude_deg: 47.5 longitude_deg: 9.2 }\n";
    return file;
  }
  Child watch(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"watch", "--foxglove", std::to_string(kPort)};
    words.insert(words.end(), more.begin(), more.end());
    Child child = start("ergocast", words);
    watch_log_ = log_;
    EXPECT_TRUE(
        eventually([&] { return shown().find("in a browser") != std::string::npos; }, child.pid()))
        << shown();
    return child;
  }
  std::string shown() const { return text_of(watch_log_); }
  /// The address that was printed for other hosts; empty if none was.
  std::string url_with_token() const {
    const std::string text = shown(), begin = "connect Foxglove to ";
    const auto at = text.find(begin + "wss://127.0.0.1:8901/?token=");
    if (at == text.npos) return "";
    return text.substr(at + begin.size(), text.find('\n', at) - at - begin.size());
  }
  bool shows(const std::string& part) const {
    return eventually([&] { return shown().find(part) != std::string::npos; });
  }
  /// Foxglove's client reads all topics; their last values, by topic. The topic `silent` may have
  /// none.
  std::map<std::string, json> read(const std::string& url = kAddress,
                                   const std::string& silent = "/amendments",
                                   const std::string& protocol = "foxglove.websocket.v1") {
    Child reader = begin({"/usr/bin/env", "node",
                          ERGOCAST_SOURCE_DIR "/tests/cli/foxglove/client/read_team.cjs",
                          ERGOCAST_FOXGLOVE_CLIENT, url, "5", protocol, silent});
    const auto log = log_;
    EXPECT_EQ(wait_for(reader), 0) << text_of(log) << shown();
    std::map<std::string, json> topics;
    std::istringstream lines(text_of(log));
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with('{')) continue;
      const json topic = json::parse(line);
      topics[topic["topic"]] = topic;
    }
    return topics;
  }
  void end(Child& child) {
    child.send(SIGINT);
    EXPECT_EQ(wait_for(child), 0) << shown();
  }
  /// The most memory of the process so far.
  static double peak_mib(pid_t pid) {
    const std::string status = text_of("/proc/" + std::to_string(pid) + "/status");
    const std::string name = "VmHWM:";
    return std::stod(status.substr(status.find(name) + name.size())) / 1024;
  }

  std::filesystem::path watch_log_;
};

TEST_F(ShownInFoxglove, HasTheTopicsAndSchemasOfAnExport) {
  Child mission = launch_endless(there(), {"--realtime=10"});
  Child server = watch();
  EXPECT_NE(shown().find("connect Foxglove to " + kAddress + '\n'), std::string::npos) << shown();
  ASSERT_EQ(ergocast({"pause"}), 0) << output();
  ASSERT_EQ(ergocast({"resume"}), 0) << output();
  auto topics = read(kAddress, "none");
  ASSERT_EQ(topics.size(), 5U + 2 * 8);
  for (const auto& [name, topic] : topics) {
    const json& value = topic["value"];
    if (name.ends_with("/pose")) {
      EXPECT_EQ(topic["schema"], "foxglove.PoseInFrame");
      EXPECT_GE(value["pose"]["position"]["x"], 0) << name;
      EXPECT_LE(value["pose"]["position"]["x"], 2000) << name;
    } else if (name.ends_with("/location")) {
      EXPECT_NEAR(value["latitude"], 47.509, 0.0091) << name;
      EXPECT_NEAR(value["longitude"], 9.2133, 0.0134) << name;
    }
  }
  EXPECT_GT(topics["/metrics"]["value"]["ergodic_metric"], 0);
  EXPECT_GT(topics["/metrics"]["value"]["detection_probability"], 0);
  EXPECT_EQ(topics["/target"]["count"], 1);
  EXPECT_NE(topics["/amendments"].dump().find("amendment "), std::string::npos);
  EXPECT_TRUE(shows("Foxglove client 127.0.0.1:"));
  EXPECT_TRUE(shows(" has left"));
  // Another subprotocol, and the same.
  EXPECT_EQ(read(kAddress, "none", "foxglove.sdk.v1").size(), topics.size());
  end(server);
  end(mission);

  ASSERT_EQ(ergocast({"export", out(), "--to", "mcap"}), 0) << output();
  const std::string file = text_of(out() / "export.mcap");
  for (const auto& [name, topic] : topics) {
    EXPECT_NE(file.find(name), std::string::npos) << name;
    EXPECT_NE(file.find(topic["text"].get<std::string>()), std::string::npos) << name;
  }
  // The layout that we ship names no other topics, and opens both.
  const std::string layout = text_of(ERGOCAST_SOURCE_DIR "/report/export/foxglove_layout.json");
  const json panels = json::parse(layout);
  std::set<std::string> named;
  for (auto at = layout.find("\"/"); at != layout.npos; at = layout.find("\"/", at + 1)) {
    const auto end = layout.find_first_of(".\"", at + 1);
    named.insert(layout.substr(at + 1, end - at - 1));
  }
  for (const std::string& name : named) EXPECT_TRUE(topics.contains(name)) << name;
  for (const char* topic : {"/target", "/coverage", "/metrics", "/log", "/agents/0/pose"})
    EXPECT_TRUE(named.contains(topic)) << topic;
  for (const auto& [panel, config] : panels["configById"].items())
    EXPECT_NE(panels["layout"].dump().find('"' + panel + '"'), std::string::npos) << panel;
}

TEST_F(ShownInFoxglove, LosesMessagesOfASlowClientAndNothingElse) {
  Child mission = launch_endless(there(), {"--realtime=10"});
  Child server = watch();
  RawClient slow;
  ASSERT_TRUE(slow.reads("/agents/7/location"));
  // Everybody reads its name, and the record keeps it.
  const std::string name = slow.name();
  ASSERT_TRUE(shows(name + " is connected")) << shown();
  ASSERT_EQ(ergocast({"status", "--json"}), 0) << output();
  EXPECT_EQ(json::parse(output())["clients"], json{name});
  ASSERT_EQ(ergocast({"status"}), 0) << output();
  EXPECT_NE(output().find("shown to  " + name + '\n'), std::string::npos) << output();
  HttpConnection page(8765);
  page.send("GET /events HTTP/1.1\r\nHost: 127.0.0.1:8765\r\n\r\n");
  page.read_until(
      [&](const std::string& got) { return got.find("\"clients\":[\"" + name + '"') != got.npos; });
  slow.subscribe_to_all(5 + 2 * 8);
  ASSERT_TRUE(slow.reads("\"position\""));
  // From now on it reads nothing, until the server has noticed.
  ASSERT_TRUE(shows("is too slow, and loses messages")) << shown();
  const double before_mib = peak_mib(server.pid());
  const auto bytes = recorded_bytes();
  ASSERT_EQ(read().size(), 5U + 2 * 8);
  EXPECT_TRUE(moves_on(60000)) << printed();
  EXPECT_GT(recorded_bytes(), bytes);
  EXPECT_LT(peak_mib(server.pid()) - before_mib, 32);
  // It reads again: first what the kernel has kept, then that it has lost some, then the present.
  ASSERT_TRUE(slow.reads("messages were left out"));
  ASSERT_TRUE(slow.reads("\"position\""));
  end(server);
  EXPECT_EQ(shown().find("is too slow"), shown().rfind("is too slow")) << shown();
  end(mission);
  const std::string log = text_of(out() / "log/watch.log");
  EXPECT_NE(log.find(" info watch: " + name + " is connected\n"), std::string::npos) << log;
  EXPECT_NE(log.find(" info watch: browser 127.0.0.1:"), std::string::npos) << log;
}

TEST_F(ShownInFoxglove, StandsHostileClients) {
  Child mission = launch_endless(there(), {"--realtime=10"});
  Child server = watch();
  const auto status = [&](const std::string& request) {
    HttpConnection connection(kPort);
    connection.send(request);
    const std::string& text = connection.read_until(
        [](const std::string& got) { return got.find("\r\n\r\n") != got.npos; });
    return text.starts_with("HTTP/1.1 ") ? std::atoi(text.c_str() + 9) : 0;
  };
  EXPECT_EQ(status(handshake()), 101);
  EXPECT_EQ(status(handshake({{"Origin", "https://app.foxglove.dev"}})), 101);
  EXPECT_EQ(status(handshake({{"Origin", "http://localhost:8080"}})), 101);
  EXPECT_EQ(status(handshake({{"Sec-WebSocket-Protocol", "x, foxglove.sdk.v1"}})), 101);
  EXPECT_EQ(status(handshake({{"Origin", "https://example.org"}})), 403);
  EXPECT_EQ(status(handshake({{"Origin", "http://localhost.example.org"}})), 403);
  EXPECT_EQ(status(handshake({{"Origin", "null"}})), 403);
  EXPECT_EQ(status(handshake({{"Host", "example.org:8901"}})), 421);
  EXPECT_EQ(status(handshake({{"Sec-WebSocket-Protocol", ""}})), 400);
  EXPECT_EQ(status(handshake({{"Sec-WebSocket-Protocol", "mqtt"}})), 400);
  EXPECT_EQ(status(handshake({{"Sec-WebSocket-Key", "short"}})), 426);
  EXPECT_EQ(status(handshake({{"Sec-WebSocket-Version", "8"}})), 426);
  EXPECT_EQ(status(handshake({{"Upgrade", ""}})), 426);
  EXPECT_EQ(status("GET / HTTP/1.0\r\n\r\n"), 400);
  EXPECT_EQ(status(std::string("\x16\x03\x01\x00\xff\r\n\r\n", 9)), 400);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nX: " + std::string(20000, 'x')), 431);

  EXPECT_EQ((RawClient(handshake() + std::string("\x81\x01x", 3)).close_code()), 1002);
  EXPECT_EQ((RawClient(handshake() + client_frame(1, std::string(65537, ' '))).close_code()), 1009);
  EXPECT_EQ(RawClient(handshake() + client_frame(8, "\x03\xe8")).close_code(), 1000);
  RawClient bad;
  json many = {{"op", "subscribe"}};
  for (int i = 0; i < 2000; ++i) many["subscriptions"].push_back({{"id", i}, {"channelId", i}});
  for (int i = 0; i < 50; ++i) {
    bad.send_json(many);
    bad.send(client_frame(1, std::string(60000, '[')));
    bad.send(client_frame(1, "{\"op\":"));
    bad.send(client_frame(2, std::string(60000, '\1')));
  }
  EXPECT_TRUE(bad.reads("there is no channel"));
  // Half-open ones: requests that never end, and clients that read nothing and send nothing.
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 40; ++i) {
    idle.push_back(std::make_unique<RawClient>("GET / HTTP/1.1\r\nHost: "));
    idle.push_back(std::make_unique<RawClient>());
  }
  EXPECT_EQ(read().size(), 5U + 2 * 8);
  EXPECT_TRUE(moves_on(60000)) << printed();
  EXPECT_LT(peak_mib(server.pid()), 400);
  EXPECT_LT(shown().size(), 20000U);  // the terminal is not flooded
  end(server);
  end(mission);
}

TEST_F(ShownInFoxglove, NeedsATokenOnOtherAddressesAndHasTls) {
  Child mission = launch_endless(there(), {"--realtime=10"});
  const auto [certificate, key] = make_certificate(folder_, "page");
  Child server = watch({"--listen", "127.0.0.1", "--tls-cert", certificate, "--tls-key", key});
  const std::string url = url_with_token();
  ASSERT_NE(url, "") << shown();
  EXPECT_EQ(read(url).size(), 5U + 2 * 8);
  const auto status = [&](const std::string& target) {
    HttpsConnection connection(kPort);
    connection.send(handshake({}, target));
    const std::string& text = connection.read_until(
        [](const std::string& got) { return got.find("\r\n\r\n") != got.npos; });
    return text.starts_with("HTTP/1.1 ") ? std::atoi(text.c_str() + 9) : 0;
  };
  EXPECT_EQ(status("/"), 403);
  EXPECT_EQ(status("/?token=" + std::string(32, '0')), 403);
  EXPECT_EQ(status(url.substr(url.find("/?"))), 101);
  end(server);
  end(mission);
}

/// The page's process serves Foxglove, too. If it is killed, its successor does, at the same
/// address.
TEST_F(ShownInFoxglove, BesideThePageOfARun) {
  Child mission =
      launch_endless(there(), {"--realtime=10", "--watch", "--foxglove", std::to_string(kPort)});
  EXPECT_TRUE(printed("  foxglove " + kAddress + '\n')) << printed();
  EXPECT_EQ(read().size(), 5U + 2 * 8);
  {
    RawClient client;
    ASSERT_TRUE(client.reads("/agents/7/location"));
    const json names{client.name()};
    EXPECT_TRUE(eventually([&] {
      return ergocast({"status", "--json"}) == 0 && json::parse(output())["clients"] == names;
    })) << output();
    EXPECT_TRUE(logs("page", client.name() + " is connected")) << log_of("page");
  }
  kill_next({"ergocast run-page"});
  EXPECT_EQ(read().size(), 5U + 2 * 8);
  EXPECT_TRUE(moves_on(60000)) << printed();
  mission.send(SIGINT);
  ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); }, mission.pid())) << printed();
  end(mission);
  EXPECT_TRUE(logs("page", "Foxglove client 127.0.0.1:")) << log_of("page");
}

TEST_F(ShownInFoxglove, BesideAPageWithControlAndItsToken) {
  Child mission = launch_endless(there(), {"--realtime=10"});
  const auto [certificate, key] = make_certificate(folder_, "page");
  Child server =
      watch({"--control", "--listen", "127.0.0.1", "--tls-cert", certificate, "--tls-key", key});
  const std::string url = url_with_token();
  ASSERT_NE(url, "") << shown();
  EXPECT_EQ(read(url).size(), 5U + 2 * 8);
  kill_next({"ergocast run-page"});
  EXPECT_EQ(read(url).size(), 5U + 2 * 8);
  HttpsConnection connection(kPort);
  connection.send(handshake());
  EXPECT_TRUE(
      connection.read_until([](const std::string& got) { return got.find("\r\n\r\n") != got.npos; })
          .starts_with("HTTP/1.1 403"));
  end(server);
  end(mission);
}

TEST_F(ShownInFoxglove, NamesWhatIsWrongWithAPort) {
  for (const char* wrong : {"0", "70000", "-1", "x"}) {
    EXPECT_EQ(ergocast({"watch", "--foxglove", wrong}), 2) << wrong;
    EXPECT_TRUE(answered("--foxglove")) << output();
  }
  EXPECT_EQ(ergocast({"watch", "--foxglove", "8901", "--port", "8901"}), 2);
  EXPECT_TRUE(answered("--foxglove and --port name the same port, 8901")) << output();
  EXPECT_EQ(ergocast({"run", there(), "--foxglove", "8901"}), 2);
  EXPECT_TRUE(answered("--foxglove requires --watch")) << output();
  Child server = watch();
  EXPECT_EQ(ergocast({"run", there(), "--watch", "--foxglove", "8901", "--out", out()}), 3);
  EXPECT_TRUE(answered("port 8901 of 127.0.0.1 is not free; choose another with --foxglove"))
      << output();
  EXPECT_EQ(ergocast({"watch", "--foxglove", "8901"}), 3);
  EXPECT_TRUE(answered("port 8901 of 127.0.0.1 is not free; choose another with --foxglove"))
      << output();
  end(server);
}

}  // namespace
}  // namespace ergocast::test
