// SPDX-License-Identifier: BSD-3-Clause
// Clients that must not give orders on a page with control: other processes of this host, clients
// without the token, replayed requests, and too many requests.
#include <regex>

#include "tests/process/support/mission.h"
#include "tests/support/http.h"

namespace ergocast::test {
namespace {

class AttackedControl : public RunningMission {
 protected:
  static constexpr int kPort = 8765;

  Child control(const std::string& time = "pace: REALTIME realtime_factor: 10") {
    Child mission = launch_endless(scenario(time), {"--watch", "--control"});
    const std::string text = printed(), begin = "/#control=";
    const auto at = text.find(begin);
    EXPECT_NE(at, text.npos) << text;
    token_ = text.substr(at + begin.size(), 32);
    return mission;
  }
  /// A request as the page sends it; `changed` replaces headers by name, or removes them if empty.
  int post(const nlohmann::json& request,
           const std::map<std::string, std::string>& changed = {}) const {
    std::map<std::string, std::string> headers{{"Host", "127.0.0.1:8765"},
                                               {"Origin", "http://127.0.0.1:8765"},
                                               {"X-Ergocast-Token", token_},
                                               {"X-Ergocast-Request", request.dump()}};
    for (const auto& [name, value] : changed) headers[name] = value;
    std::vector<std::string> lines;
    for (const auto& [name, value] : headers) {
      if (!value.empty()) lines.push_back(name + ": " + value);
    }
    return http(kPort, "POST", "/control", lines).status;
  }
  /// A request of the operator 7, with the next number.
  nlohmann::json asking(const std::string& act, Tick tick) {
    return {{"operator", 7}, {"name", "anna"}, {"number", ++number_}, {"tick", tick}, {"act", act}};
  }
  /// The newest tick that a page shows.
  static Tick shown_tick() {
    HttpConnection stream(kPort);
    stream.send("GET /events HTTP/1.1\r\nHost: 127.0.0.1:8765\r\n\r\n");
    const std::string key = "\"world_tick\":";
    const std::string text =
        stream.read_until([&](const std::string& all) { return all.find(key) != all.npos; });
    return std::stoll(text.substr(text.rfind(key) + key.size()));
  }
  /// Waits until the events of a page that opens now have that text.
  static bool shows(const std::string& part) {
    HttpConnection stream(kPort);
    stream.send("GET /events HTTP/1.1\r\nHost: 127.0.0.1:8765\r\n\r\n");
    const auto has = [&part](const std::string& all) { return all.find(part) != all.npos; };
    return has(stream.read_until(has));
  }
  bool take_control() {
    return post(asking("take", shown_tick())) == 202 && says("anna takes control");
  }
  bool says(const std::string& part) {
    return eventually([&] { return printed("control: " + part); });
  }
  void end(Child& mission) {
    mission.send(SIGINT);
    EXPECT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
    mission.send(SIGINT);
    EXPECT_EQ(wait_for(mission), 0) << printed();
  }

  std::string token_;
  int number_ = 0;
};

TEST_F(AttackedControl, RefusesOrdersWithoutTheTokenOrFromAnotherOrigin) {
  Child mission = control();
  const Tick tick = shown_tick();
  const auto stop = [&] { return asking("stop-now", tick); };
  EXPECT_EQ(post(stop(), {{"X-Ergocast-Token", ""}}), 403);
  EXPECT_EQ(post(stop(), {{"X-Ergocast-Token", std::string(32, '0')}}), 403);
  EXPECT_EQ(post(stop(), {{"X-Ergocast-Token", token_.substr(1)}}), 403);
  EXPECT_EQ(post(stop(), {{"X-Ergocast-Token", ""}, {"Cookie", "ergocast-8765=" + token_}}), 403);
  EXPECT_EQ(post(stop(), {{"Origin", ""}}), 403);
  EXPECT_EQ(post(stop(), {{"Origin", "http://evil.example"}}), 403);
  EXPECT_EQ(post(stop(), {{"Origin", "http://127.0.0.1:8766"}}), 403);
  EXPECT_EQ(post(stop(), {{"Origin", "null"}}), 403);
  EXPECT_EQ(post(stop(), {{"Host", "evil.example:8765"}, {"Origin", "http://evil.example:8765"}}),
            421);  // rebinding
  EXPECT_EQ(post(stop(), {{"Sec-Fetch-Site", "cross-site"}}), 403);
  const std::string query = "/control?token=" + token_;
  EXPECT_EQ(http(kPort, "POST", query, {"Host: 127.0.0.1:8765"}).status, 403);
  for (const char* method : {"GET", "PUT", "OPTIONS", "DELETE"}) {
    const auto answer =
        http(kPort, method, "/control", {"Host: 127.0.0.1:8765", "X-Ergocast-Token: " + token_});
    EXPECT_NE(answer.status, 202) << method;
    EXPECT_FALSE(answer.contains("Access-Control")) << method;
  }
  EXPECT_TRUE(moves_on());
  EXPECT_FALSE(printed("control:")) << printed();
  EXPECT_TRUE(pids({token_}).empty());  // other users read command lines
  EXPECT_EQ(log_of("run").find(token_), std::string::npos);
  end(mission);
}

TEST_F(AttackedControl, RefusesMalformedRequests) {
  Child mission = control();
  const Tick tick = shown_tick();
  const auto good = asking("pause", tick);
  const auto changed = [&good](const char* key, const nlohmann::json& value) {
    auto request = good;
    request[key] = value;
    return request;
  };
  for (const auto& request :
       {changed("act", "explode"), changed("act", 3), changed("operator", 0),
        changed("operator", -1), changed("operator", 4294967296), changed("operator", "7"),
        changed("number", 0), changed("number", 1.5), changed("number", 18446744073709551615U),
        changed("tick", -1), changed("name", 5), changed("agent", 1), changed("more", 1),
        changed("act", "home"), nlohmann::json::array(), nlohmann::json()}) {
    EXPECT_EQ(post(request), 400) << request;
  }
  EXPECT_EQ(post(good, {{"X-Ergocast-Request", std::string(2000, '[')}}), 400);
  EXPECT_EQ(post(good, {{"X-Ergocast-Request", ""}}), 400);
  EXPECT_TRUE(moves_on());
  EXPECT_FALSE(printed("control:")) << printed();
  end(mission);
}

TEST_F(AttackedControl, ABadNameStopsNoStop) {
  Child mission = control();
  for (const std::string& name : {std::string(49, 'a'), std::string("a\nb"), std::string("\x1b[2J"),
                                  std::string("\u202eanna")}) {
    auto request = asking("take", shown_tick());
    request["name"] = name;
    EXPECT_EQ(post(request), 202) << name;
  }
  EXPECT_TRUE(says("an operator without a name takes control")) << printed();
  auto stop = asking("stop-now", 0);
  stop["name"] = std::string(49, 'b');
  EXPECT_EQ(post(stop), 202);
  EXPECT_TRUE(says("stop now of an operator without a name")) << printed();
  ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

// A request is as old as the time that the process has slept.
TEST_F(AttackedControl, RequestsToAProcessThatSleepsDoNotCountButForAStop) {
  Child mission = control();
  ASSERT_TRUE(take_control()) << printed();
  const Tick tick = shown_tick();
  mission.send(SIGSTOP);
  int status = 202;
  EXPECT_TRUE(eventually([&] { return (status = post(asking("pause", tick))) != 202; }));
  EXPECT_EQ(status, 503);  // the page's process notices
  std::this_thread::sleep_for(std::chrono::seconds(6));
  mission.send(SIGCONT);
  EXPECT_TRUE(says("this process has slept")) << printed();
  EXPECT_TRUE(shows("the process that gives the orders has slept"));
  EXPECT_TRUE(eventually([&] { return post(asking("stop-now", 0)) == 202; }));
  EXPECT_TRUE(says("stop now of anna")) << printed();
  EXPECT_FALSE(printed("asks for: pause")) << printed();
  ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(AttackedControl, AReplayAnOldTickAndANonOperatorOrderNothing) {
  Child mission = control();
  EXPECT_EQ(post(asking("pause", shown_tick())), 202);
  EXPECT_TRUE(says("anna asks for: pause: refused: no operator has control: take it"));
  ASSERT_TRUE(take_control()) << printed();
  const auto pause = asking("pause", shown_tick());
  EXPECT_EQ(post(pause), 202);
  EXPECT_TRUE(says("pause of anna, asked for at")) << printed();
  EXPECT_EQ(post(asking("resume", shown_tick())), 202);
  EXPECT_TRUE(says("resume of anna")) << printed();
  const std::string before = printed();
  EXPECT_EQ(post(pause), 202);  // recorded, and sent again
  auto other = asking("pause", shown_tick());
  other["operator"] = 8;
  other["name"] = "mallory";
  EXPECT_EQ(post(other), 202);
  EXPECT_TRUE(says("mallory asks for: pause: refused: anna has control now")) << printed();
  // An old tick is refused once it is old enough; until then there is nothing to resume.
  EXPECT_TRUE(eventually([&] {
    post(asking("resume", 1));
    return printed("anna asks for: resume: refused: the page has shown nothing new");
  })) << printed();
  EXPECT_TRUE(moves_on());
  EXPECT_EQ(printed().substr(before.size()).find("asks for: pause, at"), std::string::npos);
  end(mission);
  EXPECT_EQ(summary()["holds"].size(), 1U);
}

TEST_F(AttackedControl, AThousandPressesAreOneOrderAndHarmNothing) {
  Child mission = control();
  ASSERT_TRUE(take_control()) << printed();
  const Tick tick = shown_tick();
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 1000; ++i) post(asking("pause", tick));
  for (int i = 0; i < 1000; ++i) post(asking("here", 0), {{"X-Ergocast-Token", "0"}});
  EXPECT_EQ(get(kPort, "/").status, 200);
  EXPECT_EQ(post(asking("stop-now", 0)), 202);
  EXPECT_TRUE(says("stop now of anna")) << printed();
  ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
  EXPECT_LE(summary()["holds"].size(), 1U);
  const std::string text = printed();
  std::size_t lines = 0;
  for (auto at = text.find("control:"); at != text.npos; at = text.find("control:", at + 1))
    ++lines;
  // A slow machine needs longer, and takes as many requests in each second.
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(static_cast<double>(lines), 300 + 21 * took.count());
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(AttackedControl, APageWithoutControlOrdersNothing) {
  Child mission = launch_endless(scenario("pace: REALTIME"), {"--watch"});
  token_ = std::string(32, '0');
  EXPECT_EQ(post(asking("stop-now", 0)), 405);
  token_ = "";
  EXPECT_EQ(post(asking("stop-now", 0)), 405);
  EXPECT_TRUE(moves_on());
  end(mission);
}

TEST_F(AttackedControl, ControlWithListenNeedsTls) {
  EXPECT_EQ(ergocast({"run", scenario_file("quadrimodal_corners"), "--watch", "--control",
                      "--listen", "127.0.0.2", "--out", out()}),
            2);
  for (const char* part : {"--listen needs --tls-cert", "ssh -L 8765:127.0.0.1:8765 HOST"}) {
    EXPECT_NE(output().find(part), std::string::npos) << output();
  }
  EXPECT_EQ(ergocast({"run", scenario_file("quadrimodal_corners"), "--control", "--out", out()}),
            2);
}

// The page's process has no key that signs.
TEST_F(AttackedControl, ATeamWithAKeyObeysAndThePageCannotSign) {
  const std::string key = folder_ / "key";
  ASSERT_EQ(ergocast({"keygen", key}), 0) << output();
  Child mission = launch_endless(scenario("pace: REALTIME realtime_factor: 10"),
                                 {"--watch", "--control", "--key-file", key + ".coordinator.key"});
  const std::string text = printed();
  token_ = text.substr(text.find("/#control=") + 10, 32);
  const auto page = pids({"ergocast run-page"});
  ASSERT_EQ(page.size(), 1U);
  const std::string command = text_of("/proc/" + std::to_string(page[0]) + "/cmdline");
  const auto at = command.find("/proc/self/fd/");
  ASSERT_NE(at, command.npos);
  const std::string descriptor = command.substr(at + 10, command.find('\0', at) - at - 10);
  const std::string key_of_page = text_of("/proc/" + std::to_string(page[0]) + descriptor);
  EXPECT_NE(key_of_page.find("shared "), std::string::npos) << descriptor;
  EXPECT_EQ(key_of_page.find("signing "), std::string::npos);
  ASSERT_TRUE(take_control()) << printed();
  EXPECT_EQ(post(asking("pause", shown_tick())), 202);
  EXPECT_TRUE(says("pause of anna, asked for at")) << printed();
  end(mission);
}

// From another process than the mission's own, which finds the run and its key by itself.
TEST_F(AttackedControl, AWatchWithControlGivesOrdersToARunOfThisUser) {
  Child mission = launch_endless(scenario("pace: REALTIME realtime_factor: 10"));
  Child watch = start("ergocast", {"watch", "--control"});
  ASSERT_TRUE(eventually([&] { return text_of(log_).find("/#control=") != std::string::npos; }))
      << text_of(log_);
  const std::string text = text_of(log_);
  token_ = text.substr(text.find("/#control=") + 10, 32);
  ASSERT_TRUE(eventually([] { return get(kPort, "/").status == 200; }));
  EXPECT_EQ(post(asking("stop-now", shown_tick())), 202);
  wait_for(mission);
  EXPECT_TRUE(summary()["reason"].get<std::string>().starts_with("stopped at once by anna"))
      << summary()["reason"];
  EXPECT_TRUE(eventually([&] {
    return text_of(log_).find("stop now of anna") != std::string::npos;
  })) << text_of(log_);
  // With the time of day: in its own output, and in the run's log.
  const std::regex order(
      "\\n\\d{4}-\\d\\d-\\d\\dT[\\d:.]+Z? [^\\n]*control: anna asks for: stop now, at");
  EXPECT_TRUE(std::regex_search('\n' + text_of(log_), order)) << text_of(log_);
  EXPECT_TRUE(std::regex_search('\n' + log_of("run"), order)) << log_of("run");
  watch.send(SIGINT);
  EXPECT_EQ(wait_for(watch), 0);
}

}  // namespace
}  // namespace ergocast::test
