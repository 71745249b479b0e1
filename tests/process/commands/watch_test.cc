// SPDX-License-Identifier: BSD-3-Clause
// `ergocast watch` and `run --watch` under attacks by other programs and other sites' pages.
// tests/page tests them in a browser.
#include <unistd.h>

#include <memory>

#include "tests/process/support/mission.h"
#include "tests/support/http.h"

namespace ergocast::test {
namespace {

constexpr int kPort = 8765;

class WatchedPage : public ByHand {
 protected:
  /// A record that is served.
  void serve_record(const std::vector<std::string>& more = {}) {
    ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "5",
                        "--out", out()}),
              0);
    std::vector<std::string> arguments{"watch", out()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    serve(arguments);
  }
  void serve(const std::vector<std::string>& arguments) {
    server_.emplace(start("ergocast", arguments));
    printed_ = log_;
    ASSERT_TRUE(eventually([&] { return text_of(printed_).find("Ctrl-C") != std::string::npos; }))
        << text_of(printed_);
  }
  void end_server(int exit_code = 0) {
    server_->send(SIGINT);
    EXPECT_EQ(wait_for(*server_), exit_code) << text_of(printed_);
  }
  /// The token that was printed.
  std::string token() const {
    const std::string text = text_of(printed_), begin = "?token=";
    const auto at = text.find(begin) + begin.size();
    return text.substr(at, text.find_first_of(" ,\n", at) - at);
  }
  static std::string host(const std::string& name) { return "Host: " + name; }

  std::optional<Child> server_;
  std::filesystem::path printed_;
};

TEST_F(WatchedPage, ARecordIsServedUntilCtrlC) {
  serve_record();
  EXPECT_NE(text_of(printed_).find("http://127.0.0.1:8765/"), std::string::npos);
  const HttpAnswer page = get(kPort, "/");
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.body.find("quadrimodal_corners"), std::string::npos);
  EXPECT_EQ(get(kPort, "/record.json").status, 404);  // the page has it inside
  EXPECT_EQ(get(kPort, "/events").status, 404);
  end_server();
}

TEST_F(WatchedPage, NamesThatAreNotOursAreRefused) {
  serve_record();
  for (const char* name : {"evil.example:8765", "evil.example", "127.0.0.1", "127.0.0.1:80",
                           "127.0.0.1.evil.example:8765", "localhost:8765.evil.example", "",
                           "10.0.0.1:8765", "127.0.0.1:8765@evil.example"}) {
    EXPECT_EQ(http(kPort, "GET", "/", {host(name)}).status, 421) << name;
  }
  EXPECT_EQ(http(kPort, "GET", "/", {}).status, 421);
  EXPECT_EQ(http(kPort, "GET", "/", {host("127.0.0.1:8765"), host("evil.example")}).status, 421);
  EXPECT_EQ(http(kPort, "GET", "/", {host("localhost:8765")}).status, 200);
  end_server();
}

// Another host of the network could resolve that name to this address.
TEST_F(WatchedPage, TheHostsNameIsRefusedWhereOnlyThisHostReachesThePage) {
  ASSERT_EQ(sethostname("survey-desk", 11), 0);  // of this test's separate host
  serve_record();
  EXPECT_EQ(http(kPort, "GET", "/", {host("survey-desk:8765")}).status, 421);
  end_server();
  serve({"watch", out(), "--listen", "127.0.0.2", "--port", "8801"});
  const auto known =
      http(8801, "GET", "/?token=" + token(), {host("survey-desk:8801")}, "", "127.0.0.2");
  EXPECT_EQ(known.status, 303);
  end_server();
}

TEST_F(WatchedPage, OtherSitesGetNothingAndNoLeaveToRead) {
  serve_record();
  EXPECT_EQ(get(kPort, "/", {"Origin: http://evil.example"}).status, 403);
  EXPECT_EQ(get(kPort, "/", {"Origin: null"}).status, 403);
  for (const char* site : {"cross-site", "same-site"}) {
    const std::string header = std::string("Sec-Fetch-Site: ") + site;
    EXPECT_EQ(get(kPort, "/events", {header}).status, 403);
    EXPECT_EQ(get(kPort, "/record.json", {header, "Sec-Fetch-Mode: navigate"}).status, 403);
    EXPECT_EQ(get(kPort, "/", {header, "Sec-Fetch-Mode: no-cors"}).status, 403);
  }
  const HttpAnswer page = get(kPort, "/", {"Origin: http://127.0.0.1:8765"});
  EXPECT_EQ(page.status, 200);
  EXPECT_FALSE(page.contains("Access-Control")) << page.head;
  for (const char* header : {"Content-Security-Policy: default-src 'none'; script-src 'sha256-",
                             "frame-ancestors 'none'", "X-Content-Type-Options: nosniff",
                             "Cross-Origin-Resource-Policy: same-origin",
                             "Referrer-Policy: no-referrer", "Cache-Control: no-store"}) {
    EXPECT_TRUE(page.contains(header)) << header << " is not in\n" << page.head;
  }
  EXPECT_FALSE(page.contains("unsafe"));
  end_server();
}

TEST_F(WatchedPage, OnlyReads) {
  serve_record();
  for (const char* method : {"POST", "PUT", "DELETE", "PATCH", "OPTIONS", "HEAD"}) {
    EXPECT_EQ(http(kPort, method, "/", {host("127.0.0.1:8765")}).status, 405) << method;
    EXPECT_EQ(http(kPort, method, "/events", {host("127.0.0.1:8765")}, "stop").status, 405)
        << method;
  }
  for (const char* target : {"/../scenario.textproto", "/%2e%2e/plan.binpb", "//etc/passwd",
                             "/summary.json", "/log/sim.log", "/favicon.ico"}) {
    EXPECT_EQ(get(kPort, target).status, 404) << target;
  }
  EXPECT_EQ(get(kPort, "/?" + std::string(4000, 'x')).status, 414);
  // Input that is no HTTP does not end it.
  HttpConnection(kPort).send(std::string("\0\xff\r\n\r\n", 6) + std::string(100000, 'x'));
  EXPECT_EQ(get(kPort, "/").status, 200);
  end_server();
}

TEST_F(WatchedPage, IsReachedOnItsAddressOnly) {
  serve_record();
  EXPECT_FALSE(HttpConnection(kPort, "127.0.0.2").open());
  end_server();
}

TEST_F(WatchedPage, BeyondThisHostATokenIsNeeded) {
  serve_record({"--listen", "127.0.0.2", "--port", "8801"});
  const auto ask = [](const std::string& target, std::vector<std::string> headers) {
    headers.push_back("Host: 127.0.0.2:8801");
    return http(8801, "GET", target, headers, "", "127.0.0.2");
  };
  const std::string right = token();
  ASSERT_EQ(right.size(), 32U) << text_of(printed_);
  std::string wrong = right;
  wrong.back() = wrong.back() == '0' ? '1' : '0';

  for (const std::string& target :
       {std::string("/"), "/?token=" + wrong, std::string("/?token="), "/?token=" + right + "0",
        "/events?token=" + right, "/record.json?token=" + right, std::string("/favicon.ico")}) {
    const HttpAnswer answer = ask(target, {});
    EXPECT_EQ(answer.status, 403) << target;
    EXPECT_EQ(answer.body.find("quadrimodal"), std::string::npos);
    EXPECT_FALSE(answer.contains("Set-Cookie"));
  }
  const HttpAnswer let_in = ask("/?token=" + right, {});
  EXPECT_EQ(let_in.status, 303);
  EXPECT_TRUE(let_in.contains("Location: /\r\n") || let_in.contains("Location: /")) << let_in.head;
  EXPECT_TRUE(
      let_in.contains("Set-Cookie: ergocast-8801=" + right + "; HttpOnly; SameSite=Strict; Path=/"))
      << let_in.head;
  for (const char* other : {"ergocast-8802=", "xergocast-8801=", "ergocast-8801=x"}) {
    EXPECT_EQ(ask("/", {"Cookie: " + (other + right)}).status, 403) << other;
  }
  EXPECT_EQ(ask("/", {"Cookie: a=b; ergocast-8801=" + wrong}).status, 403);
  EXPECT_EQ(ask("/", {"Cookie: a=b; ergocast-8801=" + right + "; c=d"}).status, 200);
  // A foreign name is refused even with the token.
  const auto renamed =
      http(8801, "GET", "/?token=" + right, {host("evil.example:8801")}, "", "127.0.0.2");
  EXPECT_EQ(renamed.status, 421);
  end_server();
}

TEST_F(WatchedPage, TwoServersDoNotShareAPort) {
  serve_record({"--port", "8802"});
  EXPECT_EQ(ergocast({"watch", out(), "--port", "8802"}), 3);
  EXPECT_NE(output().find("--port"), std::string::npos) << output();
  end_server();
}

TEST_F(WatchedPage, WhatIsNoRecordIsNamed) {
  EXPECT_EQ(ergocast({"watch", folder_}), 2);
  EXPECT_NE(output().find("plan.binpb"), std::string::npos) << output();
}

/// The bytes of an event stream, as far as a test has read them.
std::unique_ptr<HttpConnection> events(int port) {
  auto stream = std::make_unique<HttpConnection>(port);
  stream->send("GET /events HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n\r\n");
  return stream;
}
bool shows(HttpConnection& stream, const std::string& part) {
  return stream.read_until([&](const std::string& text) { return text.find(part) != text.npos; })
             .find(part) != std::string::npos;
}

TEST_F(WatchedPage, SixteenBrowsersWatchATeamAndMoreTakeTurns) {
  Child mission = launch_endless(scenario(), {"--watch"});
  std::vector<std::unique_ptr<HttpConnection>> streams;
  for (int i = 0; i < 16; ++i) streams.push_back(events(kPort));
  for (const auto& stream : streams) EXPECT_TRUE(shows(*stream, "event: mission"));
  EXPECT_TRUE(shows(*events(kPort), "event: mission"));
  EXPECT_EQ(get(kPort, "/").status, 200);
  EXPECT_EQ(get(kPort, "/record.json").status, 404);
  // Browsers that stop reading delay neither the team nor another browser.
  EXPECT_TRUE(moves_on());
  streams.clear();

  mission.send(SIGINT);
  EXPECT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
  EXPECT_TRUE(shows(*events(kPort), "event: end"));
  const HttpAnswer record = get(kPort, "/record.json");
  EXPECT_EQ(record.status, 200);
  EXPECT_TRUE(nlohmann::json::parse(record.body)["tracks"].is_object());
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0);
}

TEST_F(WatchedPage, WhatLacksTheTeamsKeyIsNotShown) {
  ASSERT_EQ(ergocast({"keygen", folder_ / "key"}), 0) << output();
  Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
  serve({"watch", "--lcm-url", kUrl, "--key-file", folder_ / "key.key", "--port", "8803"});
  Child keyed = *server_;
  serve({"watch", "--lcm-url", kUrl, "--port", "8804"});
  auto with_key = events(8803), without = events(8804);
  EXPECT_TRUE(shows(*without, "event: mission"));
  EXPECT_TRUE(shows(*without, "\"authenticated\":false"));
  // It had time: a keep-alive text comes after two seconds without an event.
  EXPECT_TRUE(shows(*with_key, "\n\n"));
  EXPECT_EQ(with_key->read_until([](const std::string&) { return true; }).find("event:"),
            std::string::npos);
  keyed.send(SIGINT);
  EXPECT_EQ(wait_for(keyed), 0);
  end_server();
  mission.send(SIGINT);
  wait_for(mission);
}

}  // namespace
}  // namespace ergocast::test
